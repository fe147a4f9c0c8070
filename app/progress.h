#pragma once
// One line on stderr that says how far a picture is, if somebody is watching a terminal.

#include <chrono>
#include <string>
#include <utility>

namespace meniscus {

class Progress {
 public:
  /// `timeLeft`: also says how long it will take, from how long it took so far.
  explicit Progress(bool wanted, bool timeLeft = false);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void start(std::string label);
  /// Says what is being done; the shares go on.
  void label(std::string label) { label_ = std::move(label); }
  /// Shows the finished share 0..1; nothing in the first moments of a picture, then ten times a second at
  /// most.
  void update(double share);
  /// Takes the line away, so that something else can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool wanted_, timeLeft_;
  bool shown_ = false;
  std::string label_;
  Clock::time_point next_, started_;
};

}  // namespace meniscus
