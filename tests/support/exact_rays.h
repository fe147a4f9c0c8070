#pragma once
// Exact rays against quadrics, by the names that tests know.

#include "core/exact_quadrics.h"

namespace meniscus::test {

using namespace exact;

}  // namespace meniscus::test
