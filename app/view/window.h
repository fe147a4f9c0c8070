#pragma once
// A window with Dear ImGui in it. Pictures are drawn elsewhere (picture_worker.h): the window's own context,
// which may be older than what they need, only lays them out. Nothing is drawn while nothing happens.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/view/canvas.h"
#include "app/view/window_drawing.h"
#include "core/image.h"

struct GLFWwindow;

namespace meniscus {

/// How a window reaches OpenGL.
enum class WindowContext : std::uint8_t {
  automatic,  ///< GLX, then EGL, then OSMesa
  glx,
  egl,
  osmesa  ///< draws into main memory, without a GPU; for windows of X11
};

class Window {
 public:
  /// Throws GraphicsError: there is no display, or no OpenGL in a window of it.
  Window(const std::string& title, ImageSize size, WindowContext context);
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
  /// "GLX", "EGL", "OSMesa": how the window reached OpenGL.
  const std::string& api() const { return api_; }
  /// What its user should know about that; mostly nothing.
  const std::string& note() const { return note_; }

 private:
  void open(ImageSize size, WindowContext context);
  std::string openBy(int api, ImageSize size);
  void shut();
  void fitIntoScreen();
  void startGui();
  static Window& of(GLFWwindow* window);
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<GuiPainter> painter_;
  std::unique_ptr<Canvas> canvas_;  // nothing where the context shows by itself what it draws
  std::vector<std::byte> pixels_;
  std::string api_, note_, title_;
  double contentScale_ = 1;
  bool answersNext_ = false, keyPressed_ = false;
};

}  // namespace meniscus
