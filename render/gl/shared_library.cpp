#include <dlfcn.h>

#include <cstdlib>

#include "render/gl/context_backends.h"

namespace meniscus::gl {

SharedLibrary::SharedLibrary(const char* environmentVariable, std::vector<const char*> names) {
  if (const char* chosen = std::getenv(environmentVariable)) names = {chosen};
  for (const char* name : names) {
    handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (handle_) return;
    const char* why = dlerror();
    if (error_.empty()) error_ = why ? why : std::string(name) + " cannot be opened";
  }
}

void* SharedLibrary::symbol(const char* name) const {
  return handle_ ? dlsym(handle_, name) : nullptr;
}

}  // namespace meniscus::gl
