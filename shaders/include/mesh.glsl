// A mesh's vertices and triangles as render/surface/mesh.cpp stores them: textures, whose size no storage
// block's limit bounds.

layout(binding = 0) uniform usampler2D tVertices;  // two texels each: MeshVertex of core/mesh/surface_mesh.h
const int kVerticesPerRow = 2048;
const int kTrianglesPerRow = 1365;

struct MeshVertex {
  vec3 position;  // relative to the primitives' origin
  vec3 normal;    // world axes, outwards
  uint color;
  uint id;
};

ivec2 vertexTexel(uint index) {
  return ivec2(2u * (index % uint(kVerticesPerRow)), index / uint(kVerticesPerRow));
}

vec3 vertexPosition(uint index) {
  return uintBitsToFloat(texelFetch(tVertices, vertexTexel(index), 0).xyz);
}

MeshVertex fetchVertex(uint index) {
  ivec2 at = vertexTexel(index);
  uvec4 a = texelFetch(tVertices, at, 0), b = texelFetch(tVertices, at + ivec2(1, 0), 0);
  MeshVertex v;
  v.position = uintBitsToFloat(a.xyz);
  v.normal = uintBitsToFloat(uvec3(a.w, b.xy));
  v.color = b.z;
  v.id = b.w;
  return v;
}
