#include "io/format_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace meniscus {

std::vector<std::size_t> chooseModels(std::vector<int>& numbers, const ModelChoice& choice,
                                      Oddities& oddities) {
  std::vector<int> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    oddities.add("model numbers repeat: models are numbered 1, 2, ... as they come", 0);
    std::iota(numbers.begin(), numbers.end(), 1);
  }
  std::vector<std::size_t> chosen(choice.all ? numbers.size() : 1);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (choice.index) {
    if (*choice.index < 0 || static_cast<std::size_t>(*choice.index) >= numbers.size())
      throw UsageError(fmt::format("no model at index {}: the file has {}, counted from 0", *choice.index,
                                   numbers.size()));
    return {static_cast<std::size_t>(*choice.index)};
  }
  if (choice.all || !choice.number) return chosen;
  const auto found = std::find(numbers.begin(), numbers.end(), *choice.number);
  if (found == numbers.end()) {
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    throw UsageError(
        fmt::format("no model {}: the file has {} model{}, numbered {}", *choice.number, numbers.size(),
                    numbers.size() == 1 ? "" : "s",
                    *low == *high ? fmt::format("{}", *low) : fmt::format("{} to {}", *low, *high)));
  }
  chosen[0] = static_cast<std::size_t>(found - numbers.begin());
  return chosen;
}

void markPredicted(Molecule& molecule, Oddities& oddities) {
  const auto [low, high] = std::minmax_element(molecule.bFactors.begin(), molecule.bFactors.end());
  if (molecule.bFactors.empty() || *low < 0.0f || *high > 100.0f || *high == 0.0f) return;
  molecule.predicted = true;
  if (*high > 1.0f) return;
  oddities.add("pLDDT is given from 0 to 1: scaled to 100", 0);
  for (float& b : molecule.bFactors) b *= 100.0f;
}

}  // namespace meniscus
