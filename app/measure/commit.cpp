#include "app/measure/output_folder.h"

namespace meniscus::measure {

const char* commit() {
  return MENISCUS_COMMIT;
}

}  // namespace meniscus::measure
