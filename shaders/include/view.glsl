// The view that is being drawn, and the mathematics that uses it.
#include "include/dialect.glsl"
#include "shared/double_float.glsl"
#include "shared/view_block.glsl"
#include "shared/projection.glsl"

layout(std140, binding = 0) uniform ViewUniforms {
  ViewBlock uView;
};
