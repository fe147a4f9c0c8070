#include "render/gl/objects.h"

#include <glad/gl.h>

#include <algorithm>
#include <atomic>

#include "core/error.h"

namespace meniscus::gl {

namespace {

struct FormatInfo {
  GLenum internal, format, type;
  int bytes;
};

FormatInfo infoOf(TextureFormat format) {
  switch (format) {
    case TextureFormat::rgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case TextureFormat::rgba16:
      return {GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT, 8};
    case TextureFormat::rgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
    case TextureFormat::rg32f:
      return {GL_RG32F, GL_RG, GL_FLOAT, 8};
    case TextureFormat::rg16:
      return {GL_RG16, GL_RG, GL_UNSIGNED_SHORT, 4};
    case TextureFormat::r16:
      return {GL_R16, GL_RED, GL_UNSIGNED_SHORT, 2};
    case TextureFormat::r32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    case TextureFormat::rgba32ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
    case TextureFormat::r32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 4};
    case TextureFormat::depth32f:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
  }
  return {};
}

void throwIfOutOfMemory(const char* what, std::uint64_t bytes) {
  bool full = false;
  while (const GLenum error = glGetError()) full = full || error == GL_OUT_OF_MEMORY;
  if (full) {
    throw GraphicsError("the driver has no memory for " + std::string(what) + " of " +
                        std::to_string(bytes >> 20) + " MiB; draw fewer atoms or a smaller picture");
  }
}

}  // namespace

void Object::reset() {
  if (name_ == 0) return;
  switch (kind_) {
    case ObjectKind::buffer:
      glDeleteBuffers(1, &name_);
      break;
    case ObjectKind::texture:
      glDeleteTextures(1, &name_);
      break;
    case ObjectKind::framebuffer:
      glDeleteFramebuffers(1, &name_);
      break;
    case ObjectKind::vertexArray:
      glDeleteVertexArrays(1, &name_);
      break;
    case ObjectKind::program:
      glDeleteProgram(name_);
      break;
  }
  name_ = 0;
}

Buffer Buffer::fromData(const void* data, std::uint64_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  Buffer buffer{Object(ObjectKind::buffer, name), bytes};
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), data, 0);
  throwIfOutOfMemory("a buffer", bytes);
  return buffer;
}

Buffer Buffer::updatable(std::uint64_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  Buffer buffer{Object(ObjectKind::buffer, name), bytes};
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  throwIfOutOfMemory("a buffer", bytes);
  return buffer;
}

void Buffer::update(const void* data) {
  glNamedBufferSubData(object.name(), 0, static_cast<GLsizeiptr>(bytes), data);
}

int bytesPerTexel(TextureFormat format) {
  return infoOf(format).bytes;
}

Texture Texture::make(const TextureDesc& desc) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  static std::atomic<std::uint64_t> made{0};
  Texture texture{Object(ObjectKind::texture, name), desc, ++made};
  glTextureStorage2D(name, 1, infoOf(desc.format).internal, desc.width, desc.height);
  // Integer and depth textures are incomplete with linear filters on some drivers; nothing here filters.
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  throwIfOutOfMemory("a texture", texture.bytes());
  return texture;
}

std::uint64_t Texture::bytes() const {
  return static_cast<std::uint64_t>(desc.width) * static_cast<std::uint64_t>(desc.height) *
         static_cast<std::uint64_t>(bytesPerTexel(desc.format));
}

void Texture::write(int width, int height, const void* data, int x, int y) const {
  const FormatInfo info = infoOf(desc.format);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(object.name(), 0, x, y, width, height, info.format, info.type, data);
}

void Texture::read(int width, int height, int rowTexels, void* out, int x, int y) const {
  const FormatInfo info = infoOf(desc.format);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, rowTexels);
  const GLsizei size = static_cast<GLsizei>(
      std::min<long long>(static_cast<long long>(rowTexels) * height * info.bytes, 0x7FFFFFFF));
  glGetTextureSubImage(object.name(), 0, x, y, 0, width, height, 1, info.format, info.type, size, out);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

Limits queryLimits() {
  Limits limits;
  GLint viewport[2] = {0, 0};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limits.textureSize);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  limits.viewportWidth = viewport[0];
  limits.viewportHeight = viewport[1];
  GLint64 block = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  limits.storageBlock = block;
  return limits;
}

Device queryDevice() {
  const GLubyte* text = glGetString(GL_RENDERER);
  Device device{text != nullptr ? reinterpret_cast<const char*>(text) : "", false};
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer", "SwiftShader"})
    device.software = device.software || device.name.find(name) != std::string::npos;
  return device;
}

}  // namespace meniscus::gl
