#pragma once
// Passes that compute every pixel of their target once.

namespace meniscus {

/// Draws one triangle over the bound framebuffer with `program`; `add` adds to what is there.
void drawFullscreen(unsigned program, bool add = false);

}  // namespace meniscus
