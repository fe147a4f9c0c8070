#include "app/view/option_widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "app/option_values.h"

namespace meniscus {
namespace {

constexpr std::array<const char*, 6> kSchemes{"element", "chain", "residue", "bfactor", "plddt", "rainbow"};

template <typename Number>
Number numberOf(const std::string& text, Number otherwise) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() ? number : otherwise;
}

bool wordCombo(const char* label, std::span<const char* const> words, std::string& word) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, word.c_str())) return false;
  for (const char* candidate : words) {
    if (ImGui::Selectable(candidate, word == candidate) && word != candidate) {
      word = candidate;
      changed = true;
    }
  }
  ImGui::EndCombo();
  return changed;
}

}  // namespace

void optionCombo(Document& document, const char* label, const char* option,
                 std::span<const char* const> words, const std::string& shown) {
  std::string word = document.value(option).value_or(shown);
  if (wordCombo(label, words, word)) document.set(option, word);
}

void optionSlider(Document& document, const char* label, const char* option, double shown, double least,
                  double most, const char* form, bool logarithmic) {
  const std::optional<std::string> given = document.value(option);
  auto value = static_cast<float>(given ? numberOf(*given, shown) : shown);
  const ImGuiSliderFlags flags =
      (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp;
  if (ImGui::SliderFloat(label, &value, static_cast<float>(least), static_cast<float>(most), form, flags))
    document.set(option, fmt::format("{:.4g}", std::clamp(static_cast<double>(value), least, most)), true);
  if (ImGui::IsItemDeactivatedAfterEdit()) document.endChange();
}

void optionSlider(Document& document, const char* label, const char* option, int shown, int least, int most) {
  const std::optional<std::string> given = document.value(option);
  int value = given ? numberOf(*given, shown) : shown;
  if (ImGui::SliderInt(label, &value, least, most, "%d", ImGuiSliderFlags_AlwaysClamp))
    document.set(option, std::to_string(value), true);
  if (ImGui::IsItemDeactivatedAfterEdit()) document.endChange();
}

void optionCheck(Document& document, const char* label, const char* option, bool shown, const char* on,
                 const char* off) {
  const std::optional<std::string> given = document.value(option);
  bool value = given ? *given == on : shown;
  if (ImGui::Checkbox(label, &value)) document.set(option, value ? on : off);
}

void optionFlag(Document& document, const char* label, const char* option) {
  bool value = document.has(option);
  if (!ImGui::Checkbox(label, &value)) return;
  if (value) {
    document.set(option, "");
  } else {
    document.remove(option);
  }
}

void optionMember(Document& document, const char* label, const char* option, const std::string& value,
                  bool inverse) {
  std::vector<std::string> values = document.values(option);
  const auto found = std::find(values.begin(), values.end(), value);
  bool there = (found != values.end()) != inverse;
  if (!ImGui::Checkbox(label, &there)) return;
  if (found != values.end()) {
    values.erase(found);
  } else {
    values.push_back(value);
  }
  document.setAll(option, values);
}

bool representationCombo(const char* label, std::string& word) {
  std::array<const char*, kRepresentationsOffered.size()> words;
  std::transform(kRepresentationsOffered.begin(), kRepresentationsOffered.end(), words.begin(),
                 [](Representation offered) { return representationName(offered).data(); });
  return wordCombo(label, words, word);
}

bool coloringCombo(const char* label, std::string& word) {
  if (wordCombo(label, kSchemes, word)) return true;
  ImGui::SameLine();
  ImGui::PushID(label);
  Rgb color = colorFromHex(word).value_or(0xCCCCCC);
  const bool changed = colorEdit("##color", color);
  ImGui::PopID();
  if (changed) word = fmt::format("#{:06X}", color);
  return changed;
}

void optionColor(Document& document, const char* label, const char* option, Rgb shown) {
  if (colorEdit(label, shown)) document.set(option, fmt::format("#{:06X}", shown), true);
  if (ImGui::IsItemDeactivatedAfterEdit()) document.endChange();
}

bool colorEdit(const char* label, Rgb& color) {
  const auto channel = [&](int shift) { return static_cast<float>((color >> shift) & 0xFFu) / 255.0f; };
  std::array<float, 3> rgb{channel(16), channel(8), channel(0)};
  if (!ImGui::ColorEdit3(label, rgb.data(), ImGuiColorEditFlags_NoInputs)) return false;
  const auto byte = [](float share) {
    return static_cast<Rgb>(std::lround(std::clamp(share, 0.0f, 1.0f) * 255.0f));
  };
  color = byte(rgb[0]) << 16 | byte(rgb[1]) << 8 | byte(rgb[2]);
  return true;
}

}  // namespace meniscus
