#include "app/view/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"

namespace meniscus {
namespace {

// The few functions of OpenGL that lay a picture out; the loader of render/ belongs to the other context.
struct Gl {
  void (*genTextures)(int, unsigned*);
  void (*deleteTextures)(int, const unsigned*);
  void (*bindTexture)(unsigned, unsigned);
  void (*texParameteri)(unsigned, unsigned, int);
  void (*texImage2D)(unsigned, int, int, int, int, int, unsigned, unsigned, const void*);
  void (*pixelStorei)(unsigned, int);
  void (*viewport)(int, int, int, int);
  void (*clearColor)(float, float, float, float);
  void (*clear)(unsigned);
};

// Numbers of the OpenGL registry.
constexpr unsigned kTexture2d = 0x0DE1, kMagFilter = 0x2800, kMinFilter = 0x2801, kWrapS = 0x2802,
                   kWrapT = 0x2803, kRgba = 0x1908, kUnsignedByte = 0x1401, kUnpackAlignment = 0x0CF5,
                   kColorBuffer = 0x4000;
constexpr int kLinear = 0x2601, kClampToEdge = 0x812F, kRgba8 = 0x8058;

Gl windowGl;

template <typename Function>
void load(Function& function, const char* name) {
  function = reinterpret_cast<Function>(glfwGetProcAddress(name));
  if (!function)
    throw GraphicsError(fmt::format("the window's OpenGL lacks {}; 'meniscus render' needs no window", name));
}

void loadGl() {
  load(windowGl.genTextures, "glGenTextures");
  load(windowGl.deleteTextures, "glDeleteTextures");
  load(windowGl.bindTexture, "glBindTexture");
  load(windowGl.texParameteri, "glTexParameteri");
  load(windowGl.texImage2D, "glTexImage2D");
  load(windowGl.pixelStorei, "glPixelStorei");
  load(windowGl.viewport, "glViewport");
  load(windowGl.clearColor, "glClearColor");
  load(windowGl.clear, "glClear");
}

std::string lastError() {
  const char* description = nullptr;
  glfwGetError(&description);
  std::string text = description ? description : "GLFW gave no reason";
  // "X11: Failed to open display :5" and the like come with a full stop at times.
  while (text.ends_with('.')) text.pop_back();
  return text;
}

// In this order; OSMesa shows nothing in a window.
constexpr std::array<std::pair<int, const char*>, 2> kApis{
    {{GLFW_NATIVE_CONTEXT_API, "GLX"}, {GLFW_EGL_CONTEXT_API, "EGL"}}};

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr double kFontSize = 15;

}  // namespace

WindowTexture::~WindowTexture() {
  if (name_ != 0) windowGl.deleteTextures(1, &name_);
}

void WindowTexture::set(ImageSize size, std::span<const std::byte> pixels) {
  if (name_ == 0) windowGl.genTextures(1, &name_);
  windowGl.bindTexture(kTexture2d, name_);
  windowGl.texParameteri(kTexture2d, kMinFilter, kLinear);
  windowGl.texParameteri(kTexture2d, kMagFilter, kLinear);
  windowGl.texParameteri(kTexture2d, kWrapS, kClampToEdge);
  windowGl.texParameteri(kTexture2d, kWrapT, kClampToEdge);
  windowGl.pixelStorei(kUnpackAlignment, 4);
  windowGl.texImage2D(kTexture2d, 0, kRgba8, size.width, size.height, 0, kRgba, kUnsignedByte, pixels.data());
}

Window::Window(const std::string& title, ImageSize size) : title_(title) {
  if (!glfwInit())
    throw GraphicsError(
        fmt::format("no window can be opened here ({}); 'meniscus render FILE -o OUT.png' needs "
                    "no display",
                    lastError()));
  try {
    open(title, size);
    startGui();
  } catch (...) {
    if (window_) glfwDestroyWindow(window_);
    glfwTerminate();
    throw;
  }
}

void Window::open(const std::string& title, ImageSize size) {
  std::string failures;
  for (const auto& [api, name] : kApis) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (window_) {
      api_ = name;
      break;
    }
    failures += fmt::format("{}{}: {}", failures.empty() ? "" : "; ", name, lastError());
  }
  if (!window_)
    throw GraphicsError(
        fmt::format("no window with OpenGL 3.3 ({}); 'meniscus render FILE -o OUT.png' needs no "
                    "window",
                    failures));
  fitIntoScreen();
  glfwMakeContextCurrent(window_);
  loadGl();
  glfwSwapInterval(1);
  float scaleX = 1, scaleY = 1;
  glfwGetWindowContentScale(window_, &scaleX, &scaleY);
  contentScale_ = std::max(1.0f, scaleX);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
    Window& self = of(window);
    self.keyPressed_ = true;
    if (action == GLFW_RELEASE || !self.onKey || ImGui::GetIO().WantTextInput) return;
    self.onKey(key, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    Window& self = of(window);
    if (self.onDrop) self.onDrop({paths, paths + count});
  });
}

