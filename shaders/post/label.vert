#version 450 core
// A label's rectangle, on the picture's pixels whatever the sample's shift.
struct Place {
  ivec4 box;  // picture's pixels: lower left corner, size
  ivec2 texel;
  float depth;
  float unused_;
};
layout(std430, binding = 0) readonly restrict buffer Places {
  Place uPlaces[];
};
layout(std140, binding = 1) uniform LabelUniforms {
  ivec4 uTile;
  vec4 uText, uSeam;  // linear light
};

layout(location = 0) flat out ivec2 vShift;  // from the target's pixels to the atlas's texels

void main() {
  Place place = uPlaces[gl_InstanceID];
  ivec2 corner = ivec2(gl_VertexID & 1, gl_VertexID >> 1);
  ivec2 origin = place.box.xy - uTile.xy;
  vec2 pixel = vec2(origin + corner * place.box.zw);
  vShift = place.texel - origin;
  gl_Position = vec4(pixel / vec2(uTile.zw) * 2.0 - 1.0, place.depth, 1.0);
}
