// EGL without a window: a GPU or software device (EGL_EXT_platform_device), or Mesa's surfaceless platform.

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "render/gl/context_backends.h"

namespace meniscus::gl {

namespace {

constexpr const char* kRemedy =
    "install a driver with OpenGL 4.5 and EGL (Debian without a GPU: libegl1 libgl1-mesa-dri)";

struct Egl {
  SharedLibrary library{"MENISCUS_EGL_LIBRARY", {"libEGL.so.1", "libEGL.so"}};
  PFNEGLGETPROCADDRESSPROC getProcAddress = nullptr;
  PFNEGLQUERYSTRINGPROC queryString = nullptr;
  PFNEGLINITIALIZEPROC initialize = nullptr;
  PFNEGLBINDAPIPROC bindApi = nullptr;
  PFNEGLCHOOSECONFIGPROC chooseConfig = nullptr;
  PFNEGLCREATECONTEXTPROC createContext = nullptr;
  PFNEGLDESTROYCONTEXTPROC destroyContext = nullptr;
  PFNEGLCREATEPBUFFERSURFACEPROC createPbufferSurface = nullptr;
  PFNEGLDESTROYSURFACEPROC destroySurface = nullptr;
  PFNEGLMAKECURRENTPROC makeCurrent = nullptr;
  PFNEGLGETERRORPROC getError = nullptr;
  PFNEGLQUERYDEVICESEXTPROC queryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = nullptr;

  Egl() {
    load(getProcAddress, "eglGetProcAddress");
    load(queryString, "eglQueryString");
    load(initialize, "eglInitialize");
    load(bindApi, "eglBindAPI");
    load(chooseConfig, "eglChooseConfig");
    load(createContext, "eglCreateContext");
    load(destroyContext, "eglDestroyContext");
    load(createPbufferSurface, "eglCreatePbufferSurface");
    load(destroySurface, "eglDestroySurface");
    load(makeCurrent, "eglMakeCurrent");
    load(getError, "eglGetError");
    if (!complete()) return;
    loadExtension(queryDevices, "eglQueryDevicesEXT");
    loadExtension(queryDeviceString, "eglQueryDeviceStringEXT");
    loadExtension(getPlatformDisplay, "eglGetPlatformDisplayEXT");
  }
  bool complete() const {
    return getProcAddress && queryString && initialize && bindApi && chooseConfig && createContext &&
           destroyContext && createPbufferSurface && destroySurface && makeCurrent && getError;
  }
  bool has(EGLDisplay display, std::string_view extension) const {
    const char* all = queryString(display, EGL_EXTENSIONS);
    return all &&
           (' ' + std::string(all) + ' ').find(' ' + std::string(extension) + ' ') != std::string::npos;
  }
  std::string lastError() const {
    std::array<char, 32> code{};
    std::snprintf(code.data(), code.size(), "EGL error 0x%04X", static_cast<unsigned>(getError()));
    return code.data();
  }

 private:
  template <typename F>
  void load(F& function, const char* name) {
    function = library.function<F>(name);
  }
  template <typename F>
  void loadExtension(F& function, const char* name) {
    function = reinterpret_cast<F>(getProcAddress(name));
  }
};

const Egl& egl() {
  static const Egl api;
  return api;
}

class EglContext : public Context {
 public:
  explicit EglContext(EGLDisplay display) : display_(display) {}
  ~EglContext() override {
    egl().makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) egl().destroyContext(display_, context_);
    if (surface_ != EGL_NO_SURFACE) egl().destroySurface(display_, surface_);
    // The display stays: eglTerminate would unload the driver, and drivers do not all survive being loaded
    // again.
  }

