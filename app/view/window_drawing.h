#pragma once
// What is drawn in the window's own context: pictures as textures, and what Dear ImGui lays out. Dear ImGui's
// own drawing (imgui_impl_opengl3) finds its functions in libGL.so, whatever context is current; those of
// OSMesa are not there.

#include <cstddef>
#include <span>
#include <vector>

#include "core/image.h"

struct ImDrawData;
struct ImDrawList;

namespace meniscus {

/// Finds the functions of the current context, which all of the below belongs to. Throws GraphicsError, the
/// reason alone: it is older than OpenGL 3.3.
void loadWindowFunctions(void (*(*getProcAddress)(const char*))());

/// A picture in the window's context.
class WindowTexture {
 public:
  WindowTexture() = default;
  ~WindowTexture();
  WindowTexture(const WindowTexture&) = delete;
  WindowTexture& operator=(const WindowTexture&) = delete;
  /// RGBA, 8 bits, rows from the top.
  void set(ImageSize size, std::span<const std::byte> pixels);
  unsigned name() const { return name_; }

 private:
  unsigned name_ = 0;
};

/// Draws what Dear ImGui lays out; of one context of Dear ImGui, whose letters it keeps.
class GuiPainter {
 public:
  GuiPainter();
  ~GuiPainter();
  GuiPainter(const GuiPainter&) = delete;
  GuiPainter& operator=(const GuiPainter&) = delete;
  /// All of the window, which has so many pixels.
  void paint(ImageSize frame, const ImDrawData& data);
  /// What was painted: RGBA, 8 bits, rows from the bottom.
  void read(ImageSize frame, std::vector<std::byte>& pixels) const;

 private:
  void paintList(ImageSize frame, const ImDrawData& data, const ImDrawList& list) const;
  unsigned program_ = 0, vertexArray_ = 0, vertices_ = 0, indices_ = 0;
  int projection_ = -1;
  WindowTexture letters_;
};

}  // namespace meniscus
