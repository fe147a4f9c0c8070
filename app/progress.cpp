#include "app/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace meniscus {
namespace {

constexpr std::chrono::milliseconds kFirst{400}, kInterval{100};

}  // namespace

Progress::Progress(bool wanted) : wanted_(wanted && isatty(STDERR_FILENO) == 1), next_(Clock::now()) {}

void Progress::start(std::string label) {
  label_ = std::move(label);
  next_ = Clock::now() + kFirst;
}

void Progress::update(double share) {
  if (!wanted_ || Clock::now() < next_) return;
  next_ = Clock::now() + kInterval;
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%s %3.0f %%", label_.c_str(), share * 100);
  std::fflush(stderr);
}

void Progress::clear() {
  if (std::exchange(shown_, false)) std::fputs("\r\033[K", stderr);
}

}  // namespace meniscus
