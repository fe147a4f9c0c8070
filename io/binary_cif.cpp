#include "io/binary_cif.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <variant>
#include <vector>

#include "core/error.h"

namespace meniscus {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;
using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;
/// A column on its way from bytes to numbers or texts.
using Values = std::variant<Bytes, Numbers, Texts>;

constexpr std::size_t kMostValues = std::size_t{1} << 28;

[[noreturn]] void damaged(std::string_view what) {
  throw InputError(fmt::format("is damaged BinaryCIF ({}): fetch it again", what));
}

const Json& member(const Json& object, const char* name) {
  if (!object.is_object() || !object.contains(name)) damaged(fmt::format("no '{}'", name));
  return object[name];
}

std::string textOf(const Json& json) {
  if (!json.is_string()) damaged("a name is no text");
  return json.get<std::string>();
}

double numberOf(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_number()) damaged(fmt::format("'{}' is no number", name));
  return value.get<double>();
}

std::size_t sizeOf(const Json& object, const char* name) {
  const double value = numberOf(object, name);
  if (!(value >= 0 && value <= static_cast<double>(kMostValues)))
    damaged(fmt::format("'{}' is no size", name));
  return static_cast<std::size_t>(value);
}

const Bytes& bytesOf(const Json& json) {
  if (!json.is_binary()) damaged("data are no bytes");
  return json.get_binary();
}

template <typename T>
Numbers readArray(const Bytes& bytes) {
  Numbers numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));  // little-endian, as this machine is
    numbers[i] = static_cast<double>(value);
  }
  return numbers;
}

Numbers byteArray(const Json& encoding, const Bytes& bytes) {
  switch (static_cast<int>(numberOf(encoding, "type"))) {
    case 1:
      return readArray<std::int8_t>(bytes);
    case 2:
      return readArray<std::int16_t>(bytes);
    case 3:
      return readArray<std::int32_t>(bytes);
    case 4:
      return readArray<std::uint8_t>(bytes);
    case 5:
      return readArray<std::uint16_t>(bytes);
    case 6:
      return readArray<std::uint32_t>(bytes);
    case 32:
      return readArray<float>(bytes);
    case 33:
      return readArray<double>(bytes);
    default:
      damaged("unknown type of numbers");
  }
}

Numbers unpackIntegers(const Json& encoding, const Numbers& packed) {
  const bool isUnsigned =
      member(encoding, "isUnsigned").is_boolean() && member(encoding, "isUnsigned").get<bool>();
  const bool oneByte = numberOf(encoding, "byteCount") == 1;
  const double high = isUnsigned ? (oneByte ? 255 : 65535) : (oneByte ? 127 : 32767);
  const double low = isUnsigned ? -1 : -high - 1;  // an unsigned one has no lower limit
  Numbers numbers;
  numbers.reserve(std::min(sizeOf(encoding, "srcSize"), packed.size()));
  double sum = 0;
  for (const double value : packed) {
    sum += value;
    if (value == high || value == low) continue;
    numbers.push_back(sum);
    sum = 0;
  }
  return numbers;
}

Numbers runLength(const Json& encoding, const Numbers& pairs) {
  const std::size_t size = sizeOf(encoding, "srcSize");
  Numbers numbers;
  numbers.reserve(size);
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
    const double count = pairs[i + 1];
    if (!(count >= 0 && static_cast<double>(numbers.size()) + count <= static_cast<double>(size)))
      damaged("a run is longer than its column");
    numbers.insert(numbers.end(), static_cast<std::size_t>(count), pairs[i]);
  }
  return numbers;
}

Values decode(const Json& data);
Values decodeAll(Values values, const Json& encodings);