  // Returns why it failed, or nothing.
  std::string makeCurrent() {
    if (!egl().bindApi(EGL_OPENGL_API)) return "it does not know desktop OpenGL (" + egl().lastError() + ")";
    const bool surfaceless = egl().has(display_, "EGL_KHR_surfaceless_context");
    EGLConfig config = nullptr;  // EGL_NO_CONFIG_KHR
    if (!surfaceless || !egl().has(display_, "EGL_KHR_no_config_context")) {
      const EGLint wanted[] = {EGL_SURFACE_TYPE, surfaceless ? 0 : EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                               EGL_OPENGL_BIT, EGL_NONE};
      EGLint count = 0;
      if (!egl().chooseConfig(display_, wanted, &config, 1, &count) || count == 0) {
        return "it has no configuration for OpenGL";
      }
    }
    EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                           4,
                           EGL_CONTEXT_MINOR_VERSION,
                           5,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                           EGL_LOSE_CONTEXT_ON_RESET,
                           EGL_NONE};
    context_ = egl().createContext(display_, config, EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) {
      attributes[6] = EGL_NONE;  // a driver that does not tell of resets
      context_ = egl().createContext(display_, config, EGL_NO_CONTEXT, attributes);
    }
    if (context_ == EGL_NO_CONTEXT) return "it makes no OpenGL 4.5 core context (" + egl().lastError() + ")";
    if (!surfaceless) {
      const EGLint size[] = {EGL_WIDTH, 4, EGL_HEIGHT, 4, EGL_NONE};
      surface_ = egl().createPbufferSurface(display_, config, size);
      if (surface_ == EGL_NO_SURFACE) return "it makes no off-screen surface (" + egl().lastError() + ")";
    }
    if (!egl().makeCurrent(display_, surface_, surface_, context_)) {
      return "its context cannot be made current (" + egl().lastError() + ")";
    }
    return loadFunctions(reinterpret_cast<ProcAddress>(egl().getProcAddress));
  }

 private:
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

// A display of some platform: a device, or Mesa's surfaceless one.
class EglMaker : public ContextMaker {
 public:
  EglMaker(std::string name, EGLenum platform, void* native)
      : name_(std::move(name)), platform_(platform), native_(native) {}

  std::unique_ptr<Context> make(BackendReport& report) override {
    report.name = name_;
    report.remedy = kRemedy;
    const EGLDisplay display = egl().getPlatformDisplay(platform_, native_, nullptr);
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || !egl().initialize(display, &major, &minor)) {
      report.reason = "its display cannot be opened (" + egl().lastError() + ")";
      return nullptr;
    }
    auto context = std::make_unique<EglContext>(display);
    report.reason = context->makeCurrent();
    if (!report.reason.empty()) return nullptr;
    report.remedy.clear();
    return context;
  }

 private:
  std::string name_;
  EGLenum platform_;
  void* native_;
};

// Says why there is nothing to try.
class UnavailableMaker : public ContextMaker {
 public:
  UnavailableMaker(std::string name, std::string reason)
      : name_(std::move(name)), reason_(std::move(reason)) {}
  std::unique_ptr<Context> make(BackendReport& report) override {
    report.name = name_;
    report.reason = reason_;
    report.remedy = kRemedy;
    return nullptr;
  }

 private:
  std::string name_, reason_;
};

std::vector<EGLDeviceEXT> devicesHardwareFirst() {
  EGLint count = 0;
  if (!egl().queryDevices || !egl().queryDevices(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  egl().queryDevices(count, devices.data(), &count);
  devices.resize(static_cast<std::size_t>(count));
  std::stable_partition(devices.begin(), devices.end(), [](EGLDeviceEXT device) {
    const char* extensions =
        egl().queryDeviceString ? egl().queryDeviceString(device, EGL_EXTENSIONS) : nullptr;
    return !extensions ||
           std::string_view(extensions).find("EGL_MESA_device_software") == std::string_view::npos;
  });
  return devices;
}

}  // namespace

std::vector<std::unique_ptr<ContextMaker>> eglMakers() {
  std::vector<std::unique_ptr<ContextMaker>> makers;
  std::string reason;
  if (!egl().library.opened()) {
    reason = egl().library.error();
  } else if (!egl().complete() || !egl().getPlatformDisplay) {
    reason = "libEGL lacks EGL_EXT_platform_base";
  }
  if (!reason.empty()) {
    makers.push_back(std::make_unique<UnavailableMaker>("EGL device", reason));
    makers.push_back(std::make_unique<UnavailableMaker>("EGL surfaceless", reason));
    return makers;
  }
  const std::vector<EGLDeviceEXT> devices = devicesHardwareFirst();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    makers.push_back(
        std::make_unique<EglMaker>("EGL device " + std::to_string(i), EGL_PLATFORM_DEVICE_EXT, devices[i]));
  }
  if (devices.empty()) {
    makers.push_back(std::make_unique<UnavailableMaker>("EGL device", "libEGL names no device"));
  }
  if (egl().has(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    makers.push_back(
        std::make_unique<EglMaker>("EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY));
  } else {
    makers.push_back(
        std::make_unique<UnavailableMaker>("EGL surfaceless", "libEGL lacks EGL_MESA_platform_surfaceless"));
  }
  return makers;
}

}  // namespace meniscus::gl
