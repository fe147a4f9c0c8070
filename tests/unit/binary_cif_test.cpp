#include "io/binary_cif.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/structure_reader.h"

namespace meniscus::test {
namespace {

using Json = nlohmann::json;

template <typename T>
Json binary(const std::vector<T>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return Json::binary(bytes);
}

Json byteArray(int type) {
  return {{"kind", "ByteArray"}, {"type", type}};
}

Json data(Json bytes, std::vector<Json> encodings) {
  return {{"data", std::move(bytes)}, {"encoding", std::move(encodings)}};
}

Json column(const char* name, Json values, Json mask = nullptr) {
  return {{"name", name}, {"data", std::move(values)}, {"mask", std::move(mask)}};
}

/// Texts, each once, by their places.
Json texts(const std::string& all, const std::vector<std::int32_t>& offsets,
           const std::vector<std::int8_t>& indices) {
  return data(binary(indices), {{{"kind", "StringArray"},
                                 {"dataEncoding", {byteArray(1)}},
                                 {"stringData", all},
                                 {"offsetEncoding", {byteArray(3)}},
                                 {"offsets", binary(offsets)}}});
}

/// Three atoms, every encoding used at least once.
Json document() {
  const Json x = data(binary<std::int32_t>({1500, -500, 250}),
                      {{{"kind", "FixedPoint"}, {"factor", 1000}, {"srcType", 33}},
                       {{"kind", "Delta"}, {"origin", 0}, {"srcType", 3}},
                       byteArray(3)});
  const Json y = data(binary<float>({1.25f, -2.5f, 1e-3f}), {byteArray(32)});
  const Json z =
      data(binary<std::uint8_t>({0, 128, 255}),
           {{{"kind", "IntervalQuantization"}, {"min", 0}, {"max", 255}, {"numSteps", 256}, {"srcType", 33}},
            byteArray(4)});
  const Json id = data(
      binary<std::int8_t>({127, 10, 5, -128, -3}),
      {{{"kind", "IntegerPacking"}, {"byteCount", 1}, {"isUnsigned", false}, {"srcSize", 3}}, byteArray(1)});
  const Json seq = data(binary<std::int32_t>({7, 3}),
                        {{{"kind", "RunLength"}, {"srcSize", 3}, {"srcType", 3}}, byteArray(3)});
  const Json alt = column("label_alt_id", texts("A", {0, 1}, {-1, 0, -1}),
                          data(binary<std::uint8_t>({1, 0, 2}), {byteArray(4)}));
  Json columns{column("Cartn_x", x),
               column("Cartn_y", y),
               column("Cartn_z", z),
               column("id", id),
               column("auth_seq_id", seq),
               alt,
               column("label_atom_id", texts("N\"CA'C", {0, 2, 5, 6}, {0, 1, 2})),
               column("type_symbol", texts("NC", {0, 1, 2}, {0, 1, 1})),
               column("auth_asym_id", texts("A", {0, 1}, {0, 0, 0})),
               column("label_comp_id", texts("A LY", {0, 4}, {0, 0, 0}))};
  return {{"version", "0.3.0"},
          {"encoder", "test"},
          {"dataBlocks",
           {{{"header", "TEST"},
             {"categories", {{{"name", "_atom_site"}, {"rowCount", 3}, {"columns", columns}}}}}}}};
}

std::string packed(const Json& json) {
  const std::vector<std::uint8_t> bytes = Json::to_msgpack(json);
  return {bytes.begin(), bytes.end()};
}

TEST(BinaryCif, holdsWhatItsColumnsEncode) {
  const std::string bytes = packed(document());
  ASSERT_TRUE(isBinaryCif(bytes));
  Logger logger;
  const Molecule m = readStructureBytes(bytes, "test.bcif", {}, logger).models.at(0);
  ASSERT_EQ(m.atomCount(), 3u);
  EXPECT_EQ(m.positions[0], glm::dvec3(1.5, 1.25, 0));
  EXPECT_EQ(m.positions[1], glm::dvec3(1.0, -2.5, 128));
  EXPECT_NEAR(m.positions[2].y, 1e-3, 1e-9);
  EXPECT_EQ(m.positions[2].z, 255);
  EXPECT_EQ(m.serials, (std::vector<std::int32_t>{137, 5, -131}));
  EXPECT_EQ(m.residues.at(0).number, 7);
  EXPECT_EQ(m.residues.at(0).name, "A LY");
  EXPECT_EQ(m.altlocs, (std::vector<char>{' ', 'A', ' '}));
  EXPECT_EQ(m.names[0].view(), "N\"");
  EXPECT_EQ(m.names[1].view(), "CA'");
}

// As text they would be tags, reserved words in any letter case, or the end of a text.
TEST(BinaryCif, holdsWordsThatTextReserves) {
  for (const char* word : {"STOP_", "global_", "Data_x", "loop_", "_tag", "'", ";x", "[1]"}) {
    SCOPED_TRACE(word);
    Json json = document();
    const auto length = static_cast<std::int32_t>(std::strlen(word));
    json["dataBlocks"][0]["categories"][0]["columns"][8] =
        column("auth_asym_id", texts(word, {0, length}, {0, 0, 0}));
    Logger logger;
    const Molecule m = readStructureBytes(packed(json), "test.bcif", {}, logger).models.at(0);
    EXPECT_EQ(m.chains.at(0).name, word);
  }
}

TEST(BinaryCif, damageIsSaid) {
  Logger logger;
  const auto errorOf = [&](const std::string& bytes) {
    try {
      readStructureBytes(bytes, "test.bcif", {}, logger);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string whole = packed(document());
  for (std::size_t length : {std::size_t{40}, whole.size() / 2, whole.size() - 1})
    EXPECT_NE(errorOf(whole.substr(0, length)).find("test.bcif"), std::string::npos);
  const auto with = [&](const char* pointer, Json value) {
    Json json = document();
    json[Json::json_pointer(std::string("/dataBlocks/0/categories/0/") + pointer)] = std::move(value);
    return errorOf(packed(json));
  };
  EXPECT_NE(with("rowCount", 4).find("another length"), std::string::npos);
  EXPECT_NE(with("rowCount", -1).find("is no size"), std::string::npos);
  EXPECT_NE(with("columns/0/data/encoding/0/kind", "Magic").find("unknown encoding 'Magic'"),
            std::string::npos);
  EXPECT_NE(with("columns/6/data/encoding/0/offsets", binary<std::int32_t>({0, 99, 100, 101})).find("beyond"),
            std::string::npos);
  EXPECT_NE(with("columns/4/data/encoding/0/srcSize", 2).find("longer than its column"), std::string::npos);
  EXPECT_NE(errorOf("\x81\xaa"
                    "dataBlocks" +
                    std::string(1u << 20, '\x91'))
                .find("MessagePack"),
            std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
