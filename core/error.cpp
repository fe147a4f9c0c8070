#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace meniscus {

void failCheck(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "meniscus: internal error: %s does not hold (%s:%d); please report it\n", condition,
               file, line);
  std::abort();
}

}  // namespace meniscus
