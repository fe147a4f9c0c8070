#pragma once
// A kernel of every shape, the power kernel from its softest to its hardest.

#include <vector>

#include "core/metaball_field.h"

namespace meniscus::test {

inline const std::vector<Kernel> kKernels{{KernelShape::sextic},   {KernelShape::quartic},
                                          {KernelShape::power, 2}, {KernelShape::power, 3},
                                          {KernelShape::power, 5}, {KernelShape::power, 16}};

}  // namespace meniscus::test
