#pragma once
// One line on stderr that says how far a picture is, if somebody is watching a terminal.

#include <chrono>
#include <string>

namespace meniscus {

class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void start(std::string label);
  /// Shows the finished share 0..1; nothing in the first moments of a picture, then ten times a second at
  /// most.
  void update(double share);
  /// Takes the line away, so that something else can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool wanted_;
  bool shown_ = false;
  std::string label_;
  Clock::time_point next_;
};

}  // namespace meniscus
