#include "render/gl/storage.h"

#include <glad/gl.h>

#include <algorithm>

namespace meniscus::gl {

void Storage::reserve(std::uint64_t bytes) {
  if (buffer_.bytes >= bytes && buffer_.bytes > 0) return;
  buffer_ = {};
  buffer_ = Buffer::updatable(std::max<std::uint64_t>(bytes, 256));
}

void Storage::write(const void* data, std::uint64_t bytes, std::uint64_t offset) {
  if (bytes == 0) return;
  glNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Storage::read(void* data, std::uint64_t bytes, std::uint64_t offset) const {
  if (bytes == 0) return;
  glGetNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Storage::zero() {
  glClearNamedBufferData(name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Storage::bindStorage(unsigned binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name());
}

}  // namespace meniscus::gl
