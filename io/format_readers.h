#pragma once
// What the readers of the single formats share.

#include <optional>
#include <string>
#include <vector>

#include "io/molecule_builder.h"
#include "io/oddities.h"

namespace meniscus {

struct ModelChoice {
  std::optional<int> number;  ///< nothing = the first, unless `all`
  bool all = false;
  std::optional<int> index = std::nullopt;  ///< position in the file, from 0; before `number`
};

/// Models as read, before any atom is filtered out. Names are empty if the file gives none.
struct ReadModels {
  std::vector<Molecule> models;
  int modelCount = 0;
};

/// Positions of the chosen models in a list of the numbers that a file gives them. Numbers that repeat are
/// replaced by 1, 2, ... Throws UsageError if the chosen one does not occur.
std::vector<std::size_t> chooseModels(std::vector<int>& numbers, const ModelChoice& choice,
                                      Oddities& oddities);

/// In a predicted model the B column holds pLDDT: sets Molecule::predicted if its values allow that, scaling
/// 0..1 to 0..100.
void markPredicted(Molecule& molecule, Oddities& oddities);

// The readers throw InputError without the file's name, with the line where they know it.
ReadModels readPdb(const std::string& text, const ModelChoice& choice, Oddities& oddities);
ReadModels readMmcif(const std::string& text, const ModelChoice& choice, Oddities& oddities);

}  // namespace meniscus
