#pragma once
// Seeded random numbers, by the name that tests know.

#include "core/random.h"

namespace meniscus::test {

using meniscus::Random;

}  // namespace meniscus::test
