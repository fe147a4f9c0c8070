#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace meniscus {
namespace {

constexpr std::chrono::milliseconds kFirst{400}, kInterval{100};

// "1 h 05 min", "3 min 20 s", "12 s".
std::string duration(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

}  // namespace

Progress::Progress(bool wanted, bool timeLeft)
    : wanted_(wanted && isatty(STDERR_FILENO) == 1),
      timeLeft_(timeLeft),
      next_(Clock::now()),
      started_(Clock::now()) {}

void Progress::start(std::string label) {
  label_ = std::move(label);
  started_ = Clock::now();
  next_ = started_ + kFirst;
}

void Progress::update(double share) {
  if (!wanted_ || Clock::now() < next_) return;
  next_ = Clock::now() + kInterval;
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%s %3.0f %%", label_.c_str(), share * 100);
  if (const double spent = std::chrono::duration<double>(Clock::now() - started_).count();
      timeLeft_ && share > 0)
    std::fprintf(stderr, ", %s left", duration(spent * (1 - share) / share).c_str());
  std::fflush(stderr);
}

void Progress::clear() {
  if (std::exchange(shown_, false)) std::fputs("\r\033[K", stderr);
}

}  // namespace meniscus
