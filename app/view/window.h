#pragma once
// A window with Dear ImGui in it. Pictures are drawn elsewhere (picture_worker.h): the window's own context,
// which may be older than what they need, only lays them out. Nothing is drawn while nothing happens.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"

struct GLFWwindow;

namespace meniscus {

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

class Window {
 public:
  /// Throws GraphicsError: there is no display, or no OpenGL in a window of it.
  Window(const std::string& title, ImageSize size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Keys by GLFW's numbers, as they are pressed or repeated while no text is typed.
  std::function<void(int key, bool control, bool shift)> onKey;
  std::function<void(const std::vector<std::string>& files)> onDrop;

  /// Whether the user wants it closed.
  bool closed() const;
  void close();
  void hide();
  /// Waits until something happens, `seconds` at most (less than 0: for ever).
  void wait(double seconds);
  /// Ends a wait; from any thread.
  static void wake();
  /// One picture of the window: `draw` calls ImGui. It answers to input in any case, but the picture is only
  /// made where it is to be `seen`: without a GPU it costs as much as a picture of a molecule.
  void draw(const std::function<void()>& draw, bool seen);
  /// Whether the last draw() met input whose answer only the next one shows.
  bool answersNext() const { return answersNext_; }
  /// Window coordinates, and pixels for each of them.
  ImageSize size() const;
  double pixelsPerUnit() const;
  /// Size of a letter against that of an ordinary display.
  double contentScale() const { return contentScale_; }
  bool minimized() const;
  void setTitle(const std::string& title);
  void copy(const std::string& text);
  /// "GLX", "EGL": how the window reached OpenGL.
  const std::string& api() const { return api_; }

 private:
  void open(const std::string& title, ImageSize size);
  void fitIntoScreen();
  void startGui();
  static Window& of(GLFWwindow* window);
  GLFWwindow* window_ = nullptr;
  std::string api_, title_;
  double contentScale_ = 1;
  bool answersNext_ = false, keyPressed_ = false;
};

}  // namespace meniscus