// What is larger than the screen, without a window manager that sees to it, could not be reached.
void Window::fitIntoScreen() {
  int x = 0, y = 0, mostWidth = 0, mostHeight = 0, width = 0, height = 0;
  if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor())
    glfwGetMonitorWorkarea(monitor, &x, &y, &mostWidth, &mostHeight);
  glfwGetWindowSize(window_, &width, &height);
  if (mostWidth > 0 && mostHeight > 0 && (width > mostWidth || height > mostHeight))
    glfwSetWindowSize(window_, std::min(width, mostWidth), std::min(height, mostHeight));
}

void Window::startGui() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // the window leaves no files behind
  io.LogFilename = nullptr;
  const auto scale = static_cast<float>(contentScale_);
  // Latin letters, Greek, the Angstrom and degree signs; without the font the built-in one serves.
  static const ImWchar kRanges[] = {0x20, 0x17F, 0x370, 0x3FF, 0x2010, 0x2027, 0x2190, 0x21FF, 0};
  const auto pixels = static_cast<float>(kFontSize) * scale;
  if (!std::filesystem::exists(kFont) || !io.Fonts->AddFontFromFileTTF(kFont, pixels, nullptr, kRanges))
    io.Fonts->AddFontDefault();
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.ScaleAllSizes(scale);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330");
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

Window& Window::of(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

bool Window::closed() const {
  return glfwWindowShouldClose(window_) != 0;
}

void Window::close() {
  glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::hide() {
  glfwHideWindow(window_);
}

void Window::wait(double seconds) {
  if (seconds < 0) {
    glfwWaitEvents();
  } else if (seconds == 0) {
    glfwPollEvents();
  } else {
    glfwWaitEventsTimeout(seconds);
  }
}

void Window::wake() {
  glfwPostEmptyEvent();
}

void Window::draw(const std::function<void()>& draw, bool seen) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  const ImGuiIO& io = ImGui::GetIO();
  answersNext_ = std::exchange(keyPressed_, false) || io.MouseWheel != 0;
  for (int button = 0; button < 3; ++button)
    answersNext_ = answersNext_ || io.MouseClicked[button] || io.MouseReleased[button];
  draw();
  if (!seen) {
    ImGui::EndFrame();
    return;
  }
  ImGui::Render();
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  windowGl.viewport(0, 0, width, height);
  windowGl.clearColor(0.16f, 0.17f, 0.19f, 1);
  windowGl.clear(kColorBuffer);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window_);
}

ImageSize Window::size() const {
  ImageSize size;
  glfwGetWindowSize(window_, &size.width, &size.height);
  return size;
}

double Window::pixelsPerUnit() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  const ImageSize units = size();
  return units.width > 0 && width > 0 ? static_cast<double>(width) / units.width : 1;
}

bool Window::minimized() const {
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0;
}

void Window::setTitle(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::copy(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

}  // namespace meniscus
