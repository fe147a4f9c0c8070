#include "app/output_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace meniscus {
namespace {

/// Calls `literal(text)` and `placeholder(name)` for the parts of a pattern in order.
template <typename Literal, typename Placeholder>
void walk(std::string_view pattern, Literal literal, Placeholder placeholder) {
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    const bool doubled = i + 1 < pattern.size() && pattern[i + 1] == c;
    if ((c == '{' || c == '}') && doubled) {
      literal(c);
      ++i;
    } else if (c == '{') {
      const std::size_t end = pattern.find('}', i);
      if (end == std::string_view::npos)
        throw UsageError(fmt::format("--output: '{}' lacks a }}; write {{{{ for a brace", pattern));
      placeholder(pattern.substr(i + 1, end - i - 1));
      i = end;
    } else {
      literal(c);
    }
  }
}

}  // namespace

OutputPattern::OutputPattern(std::string pattern) : pattern_(std::move(pattern)) {
  walk(
      pattern_, [](char) {},
      [this](std::string_view name) {
        if (name == "stem")
          namesStem_ = true;
        else if (name == "model")
          namesModel_ = true;
        else if (name == "state")
          namesState_ = true;
        else if (name == "frame")
          namesFrame_ = true;
        else
          throw UsageError(
              fmt::format("--output: '{{{}}}' in '{}' is not known; there are {{stem}}, {{model}}, {{state}} "
                          "and {{frame}}",
                          name, pattern_));
      });
}

std::string OutputPattern::nameFor(const std::filesystem::path& input, const OutputPlace& place) const {
  std::string state = place.state;
  std::replace(state.begin(), state.end(), '/', '_');
  std::string name;
  walk(
      pattern_, [&](char c) { name += c; },
      [&](std::string_view placeholder) {
        name += placeholder == "stem"    ? stemOf(input)
                : placeholder == "model" ? std::to_string(place.model)
                : placeholder == "state" ? state
                                         : fmt::format("{:05}", place.frame);
      });
  return name;
}

std::string stemOf(const std::filesystem::path& input) {
  std::filesystem::path stem = input.filename();
  if (stem.extension() == ".gz" || stem.extension() == ".GZ") stem = stem.stem();
  return stem.stem().string();
}

void requireDistinctOutputs(const OutputPattern& pattern, const std::vector<std::string>& inputs) {
  std::map<std::string, std::string> inputOf;
  for (const std::string& input : inputs) {
    const std::string name = pattern.nameFor(input, {});
    const auto [entry, added] = inputOf.emplace(name, input);
    if (added) continue;
    if (!pattern.namesStem())
      throw UsageError(
          fmt::format("--output: '{}' is one name for {} inputs; put {{stem}} into it", name, inputs.size()));
    throw UsageError(
        fmt::format("--output: '{}' and '{}' would both be written to '{}'; render them one by one",
                    entry->second, input, name));
  }
}

}  // namespace meniscus
