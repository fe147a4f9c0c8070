#pragma once
// Widgets for options of `meniscus render`, by their names (without "--").

#include <span>
#include <string>

#include "app/view/session.h"

namespace meniscus {

/// A choice of words; `shown` is what is in force now.
void optionCombo(Document& document, const char* label, const char* option,
                 std::span<const char* const> words, const std::string& shown);

/// A number; `shown` is what is in force where the option is not given. `form` as in printf, with the unit.
void optionSlider(Document& document, const char* label, const char* option, double shown, double least,
                  double most, const char* form, bool logarithmic = false);
void optionSlider(Document& document, const char* label, const char* option, int shown, int least, int most);

/// A colour; one step from the first movement of the mouse to its release.
void optionColor(Document& document, const char* label, const char* option, Rgb shown);

/// An option of two words.
void optionCheck(Document& document, const char* label, const char* option, bool shown, const char* on,
                 const char* off);
/// An option without a value.
void optionFlag(Document& document, const char* label, const char* option);
/// Whether one of the values of an option that may be repeated is there.
void optionMember(Document& document, const char* label, const char* option, const std::string& value,
                  bool inverse = false);

/// Spacefill, ball and stick, ...; true if another was chosen, which is in `word` then.
bool representationCombo(const char* label, std::string& word);
/// Schemes and colours of one's own; as above. The last item is the colour, as after colorEdit().
bool coloringCombo(const char* label, std::string& word);
/// A colour as '#RRGGBB'; as above, while it is being chosen, too: ImGui::IsItemDeactivatedAfterEdit() says
/// when that ends.
bool colorEdit(const char* label, Rgb& color);

}  // namespace meniscus
