#pragma once
// OpenGL objects that delete themselves. No GL type or name appears here; a context must be current wherever
// one is made, used or destroyed.

#include <cstdint>
#include <string>
#include <utility>

namespace meniscus::gl {

enum class ObjectKind : std::uint8_t { buffer, texture, framebuffer, vertexArray, program };

/// Owns one GL name; movable.
class Object {
 public:
  Object() = default;
  Object(ObjectKind kind, unsigned name) : kind_(kind), name_(name) {}
  ~Object() { reset(); }
  Object(Object&& other) noexcept : kind_(other.kind_), name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    if (this != &other) {
      reset();
      kind_ = other.kind_;
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  unsigned name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  void reset();
  ObjectKind kind_ = ObjectKind::buffer;
  unsigned name_ = 0;
};

/// Buffer storage of a fixed size.
struct Buffer {
  Object object;
  std::uint64_t bytes = 0;

  /// Immutable contents. Throws GraphicsError if the driver has no memory for it.
  static Buffer fromData(const void* data, std::uint64_t bytes);
  /// Contents that change: update() replaces all of them.
  static Buffer updatable(std::uint64_t bytes);
  void update(const void* data);
};

enum class TextureFormat : std::uint8_t {
  rgba8,
  rgba16,
  rgba32f,
  rg32f,
  rg16,
  r16,
  r32ui,
  rgba32ui,
  r32f,
  depth32f
};

int bytesPerTexel(TextureFormat format);

struct TextureDesc {
  TextureFormat format = TextureFormat::rgba8;
  int width = 0, height = 0;
  bool operator==(const TextureDesc&) const = default;
};

struct Texture {
  Object object;
  TextureDesc desc;
  std::uint64_t serial = 0;  ///< never used twice in a process, unlike GL names

  static Texture make(const TextureDesc& desc);
  std::uint64_t bytes() const;
  /// Replaces width x height texels from (x, y) on: rows from the bottom, in the format's own component
  /// types.
  void write(int width, int height, const void* data, int x, int y) const;
  /// Reads width x height texels from (x, y) on, rows from the bottom, `rowTexels` apart in memory, in the
  /// format's own component types. `out` must have room.
  void read(int width, int height, int rowTexels, void* out, int x = 0, int y = 0) const;
};

/// Limits of the current context that decide what can be drawn at once.
struct Limits {
  int textureSize = 0;
  int viewportWidth = 0, viewportHeight = 0;
  std::int64_t storageBlock = 0;  ///< bytes of one shader storage block
};
Limits queryLimits();

/// What draws.
struct Device {
  std::string name;       ///< GL_RENDERER
  bool software = false;  ///< OpenGL runs on the processor
};
Device queryDevice();

}  // namespace meniscus::gl
