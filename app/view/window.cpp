#include "app/view/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"

namespace meniscus {
namespace {

std::string lastError() {
  const char* description = nullptr;
  glfwGetError(&description);
  std::string text = description ? description : "GLFW gave no reason";
  // "X11: Failed to open display :5" and the like come with a full stop at times.
  while (text.ends_with('.')) text.pop_back();
  return text;
}

struct Way {
  WindowContext context;
  int api;
  const char* name;
};

// In this order: what OSMesa draws takes a copy more to be seen.
constexpr std::array<Way, 3> kWays{{{WindowContext::glx, GLFW_NATIVE_CONTEXT_API, "GLX"},
                                    {WindowContext::egl, GLFW_EGL_CONTEXT_API, "EGL"},
                                    {WindowContext::osmesa, GLFW_OSMESA_CONTEXT_API, "OSMesa"}}};

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr double kFontSize = 15;

}  // namespace

Window::Window(const std::string& title, ImageSize size, WindowContext context) : title_(title) {
  if (!glfwInit())
    throw GraphicsError(
        fmt::format("no window can be opened here ({}); 'meniscus render FILE -o OUT.png' needs "
                    "no display",
                    lastError()));
  try {
    open(size, context);
    startGui();
  } catch (...) {
    shut();
    throw;
  }
}

void Window::open(ImageSize size, WindowContext context) {
  std::string failures;
  for (const Way& way : kWays) {
    if (context != WindowContext::automatic && context != way.context) continue;
    std::string failure = openBy(way.api, size);
    if (window_) {
      api_ = way.name;
      if (way.context == WindowContext::osmesa && !failures.empty())
        note_ = fmt::format("the window is drawn by OSMesa, without a GPU ({})", failures);
      break;
    }
    // GLFW names the way in most of its reasons.
    if (const std::string name = fmt::format("{}: ", way.name); !failure.starts_with(name))
      failure = name + failure;
    failures += (failures.empty() ? "" : "; ") + failure;
  }
  if (!window_)
    throw GraphicsError(
        fmt::format("no window with OpenGL 3.3 ({}); 'meniscus render FILE -o OUT.png' needs no "
                    "window",
                    failures));
  fitIntoScreen();
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

// Why there is no window_, if there is none.
std::string Window::openBy(int api, ImageSize size) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(size.width, size.height, title_.c_str(), nullptr, nullptr);
  if (!window_) {
    const std::string reason = lastError();
    return reason.ends_with("Library not found") && api == GLFW_OSMESA_CONTEXT_API
               ? reason + " (Debian: libosmesa6)"
               : reason;
  }
  try {
    glfwMakeContextCurrent(window_);
    loadWindowFunctions(glfwGetProcAddress);
    if (api == GLFW_OSMESA_CONTEXT_API) canvas_ = makeCanvas(window_);
    return {};
  } catch (const GraphicsError& error) {
    glfwDestroyWindow(std::exchange(window_, nullptr));
    return error.what();
  }
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
  painter_ = std::make_unique<GuiPainter>();
}

void Window::shut() {
  painter_.reset();
  canvas_.reset();
  if (ImGui::GetCurrentContext()) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  if (window_) glfwDestroyWindow(window_);
  glfwTerminate();
}

Window::~Window() {
  shut();
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
  if (canvas_) glfwMakeContextCurrent(window_);  // OSMesa draws in the size that the window had then
  ImageSize frame;
  glfwGetFramebufferSize(window_, &frame.width, &frame.height);
  painter_->paint(frame, *ImGui::GetDrawData());
  if (canvas_) {
    painter_->read(frame, pixels_);
    canvas_->show(frame, pixels_);
  } else {
    glfwSwapBuffers(window_);
  }
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
