// The first four places at which the ray crosses a translucent surface, and the rest merged. Needs
// include/lists_surface.glsl, shared/octahedral.glsl. A layer: x colour, 0xRRGGBB sRGB; y normal, octahedral,
// 16 bits each; z distance along the unit ray, a float's bits; w id, 0 = none. Of the rest: mean colour,
// normal and distance; w how many.

const int kLayers = 4;

layout(location = 0) out uvec4 oLayer0;
layout(location = 1) out uvec4 oLayer1;
layout(location = 2) out uvec4 oLayer2;
layout(location = 3) out uvec4 oLayer3;
layout(location = 4) out uvec4 oRest;

// Those of another surface, drawn before.
layout(binding = 7) uniform usampler2D tLayer0;
layout(binding = 8) uniform usampler2D tLayer1;
layout(binding = 9) uniform usampler2D tLayer2;
layout(binding = 10) uniform usampler2D tLayer3;
layout(binding = 11) uniform usampler2D tRest;
layout(binding = 4) uniform sampler2D tDepth;

struct Layers {
  uvec4 layer[kLayers];
  vec3 squares, normal;  // sums over the rest
  float distance;
  uint count;
};
Layers gLayers;
uint gNode = 0u;  // of the pixel's list, for surfaceAt(): crossings come in order

void beginLayers(ivec2 texel) {
  for (int i = 0; i < kLayers; ++i) gLayers.layer[i] = uvec4(0u);
  gLayers.squares = vec3(0.0);
  gLayers.normal = vec3(0.0);
  gLayers.distance = 0.0;
  gLayers.count = 0u;
  if (uLists.z == 0) return;
  gLayers.layer[0] = texelFetch(tLayer0, texel, 0);
  gLayers.layer[1] = texelFetch(tLayer1, texel, 0);
  gLayers.layer[2] = texelFetch(tLayer2, texel, 0);
  gLayers.layer[3] = texelFetch(tLayer3, texel, 0);
  uvec4 rest = texelFetch(tRest, texel, 0);
  vec3 bytes = bytesOf(rest.x);
  float count = float(rest.w);
  gLayers.squares = count * bytes * bytes;
  gLayers.normal = count * decodeNormal(unpackUnorm2x16(rest.y));
  gLayers.distance = count * uintBitsToFloat(rest.z);
  gLayers.count = rest.w;
}

void mergeLayer(uvec4 layer) {
  vec3 bytes = bytesOf(layer.x);
  gLayers.squares += bytes * bytes;
  gLayers.normal += decodeNormal(unpackUnorm2x16(layer.y));
  gLayers.distance += uintBitsToFloat(layer.z);
  ++gLayers.count;
}

void addLayer(uvec4 layer) {
  for (int i = 0; i < kLayers; ++i) {
    uvec4 here = gLayers.layer[i];
    if (here.w != 0u && uintBitsToFloat(here.z) <= uintBitsToFloat(layer.z)) continue;
    gLayers.layer[i] = layer;
    layer = here;
    if (layer.w == 0u) return;
  }
  mergeLayer(layer);
}

void endLayers() {
  oLayer0 = gLayers.layer[0];
  oLayer1 = gLayers.layer[1];
  oLayer2 = gLayers.layer[2];
  oLayer3 = gLayers.layer[3];
  oRest = uvec4(0u);
  if (gLayers.count == 0u) return;
  float count = float(gLayers.count);
  uvec3 bytes = uvec3(min(sqrt(gLayers.squares / count), vec3(255.0)) + 0.5);
  vec3 normal = dot(gLayers.normal, gLayers.normal) > 1e-6 ? normalize(gLayers.normal) : vec3(0.0, 0.0, 1.0);
  oRest = uvec4(bytes.x << 16 | bytes.y << 8 | bytes.z, packUnorm2x16(encodeNormal(normal)),
                floatBitsToUint(gLayers.distance / count), gLayers.count);
}

void addCrossing(ivec2 texel, uint head, SceneRay ray, Split place, bool inside) {
  float depth = depthValue(uView, heightOf(ray, place));
  if (!(depth > texelFetch(tDepth, texel, 0).r) || depth > 1.0) return;
  if (gNode == 0u) gNode = head;
  FieldSurface s = surfaceAt(gNode, ray, place);
  addLayer(uvec4(blendedColor(s), packUnorm2x16(encodeNormal(normalTowards(s, ray, inside))),
                 floatBitsToUint(distanceAlong(ray, place)), max(s.id, 1u)));
}
