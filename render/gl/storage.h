#pragma once
// A buffer for what has another size in every frame.

#include <cstdint>

#include "render/gl/objects.h"

namespace meniscus::gl {

class Storage {
 public:
  /// Room for so many bytes; what was in it may be lost.
  void reserve(std::uint64_t bytes);
  void write(const void* data, std::uint64_t bytes, std::uint64_t offset = 0);
  void read(void* data, std::uint64_t bytes, std::uint64_t offset = 0) const;
  void zero();
  void bindStorage(unsigned binding) const;
  unsigned name() const { return buffer_.object.name(); }
  std::uint64_t bytes() const { return buffer_.bytes; }

 private:
  Buffer buffer_;
};

}  // namespace meniscus::gl
