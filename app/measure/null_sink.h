#pragma once
// A picture that is only timed.

#include <cstddef>
#include <span>

#include "core/image.h"

namespace meniscus::measure {

class NullSink : public RowSink {
 public:
  void writeRows(std::span<const std::byte>) override {}
};

}  // namespace meniscus::measure
