#pragma once
// A picture that stays in memory.

#include <cstddef>
#include <span>
#include <vector>

#include "core/image.h"

namespace meniscus {

class BufferSink : public RowSink {
 public:
  explicit BufferSink(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  void writeRows(std::span<const std::byte> rows) override {
    bytes_.insert(bytes_.end(), rows.begin(), rows.end());
  }

 private:
  std::vector<std::byte>& bytes_;
};

}  // namespace meniscus
