#pragma once
// Passes that compute every pixel of their target once.

namespace meniscus {

/// Draws one triangle over the bound framebuffer with `program`; `add` adds to what is there.
void drawFullscreen(unsigned program, bool add = false);

/// The same where the G-buffer's depth, attached as FrameGraph::kTestedDepth, shows a surface. The program
/// may read that depth, since nothing writes it (OpenGL 4.5, 9.3.1). llvmpipe runs both sides of an `if`: the
/// early depth test is what skips the background there.
void drawOverSurface(unsigned program, bool add = false);

}  // namespace meniscus
