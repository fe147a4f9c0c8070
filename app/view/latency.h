#pragma once
// How long the window's user waits: from an input to the picture of it, and from the last to the full
// picture.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace meniscus {

class Latency {
 public:
  using Clock = std::chrono::steady_clock;
  struct Summary {
    std::size_t count = 0;
    double median = 0, most = 0, share95 = 0;  ///< [ms]; share95: 95 % are no longer
  };

  /// A request was made because of an input; `moving` as in ViewRequest.
  void asked(std::uint64_t number, bool moving, Clock::time_point when = Clock::now());
  /// A picture of a request is in the window.
  void shown(std::uint64_t number, bool full, Clock::time_point when = Clock::now());

  /// Of the last windows, the one in the middle.
  double recentWindowMs() const;
  double lastMovingMs() const { return moving_.empty() ? 0 : moving_.back(); }
  double lastFullMs() const { return full_.empty() ? 0 : full_.back(); }
  /// What drawing took: a frame of a moving picture, and the window around it.
  void drew(double frameMs) { frames_.push_back(frameMs); }
  void drewWindow(double windowMs) { windows_.push_back(windowMs); }

  Summary frames() const { return summaryOf(frames_); }
  Summary windows() const { return summaryOf(windows_); }
  Summary moving() const { return summaryOf(moving_); }
  Summary full() const { return summaryOf(full_); }

 private:
  static Summary summaryOf(std::vector<double> values);
  std::vector<std::pair<std::uint64_t, Clock::time_point>> waiting_;  // ascending
  std::optional<Clock::time_point> lastInput_;
  bool wasMoving_ = false;  // the request before
  std::vector<double> moving_, full_, frames_, windows_;
};

}  // namespace meniscus
