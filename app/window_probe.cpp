// GLFW 3.3's C interface is declared here as far as it is needed, because the library is optional: it is
// opened with dlopen and costs nothing where nobody asks for a window. Numbers are those of GLFW/glfw3.h.

#include "app/window_probe.h"

#include <dlfcn.h>

#include <cstdlib>
#include <string>
#include <utility>

#include "render/gl/context_backends.h"

namespace meniscus {
namespace {

constexpr int kVisible = 0x00020004, kClientApi = 0x00022001, kOpenGlApi = 0x00030001;
constexpr int kVersionMajor = 0x00022002, kVersionMinor = 0x00022003;
constexpr int kProfile = 0x00022008, kCoreProfile = 0x00032001;

struct Glfw {
  int (*init)();
  void (*terminate)();
  void (*windowHint)(int, int);
  void* (*createWindow)(int, int, const char*, void*, void*);
  void (*makeContextCurrent)(void*);
  void* (*getProcAddress)(const char*);
  int (*getError)(const char**);
};

template <typename Function>
bool load(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(dlsym(library, name));
  return function != nullptr;
}

bool loadAll(void* library, Glfw& glfw) {
  return load(library, "glfwInit", glfw.init) && load(library, "glfwTerminate", glfw.terminate) &&
         load(library, "glfwWindowHint", glfw.windowHint) &&
         load(library, "glfwCreateWindow", glfw.createWindow) &&
         load(library, "glfwMakeContextCurrent", glfw.makeContextCurrent) &&
         load(library, "glfwGetProcAddress", glfw.getProcAddress) &&
         load(library, "glfwGetError", glfw.getError);
}

std::string lastError(const Glfw& glfw) {
  const char* description = nullptr;
  glfw.getError(&description);
  return description != nullptr ? description : "GLFW gave no reason";
}

BackendReport failure(std::string reason, std::string remedy) {
  BackendReport report;
  report.name = "window";
  report.reason = std::move(reason);
  report.remedy = std::move(remedy);
  return report;
}

bool hasDisplay() {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(variable); value != nullptr && *value != '\0') return true;
  return false;
}

}  // namespace

BackendReport probeWindow() {
  constexpr const char* kInstall = "install GLFW (Debian: libglfw3); only windows need it";
  void* library = dlopen("libglfw.so.3", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return failure(std::string("GLFW is not installed (") + dlerror() + ")", kInstall);
  Glfw glfw{};
  if (!loadAll(library, glfw)) return failure("this GLFW is older than 3.3", kInstall);
  if (!hasDisplay())
    return failure("there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)",
                   "none is needed for 'meniscus render'; for a window log in to a desktop, or use xvfb-run");
  if (glfw.init() == 0)
    return failure(lastError(glfw), "check DISPLAY or WAYLAND_DISPLAY; 'meniscus render' needs no display");

  BackendReport report;
  glfw.windowHint(kVisible, 0);
  glfw.windowHint(kClientApi, kOpenGlApi);
  glfw.windowHint(kVersionMajor, 4);
  glfw.windowHint(kVersionMinor, 5);
  glfw.windowHint(kProfile, kCoreProfile);
  if (void* window = glfw.createWindow(64, 64, "meniscus", nullptr, nullptr); window != nullptr) {
    glfw.makeContextCurrent(window);
    report.reason = gl::loadFunctions(reinterpret_cast<gl::ProcAddress>(glfw.getProcAddress));
    if (report.reason.empty()) gl::describeCurrent(report);
  } else {
    report.reason = lastError(glfw);
  }
  if (!report.works)
    report = failure(report.reason, "install a driver with OpenGL 4.5 (Debian: libgl1-mesa-dri)");
  report.name = "window";
  glfw.terminate();
  return report;
}

}  // namespace meniscus
