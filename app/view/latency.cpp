#include "app/view/latency.h"

#include <algorithm>

namespace meniscus {
namespace {

double milliseconds(Latency::Clock::time_point from, Latency::Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

}  // namespace

void Latency::asked(std::uint64_t number, bool moving, Clock::time_point when) {
  if (moving) waiting_.emplace_back(number, when);
  // A still request after moving ones is for the same input; after a still one it is for another.
  if (moving || !wasMoving_ || !lastInput_) lastInput_ = when;
  wasMoving_ = moving;
}

// Requests that were overtaken are shown by a later picture: the user waited since the first of them.
void Latency::shown(std::uint64_t number, bool full, Clock::time_point when) {
  const auto later = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const auto& request) { return request.first > number; });
  if (later != waiting_.begin()) {
    moving_.push_back(milliseconds(waiting_.front().second, when));
    waiting_.erase(waiting_.begin(), later);
  }
  if (full && lastInput_) {
    full_.push_back(milliseconds(*lastInput_, when));
    lastInput_.reset();
  }
}

double Latency::recentWindowMs() const {
  constexpr std::ptrdiff_t kRecent = 9;
  const auto count = std::min(kRecent, static_cast<std::ptrdiff_t>(windows_.size()));
  return summaryOf({windows_.end() - count, windows_.end()}).median;
}

Latency::Summary Latency::summaryOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {values.size(), at(0.5), values.back(), at(0.95)};
}

}  // namespace meniscus
