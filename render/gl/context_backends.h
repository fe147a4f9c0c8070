#pragma once
// The ways to a context without a window; used by context.cpp alone.

#include <memory>
#include <string>
#include <vector>

#include "render/gl/context.h"

namespace meniscus::gl {

using ProcAddress = void (*(*)(const char*))();

/// One way to a context.
class ContextMaker {
 public:
  virtual ~ContextMaker() = default;
  /// A current context with its functions loaded; or nullptr with report.reason and report.remedy. Sets
  /// report.name.
  virtual std::unique_ptr<Context> make(BackendReport& report) = 0;
};

/// EGL: every device that libEGL enumerates (hardware first), then the surfaceless platform. Where libEGL
/// cannot be opened, one maker that says so.
std::vector<std::unique_ptr<ContextMaker>> eglMakers();
std::unique_ptr<ContextMaker> osmesaMaker();

/// Loads the current context's functions. Returns why it cannot serve, or nothing.
std::string loadFunctions(ProcAddress getProcAddress);
/// Fills in what the current context is.
void describeCurrent(BackendReport& report);

/// A shared library, opened at run time and kept until the process ends (drivers do not survive unloading).
class SharedLibrary {
 public:
  /// Tries the file named by the environment variable if it is set, else each of `names`.
  SharedLibrary(const char* environmentVariable, std::vector<const char*> names);
  bool opened() const { return handle_ != nullptr; }
  const std::string& error() const { return error_; }
  template <typename Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;
  void* handle_ = nullptr;
  std::string error_;
};

}  // namespace meniscus::gl
