#include "app/commands.h"

namespace meniscus {

const char* version() {
  return MENISCUS_VERSION;
}

}  // namespace meniscus
