#pragma once
// Rows of a picture, by all processors.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace meniscus::effects {

/// f(first, last) for bands of rows that make up all of them.
template <typename F>
void forBands(int height, F f) {
  constexpr int kRows = 8;  // for a task
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRows),
                    [&](const tbb::blocked_range<int>& rows) { f(rows.begin(), rows.end()); });
}

/// f(y) for each.
template <typename F>
void forRows(int height, F f) {
  forBands(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) f(y);
  });
}

}  // namespace meniscus::effects
