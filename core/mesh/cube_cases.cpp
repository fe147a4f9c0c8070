#include "core/mesh/cube_cases.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"

namespace meniscus::mesh {

namespace {

using Loop = std::vector<int>;  // edges, anticlockwise seen from the outside of the surface

int edgeBetween(int a, int b) {
  const int axis = std::countr_zero(static_cast<unsigned>(a ^ b));
  const int low = std::min(a, b);
  return 4 * axis + (low >> (axis + 1) % 3 & 1) + 2 * (low >> (axis + 2) % 3 & 1);
}

// Going around a face, a line starts where one comes in and ends where one goes out: around a corner that is
// apart at the next such place, where the inside corners are joined at the one before.
void addLines(unsigned inside, bool joined, int face, std::array<int, 12>& next) {
  const std::array<int, 4> corners = faceCorners(face);
  std::vector<int> in, out;
  for (std::size_t i = 0; i < 4; ++i) {
    const int from = corners[i], to = corners[(i + 1) % 4];
    const bool fromInside = (inside >> from & 1u) != 0, toInside = (inside >> to & 1u) != 0;
    if (fromInside == toInside) continue;
    (toInside ? in : out).push_back(edgeBetween(from, to));
  }
  if (in.size() == 2) {
    const bool outFirst = (inside >> corners[0] & 1u) != 0;  // the first place is one where one goes out
    // `out[i]` is what follows `in[i]`.
    if (outFirst) std::swap(out[0], out[1]);
    if (joined) std::swap(out[0], out[1]);
  }
  for (std::size_t i = 0; i < in.size(); ++i) next[static_cast<std::size_t>(in[i])] = out[i];
}

std::vector<Loop> loopsOf(unsigned inside, unsigned joined) {
  std::array<int, 12> next;
  next.fill(-1);
  for (int face = 0; face < 6; ++face) addLines(inside, (joined >> face & 1u) != 0, face, next);
  std::vector<Loop> loops;
  for (std::size_t first = 0; first < 12; ++first) {
    Loop loop;
    for (int edge = static_cast<int>(first); next[static_cast<std::size_t>(edge)] >= 0;) {
      loop.push_back(edge);
      edge = std::exchange(next[static_cast<std::size_t>(edge)], -1);
    }
    if (!loop.empty()) loops.push_back(loop);
  }
  return loops;
}

bool onOneFace(int edgeA, int edgeB) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto sideOf = [&](int edge) {  // -1: the edge runs from side to side
      const std::array<int, 2> ends = edgeCorners(edge);
      const int a = ends[0] >> axis & 1, b = ends[1] >> axis & 1;
      return a == b ? a : -1;
    };
    if (sideOf(edgeA) >= 0 && sideOf(edgeA) == sideOf(edgeB)) return true;
  }
  return false;
}

// Four times the squared distance between the middles of two edges.
int distance2(int edgeA, int edgeB) {
  int sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = [&](int edge) {
      const std::array<int, 2> ends = edgeCorners(edge);
      return (ends[0] >> axis & 1) + (ends[1] >> axis & 1);
    };
    const int d = place(edgeA) - place(edgeB);
    sum += d * d;
  }
  return sum;
}

constexpr int kForbidden = 1 << 20;

// The triangles of loop[from..to] with the shortest diagonals of which none lies in a face; the cost is
// kForbidden or more if there are none.
struct Fan {
  int cost = 0;
  std::vector<std::uint8_t> corners;
};

Fan triangulated(const Loop& loop, std::size_t from, std::size_t to) {
  if (to - from < 2) return {};
  Fan best{std::numeric_limits<int>::max(), {}};
  const auto diagonal = [&](std::size_t a, std::size_t b) {
    const bool isSide = b - a == 1 || (a == 0 && b == loop.size() - 1);
    if (isSide) return 0;
    return onOneFace(loop[a], loop[b]) ? kForbidden : distance2(loop[a], loop[b]);
  };
  for (std::size_t middle = from + 1; middle < to; ++middle) {
    Fan left = triangulated(loop, from, middle), right = triangulated(loop, middle, to);
    const int cost = left.cost + right.cost + diagonal(from, middle) + diagonal(middle, to);
    if (cost >= best.cost) continue;
    best = std::move(left);
    best.cost = cost;
    best.corners.insert(best.corners.end(), right.corners.begin(), right.corners.end());
    for (const std::size_t at : {from, middle, to})
      best.corners.push_back(static_cast<std::uint8_t>(loop[at]));
  }
  return best;
}

struct Entry {
  std::size_t first = 0, count = 0;
  int middles = 0;
};

class Table {
 public:
  Table() : entries_(256 * 64) {
    for (unsigned inside = 0; inside < 256; ++inside) {
      unsigned choices = 0;
      for (int face = 0; face < 6; ++face)
        if (isAmbiguous(inside, face)) choices |= 1u << face;
      for (unsigned joined = 0; joined < 64; ++joined)  // those without others come first
        entries_[inside * 64 + joined] =
            (joined & ~choices) == 0 ? make(inside, joined) : entries_[inside * 64 + (joined & choices)];
    }
  }
  CubeCase at(unsigned inside, unsigned joined) const {
    const Entry& entry = entries_[inside * 64 + joined];
    return {std::span(corners_).subspan(entry.first, entry.count), entry.middles};
  }

 private:
  Entry make(unsigned inside, unsigned joined) {
    Entry entry{corners_.size(), 0, 0};
    for (const Loop& loop : loopsOf(inside, joined)) {
      MENISCUS_CHECK(loop.size() >= 3);
      Fan fan = triangulated(loop, 0, loop.size() - 1);
      if (fan.cost >= kForbidden) {
        fan.corners.clear();
        const auto middle = static_cast<std::uint8_t>(kFirstMiddle + entry.middles++);
        for (std::size_t i = 0; i < loop.size(); ++i)
          fan.corners.insert(fan.corners.end(),
                             {static_cast<std::uint8_t>(loop[i]),
                              static_cast<std::uint8_t>(loop[(i + 1) % loop.size()]), middle});
      }
      corners_.insert(corners_.end(), fan.corners.begin(), fan.corners.end());
    }
    entry.count = corners_.size() - entry.first;
    return entry;
  }

  std::vector<std::uint8_t> corners_;
  std::vector<Entry> entries_;
};

}  // namespace

std::array<int, 4> faceCorners(int face) {
  const int axis = face / 2, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
  const int base = face % 2 << axis;
  if (face % 2 == 0) return {base, base + c, base + b + c, base + b};
  return {base, base + b, base + b + c, base + c};
}

bool isAmbiguous(unsigned inside, int face) {
  const std::array<int, 4> corners = faceCorners(face);
  const auto in = [&](std::size_t i) { return (inside >> corners[i] & 1u) != 0; };
  return in(0) == in(2) && in(1) == in(3) && in(0) != in(1);
}

std::array<int, 2> edgeCorners(int edge) {
  const int axis = edge / 4;
  const int low = (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
  return {low, low | 1 << axis};
}

CubeCase cubeCase(unsigned inside, unsigned joined) {
  static const Table kTable;
  return kTable.at(inside, joined);
}

}  // namespace meniscus::mesh
