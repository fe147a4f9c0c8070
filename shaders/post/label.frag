#version 450 core
// A label's letters over their seam.
layout(binding = 0) uniform sampler2D tAtlas;
layout(std140, binding = 1) uniform LabelUniforms {
  ivec4 uTile;
  vec4 uText, uSeam;  // linear light
};

layout(location = 0) flat in ivec2 vShift;
layout(location = 0) out vec4 oColor;  // premultiplied

void main() {
  vec2 cover = texelFetch(tAtlas, ivec2(gl_FragCoord.xy) + vShift, 0).rg;
  float seam = max(cover.g, cover.r) - cover.r;
  oColor = vec4(uText.rgb * cover.r + uSeam.rgb * seam, cover.r + seam);
}
