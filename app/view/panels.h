#pragma once
// The column of widgets beside the picture. They show the options of the document and change them; they keep
// nothing themselves.

namespace meniscus {

class Viewer;

/// Width on an ordinary display.
inline constexpr int kPanelWidth = 330;
/// Width in the window's units.
double panelWidth(const Viewer& viewer);
/// Draws all panels, `height` high; within a frame of ImGui.
void drawPanels(Viewer& viewer, double height);

}  // namespace meniscus
