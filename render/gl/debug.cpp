#include "render/gl/debug.h"

#include <glad/gl.h>

#include <cstdlib>
#include <utility>

namespace meniscus::gl {

namespace {

std::vector<std::string>& messages() {
  static std::vector<std::string> collected;
  return collected;
}

void GLAD_API_PTR collect(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* text,
                          const void*) {
  if (type == GL_DEBUG_TYPE_OTHER || type == GL_DEBUG_TYPE_PERFORMANCE || type == GL_DEBUG_TYPE_MARKER)
    return;
  messages().emplace_back(
      text, length >= 0 ? static_cast<std::size_t>(length) : std::char_traits<char>::length(text));
}

}  // namespace

void installDebugOutput() {
  if (!std::getenv("MENISCUS_GL_DEBUG")) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(collect, nullptr);
}

std::vector<std::string> takeDebugMessages() {
  while (const GLenum error = glGetError()) messages().push_back("glGetError: " + std::to_string(error));
  return std::exchange(messages(), {});
}

}  // namespace meniscus::gl
