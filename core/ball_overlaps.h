#pragma once
// Which balls of a field reach into each other.

#include <cstdint>
#include <span>
#include <vector>

#include "core/metaball_field.h"

namespace meniscus {

struct BallOverlaps {
  /// Of each ball in order of support, then of place in the field: its index in MetaballField::balls. A
  /// ball's place in this order is its rank; all below are ranks.
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> first;    ///< of each ball's list in `others`; one more than there are balls
  std::vector<std::uint32_t> smaller;  ///< of each: how many of its list come before it
  std::vector<std::uint32_t> others;   ///< ascending
  std::span<const std::uint32_t> of(std::uint32_t rank) const {
    return {others.data() + first[rank], first[rank + 1] - first[rank]};
  }
};

/// Pairs whose supports share more than a point; cost follows the pairs, whatever the supports' sizes. Throws
/// InputError, naming `what`, if the lists would have more than `mostEntries`.
BallOverlaps findOverlaps(const MetaballField& field, std::size_t mostEntries, const char* what);

}  // namespace meniscus
