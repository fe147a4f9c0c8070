#include "io/assembly_records.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace meniscus {
namespace {

constexpr std::size_t kMaxOperations = 1'000'000;

std::optional<int> parseCount(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

/// One factor of a product, without its brackets: "1,2,5-9,P".
std::optional<std::vector<glm::dmat4>> expandFactor(std::string_view list,
                                                    const std::map<std::string, glm::dmat4>& operators) {
  std::vector<glm::dmat4> matrices;
  const auto append = [&](const std::string& name) {
    const auto found = operators.find(name);
    if (found != operators.end()) matrices.push_back(found->second);
    return found != operators.end();
  };
  while (true) {
    const std::size_t comma = list.find(',');
    std::string_view item = list.substr(0, comma);
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    while (!item.empty() && item.back() == ' ') item.remove_suffix(1);
    const std::size_t dash = item.find('-');
    const auto first = dash == std::string_view::npos ? std::nullopt : parseCount(item.substr(0, dash));
    const auto last = first ? parseCount(item.substr(dash + 1)) : std::nullopt;
    if (first && last) {
      for (int i = *first; i <= *last; ++i) {
        if (!append(std::to_string(i))) return std::nullopt;
      }
    } else if (!append(std::string(item))) {
      return std::nullopt;
    }
    if (matrices.size() > kMaxOperations) return std::nullopt;
    if (comma == std::string_view::npos) return matrices;
    list.remove_prefix(comma + 1);
  }
}

/// Makes one range of those that follow each other without a gap; they are sorted and disjoint.
void joinNeighbors(std::vector<IndexRange>& ranges) {
  std::size_t kept = 0;
  for (const IndexRange& range : ranges) {
    if (kept > 0 && ranges[kept - 1].end() == range.first) {
      ranges[kept - 1].count += range.count;
    } else {
      ranges[kept++] = range;
    }
  }
  ranges.resize(kept);
}

}  // namespace

std::optional<std::vector<glm::dmat4>> expandOperations(const std::string& expression,
                                                        const std::map<std::string, glm::dmat4>& operators) {
  std::string_view rest = expression;
  if (rest.find('(') == std::string_view::npos) return expandFactor(rest, operators);
  std::vector<glm::dmat4> product{glm::dmat4(1.0)};
  while (!rest.empty()) {
    if (rest.front() == ' ' || rest.front() == '*') {
      rest.remove_prefix(1);
      continue;
    }
    const std::size_t close = rest.find(')');
    if (rest.front() != '(' || close == std::string_view::npos) return std::nullopt;
    const auto factor = expandFactor(rest.substr(1, close - 1), operators);
    if (!factor || product.size() * factor->size() > kMaxOperations) return std::nullopt;
    std::vector<glm::dmat4> next;
    next.reserve(product.size() * factor->size());
    for (const glm::dmat4& left : product) {
      for (const glm::dmat4& right : *factor) next.push_back(left * right);
    }
    product = std::move(next);
    rest.remove_prefix(close + 1);
  }
  return product;
}

void addAssemblies(Molecule& molecule, const std::vector<AssemblyRecord>& records, ChainNaming naming,
                   Oddities& oddities) {
  if (records.empty()) return;
  std::unordered_map<std::string_view, std::vector<IndexRange>> rangesOf;
  for (std::uint32_t i = 0; i < molecule.residues.size(); ++i) {
    const Residue& residue = molecule.residues[i];
    const std::string& chain =
        naming == ChainNaming::subchain ? residue.subchain : molecule.chains[residue.chain].name;
    std::vector<IndexRange>& ranges = rangesOf[chain];
    if (ranges.empty() || ranges.back().end() != i) ranges.push_back({i, 0});
    ++ranges.back().count;
  }
  for (const AssemblyRecord& record : records) {
    Assembly assembly;
    assembly.id = record.id;
    for (const AssemblyRecord::Generator& from : record.generators) {
      Assembly::Generator generator;
      generator.operations = from.operations;
      std::vector<std::string> chains = from.chains;
      std::sort(chains.begin(), chains.end());
      chains.erase(std::unique(chains.begin(), chains.end()), chains.end());
      for (const std::string& chain : chains) {
        const auto found = rangesOf.find(chain);
        if (found == rangesOf.end()) {
          oddities.add("an assembly names a chain that is not there: left out", 0);
        } else {
          generator.residues.insert(generator.residues.end(), found->second.begin(), found->second.end());
        }
      }
      std::sort(generator.residues.begin(), generator.residues.end(),
                [](const IndexRange& a, const IndexRange& b) { return a.first < b.first; });
      joinNeighbors(generator.residues);
      if (!generator.residues.empty() && !generator.operations.empty()) {
        assembly.generators.push_back(std::move(generator));
      }
    }
    if (assembly.generators.empty()) {
      oddities.add("an assembly has no chains or no operators: left out", 0);
    } else {
      molecule.assemblies.push_back(std::move(assembly));
    }
  }
}

}  // namespace meniscus