Texts stringArray(const Json& encoding, const Bytes& bytes) {
  const std::string all = textOf(member(encoding, "stringData"));
  const Values offsets = decodeAll(bytesOf(member(encoding, "offsets")), member(encoding, "offsetEncoding"));
  const Values indices = decodeAll(bytes, member(encoding, "dataEncoding"));
  if (!std::holds_alternative<Numbers>(offsets) || !std::holds_alternative<Numbers>(indices))
    damaged("indices are no numbers");
  const Numbers& places = std::get<Numbers>(offsets);
  Texts texts;
  for (const double index : std::get<Numbers>(indices)) {
    if (index < 0) {
      texts.emplace_back();
      continue;
    }
    const auto i = static_cast<std::size_t>(index);
    if (i + 1 >= places.size()) damaged("an index beyond the texts");
    const double begin = places[i], end = places[i + 1];
    if (!(begin >= 0 && begin <= end && end <= static_cast<double>(all.size())))
      damaged("a text beyond its data");
    texts.push_back(all.substr(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
  }
  return texts;
}

Values decodeOne(Values values, const Json& encoding) {
  const std::string kind = textOf(member(encoding, "kind"));
  if (Bytes* bytes = std::get_if<Bytes>(&values)) {
    if (kind == "ByteArray") return byteArray(encoding, *bytes);
    if (kind == "StringArray") return stringArray(encoding, *bytes);
    damaged(fmt::format("'{}' of bytes", kind));
  }
  Numbers* numbers = std::get_if<Numbers>(&values);
  if (!numbers) damaged(fmt::format("'{}' of texts", kind));
  if (kind == "IntegerPacking") return unpackIntegers(encoding, *numbers);
  if (kind == "RunLength") return runLength(encoding, *numbers);
  if (kind == "Delta") {
    double sum = numberOf(encoding, "origin");
    for (double& n : *numbers) n = sum += n;
  } else if (kind == "FixedPoint") {
    const double factor = numberOf(encoding, "factor");
    if (!(factor > 0)) damaged("a factor of zero");
    for (double& n : *numbers) n /= factor;
  } else if (kind == "IntervalQuantization") {
    const double least = numberOf(encoding, "min"), most = numberOf(encoding, "max"),
                 steps = numberOf(encoding, "numSteps");
    if (!(steps > 1)) damaged("an interval without steps");
    for (double& n : *numbers) n = least + (most - least) * n / (steps - 1);
  } else {
    damaged(fmt::format("unknown encoding '{}'", kind));
  }
  return values;
}

Values decodeAll(Values values, const Json& encodings) {
  if (!encodings.is_array()) damaged("encodings are no list");
  for (auto encoding = encodings.rbegin(); encoding != encodings.rend(); ++encoding)
    values = decodeOne(std::move(values), *encoding);
  return values;
}

Values decode(const Json& data) {
  return decodeAll(bytesOf(member(data, "data")), member(data, "encoding"));
}

/// nlohmann's builder of a document, which ends where the parser, that calls itself, would get too deep.
class ShallowBuilder : public nlohmann::detail::json_sax_dom_parser<Json> {
 public:
  using Base = nlohmann::detail::json_sax_dom_parser<Json>;
  explicit ShallowBuilder(Json& document) : Base(document, false) {}
  bool start_object(std::size_t size) { return ++depth_ < kDeepest && Base::start_object(size); }
  bool start_array(std::size_t size) { return ++depth_ < kDeepest && Base::start_array(size); }
  bool end_object() { return depth_-- > 0 && Base::end_object(); }
  bool end_array() { return depth_-- > 0 && Base::end_array(); }

 private:
  static constexpr int kDeepest = 64;
  int depth_ = 0;
};

/// A value as CIF 1.1 quotes it.
std::string quoted(const std::string& text) {
  if (text.find('\n') != std::string::npos) return "\n;" + text + "\n;";
  if (text.empty()) return "''";
  // An underscore also makes tags and reserved words, in any letter case: data_, loop_, stop_, ...
  const bool plain = text.find_first_of(" \t'\"#_") == std::string::npos && text[0] != '$' &&
                     text[0] != ';' && text[0] != '[' && text[0] != ']' && text != "." && text != "?";
  if (plain) return text;
  if (text.find('\'') == std::string::npos) return "'" + text + "'";
  if (text.find('"') == std::string::npos) return '"' + text + '"';
  return "\n;" + text + "\n;";
}

Texts columnTexts(const Json& column, std::size_t rows) {
  const Values values = decode(member(column, "data"));
  const Numbers* numbers = std::get_if<Numbers>(&values);
  const Texts* texts = std::get_if<Texts>(&values);
  if ((numbers ? numbers->size() : texts ? texts->size() : rows + 1) != rows)
    damaged("a column of another length");
  Texts out(rows);
  for (std::size_t i = 0; i < rows; ++i)
    out[i] = numbers ? fmt::format("{:.9g}", (*numbers)[i]) : quoted((*texts)[i]);
  if (!column.contains("mask") || column["mask"].is_null()) return out;
  const Values mask = decode(column["mask"]);
  const Numbers* marks = std::get_if<Numbers>(&mask);
  if (!marks || marks->size() != rows) damaged("a mask of another length");
  for (std::size_t i = 0; i < rows; ++i)
    if ((*marks)[i] != 0) out[i] = (*marks)[i] == 1 ? "." : "?";
  return out;
}

void writeCategory(const Json& category, std::string& out) {
  std::string name = textOf(member(category, "name"));
  if (!name.starts_with('_')) name.insert(0, 1, '_');
  const std::size_t rows = sizeOf(category, "rowCount");
  std::vector<Texts> columns;
  std::string tags = "loop_\n";
  for (const Json& column : member(category, "columns")) {
    tags += name + "." + textOf(member(column, "name")) + "\n";
    columns.push_back(columnTexts(column, rows));
  }
  if (rows == 0 || columns.empty()) return;
  out += tags;
  for (std::size_t row = 0; row < rows; ++row) {
    for (const Texts& column : columns) {
      out += column[row];
      out += ' ';
    }
    out += '\n';
  }
}

}  // namespace

bool isBinaryCif(std::string_view bytes) {
  if (bytes.empty() || (static_cast<unsigned char>(bytes[0]) & 0xF0u) != 0x80u) return false;  // a small map
  return bytes.substr(0, 4096).find("dataBlocks") != std::string_view::npos ||
         bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 4096)).find("dataBlocks") !=
             std::string_view::npos;
}

std::string textFromBinaryCif(std::string_view bytes) {
  Json file;
  ShallowBuilder builder(file);
  if (!Json::sax_parse(bytes.begin(), bytes.end(), &builder, Json::input_format_t::msgpack))
    damaged("no MessagePack");
  std::string text;
  for (const Json& block : member(file, "dataBlocks")) {
    text += "data_" + textOf(member(block, "header")) + "\n";
    for (const Json& category : member(block, "categories")) writeCategory(category, text);
  }
  return text;
}

}  // namespace meniscus
