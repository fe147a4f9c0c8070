#pragma once
// An OpenGL 4.5 core context without a window. libEGL and libOSMesa are opened at run time, so one binary
// runs where either is missing. The window's context lives in app/viewer.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace meniscus {

enum class Backend : std::uint8_t {
  automatic,  ///< EGL device, then EGL surfaceless, then OSMesa
  egl,        ///< EGL device, then EGL surfaceless
  osmesa
};

/// What one way to a context gave, for `meniscus doctor` and for the error if none works.
struct BackendReport {
  std::string name;  ///< "EGL device 0", "EGL surfaceless", "OSMesa", "window"
  bool works = false;
  std::string vendor, renderer, glVersion, glslVersion;   ///< if it works
  std::vector<std::pair<std::string, long long>> limits;  ///< GL_MAX_... without the prefix, that matter here
  std::string reason, remedy;                             ///< if it does not work
};

/// A current context of the calling thread; released when destroyed.
class Context {
 public:
  virtual ~Context() = default;
  /// Throws GraphicsError: one line that names every way tried, why it failed, and the remedy.
  static std::unique_ptr<Context> create(Backend backend);
  const std::string& name() const { return name_; }              ///< as BackendReport::name
  const std::string& rendererName() const { return renderer_; }  ///< GL_RENDERER
  const std::string& driverVersion() const { return version_; }  ///< GL_VERSION

 protected:
  std::string name_, renderer_, version_;
};

/// Throws GraphicsError if the current context was lost: the driver was reset, and what has been drawn is
/// void.
void requireContextAlive();

/// Tries every way without a window, one after the other, leaving no context current.
std::vector<BackendReport> diagnoseBackends();

}  // namespace meniscus
