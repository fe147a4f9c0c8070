// Needs include/lists_nodes.glsl, writable.

// The list's head when it is in the order of the balls. Balls are drawn in the reverse order and prepended,
// but OpenGL promises no order between fragments of different primitives: what is out of order is inserted
// where it belongs. Lists of tiles are made in order.
uint orderedList(uint head, out bool moved) {
  moved = false;
#ifndef TILES
  uint last = head;
  uint lastBall = uNodes[head - 1u].x, node = uNodes[head - 1u].y;
  while (node != 0u) {
    uvec2 n = uNodes[node - 1u];
    if (n.x > lastBall) {
      last = node;
      lastBall = n.x;
      node = n.y;
      continue;
    }
    moved = true;
    uNodes[last - 1u].y = n.y;
    uint after = 0u, next = head;
    while (uNodes[next - 1u].x < n.x) {  // ends before `last`
      after = next;
      next = uNodes[next - 1u].y;
    }
    uNodes[node - 1u].y = next;
    if (after == 0u) {
      head = node;
    } else {
      uNodes[after - 1u].y = node;
    }
    node = n.y;
  }
#endif
  return head;
}
