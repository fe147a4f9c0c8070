// What the process has used so far, and what there is, from the operating system.

#include <sys/resource.h>
#include <unistd.h>

#include <ctime>

#include "app/run_report.h"

namespace meniscus {
namespace {

const auto processStart = std::chrono::steady_clock::now();

}  // namespace

void addProcessUsage(RunReport& report) {
  report.totalSeconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - processStart).count();
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  report.cpuSeconds = static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  report.peakMemoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t physicalMemoryBytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), pageSize = sysconf(_SC_PAGESIZE);
  return pages > 0 && pageSize > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(pageSize)
                                   : 0;
}

}  // namespace meniscus
