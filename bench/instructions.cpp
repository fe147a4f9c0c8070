#include "bench/instructions.h"

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>

namespace meniscus::bench {

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

// Of the child between its two stops, which frame the call.
std::uint64_t stepsOf(const std::function<void()>& call) {
  const pid_t child = fork();
  if (child < 0) fail("cannot begin a process to count in");
  if (child == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
    raise(SIGSTOP);
    call();
    raise(SIGSTOP);
    _exit(0);
  }
  int status = 0;
  const auto stoppedBy = [&] { return WIFSTOPPED(status) ? WSTOPSIG(status) : 0; };
  if (waitpid(child, &status, 0) != child || stoppedBy() != SIGSTOP)
    throw std::runtime_error("cannot trace a process to count its instructions");
  std::uint64_t steps = 0;
  do {
    if (ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0) fail("cannot step through a process");
    if (waitpid(child, &status, 0) != child) fail("lost the process to count in");
    ++steps;
  } while (stoppedBy() == SIGTRAP);
  if (stoppedBy() != SIGSTOP) throw std::runtime_error("the call to count did not return");
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return steps;
}

}  // namespace

std::uint64_t instructionsOf(const std::function<void()>& call) {
  const std::uint64_t around = stepsOf([] {});
  return stepsOf(call) - around;
}

}  // namespace meniscus::bench
