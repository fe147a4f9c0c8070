#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>

#include "core/tiles/field_caster.h"

namespace meniscus::tiles {

namespace {
constexpr std::size_t kFirstCapacity = 128;
constexpr std::align_val_t kAlignment{64};
}  // namespace

void FieldCounts::add(const FieldCounts& other) {
  rays += other.rays;
  intervals += other.intervals;
  stretches += other.stretches;
  pieces += other.pieces;
  iterations += other.iterations;
  mostIterations = std::max(mostIterations, other.mostIterations);
  splits += other.splits;
  grazing += other.grazing;
  notConverged += other.notConverged;
  mostChords = std::max(mostChords, other.mostChords);
}

ChordWindow::ChordWindow(std::size_t lanes) : lanes_(lanes) {
  grow();
}

ChordWindow::~ChordWindow() {
  ::operator delete(memory_, kAlignment);
}

void ChordWindow::grow() {
  const std::size_t larger = capacity == 0 ? kFirstCapacity : 2 * capacity;
  static_assert(sizeof(float) == sizeof(std::uint32_t));
  auto* const memory =
      static_cast<std::byte*>(::operator new(larger*(4 * lanes_ + 3) * sizeof(float), kAlignment));
  std::byte* next = memory;
  const auto move = [&](auto*& array, std::size_t perChord) {
    if (capacity > 0) std::memcpy(next, array, capacity * perChord * sizeof(*array));
    array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(next);
    next += larger * perChord * sizeof(*array);
  };
  move(middle, lanes_);
  move(half2, lanes_);
  move(enter, lanes_);
  move(leave, lanes_);
  move(inverse2, 1);
  move(coefficient, 1);
  move(ball, 1);
  ::operator delete(memory_, kAlignment);
  memory_ = memory;
  capacity = larger;
}

}  // namespace meniscus::tiles
