#include "tests/support/paths.h"

namespace meniscus::test {

std::string projectFile(const std::string& name) {
  return MENISCUS_PROJECT "/" + name;
}

std::string program() {
  return MENISCUS_EXECUTABLE;
}

}  // namespace meniscus::test
