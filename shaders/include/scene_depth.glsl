// Depth as a share of the scene's depth range. Needs include/view.glsl.

// 0 on the far plane, 1 on the near plane. value: of the depth buffer.
float nearness(float value) {
  float range = uView.depth.z - uView.depth.w;
  if (!isPerspective(uView)) return value / (uView.depthMap.x * range);
  return value * (uView.depth.x - uView.depth.w) / ((value + uView.depthMap.x) * range);
}
