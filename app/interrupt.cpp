#include "app/interrupt.h"

#include <csignal>
#include <cstdlib>

#include "io/output_file.h"

namespace meniscus {
namespace {

volatile std::sig_atomic_t gInterrupted = 0;

extern "C" void noteInterrupt(int signal) {
  if (gInterrupted) {
    removeTemporaryFiles();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  gInterrupted = 1;
  std::signal(signal, noteInterrupt);
}

}  // namespace

void deferInterrupt() {
  if (std::signal(SIGINT, noteInterrupt) == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

bool interrupted() {
  return gInterrupted != 0;
}

void endByInterrupt() {
  std::signal(SIGINT, SIG_DFL);
  std::raise(SIGINT);
  std::abort();  // not reached: SIGINT is not ignored here
}

}  // namespace meniscus
