// What is wrong with a scene is said in one line that names the place.

#include <zip.h>

#include "app/option_values.h"
#include "app/scene/archive.h"
#include "app/scene/settings.h"
#include "app/structure_pictures.h"
#include "core/error.h"
#include "tests/support/paths.h"
#include "tests/unit/scene_files.h"

namespace meniscus::test {
namespace {

class SceneErrors : public SceneFileTest {
 protected:
  /// Writes a zip archive.
  void writeArchive(const std::string& name,
                    const std::vector<std::pair<std::string, std::string>>& entries) {
    const std::string path = (folder_ / name).string();
    int error = 0;
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    ASSERT_NE(archive, nullptr);
    for (const auto& [entry, bytes] : entries) {
      zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
      ASSERT_GE(zip_file_add(archive, entry.c_str(), source, ZIP_FL_ENC_UTF_8), 0);
    }
    ASSERT_EQ(zip_close(archive), 0);
  }
  std::string errorOfArchive(const std::string& name) {
    try {
      MvsFile file(folder_ / name, {true, folder_ / "cache"});
      scenePictures(name, file, options());
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  static void expectParts(const std::string& error, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(error.find(part), std::string::npos) << error << "\nlacks " << part;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
};

TEST_F(SceneErrors, brokenJsonIsFoundByLineAndColumn) {
  expectParts(errorOf(std::string("{\n  \"root\": {,\n}")), {"fig.mvsj: line 2, column 12", "no valid JSON"});
  expectParts(errorOf(std::string("{\"root\": \"\xff\"}")), {"fig.mvsj", "line 1"});
  expectParts(errorOf(std::string(5000, '[')), {"line 1, column 201", "nested"});
  expectParts(errorOf(std::string("{\"root\":\"") + std::string(65u << 20, 'x') + "\"}"), {"64 MiB"});
  expectParts(errorOf(std::string("[]")), {"fig.mvsj", "a list, not an object"});
  expectParts(errorOf(std::string("{\"metadata\":{\"version\":\"1\"}}")), {"fig.mvsj: lacks 'root'"});
}

TEST_F(SceneErrors, wrongTypesAndKindsAreNamed) {
  const auto with = [&](Json change, const char* pointer) {
    Json scene = structureScene("1ubq.pdb", {shown("all", "spacefill", {node("color", {{"color", "red"}})})},
                                {node("camera", {{"target", {0, 0, 0}}, {"position", {0, 0, 9}}})});
    scene[Json::json_pointer(pointer)] = std::move(change);
    return errorOf(scene);
  };
  const std::string structure = "/root/children/0/children/0/children/0";
  const std::string component = structure + "/children/0";
  expectParts(with(7, "/root/children/0/params/url"),
              {"fig.mvsj: root.children[0].params.url: is a number, not a text"});
  expectParts(with("cube", "/root/children/0/kind"), {"root.children[0].kind", "cube"});
  expectParts(with(3, "/root/children"), {"root.children: is a number, not a list"});
  expectParts(with("x", "/root/children/0/params"), {"root.children[0].params: is a text, not an object"});
  expectParts(with("word", "/root/children/0/children/0/params/format"), {"params.format", "word"});
  expectParts(with("model2", (structure + "/params/type").c_str()), {"params.type", "model2", "assembly"});
  expectParts(with(99, (structure + "/params/model_index").c_str()), {"no model at index 99"});
  expectParts(with("everything", (component + "/params/selector").c_str()),
              {"params.selector", "everything", "polymer"});
  expectParts(with({{"chain", "A"}}, (component + "/params/selector").c_str()), {"params.selector.chain"});
  expectParts(with({{"label_seq_id", "1"}}, (component + "/params/selector").c_str()),
              {"params.selector.label_seq_id: is a text, not a number"});
  expectParts(with({{"label_seq_id", 1.5}}, (component + "/params/selector").c_str()), {"whole number"});
  expectParts(with("blob", (component + "/children/0/params/type").c_str()), {"params.type", "blob"});
  expectParts(with("reddish", (component + "/children/0/children/0/params/color").c_str()),
              {"params.color", "reddish"});
  expectParts(with({0, 0}, "/root/children/1/params/target"), {"params.target: has 2 numbers instead of 3"});
  expectParts(with({0, 0, 0}, "/root/children/1/params/position"), {"root.children[1]", "differ"});
  expectParts(with("structure", (component + "/kind").c_str()), {"cannot stand under"});
  expectParts(with("/nowhere/x.pdb", "/root/children/0/params/url"),
              {"root.children[0].params.url", "/nowhere/x.pdb", "no such file"});
  expectParts(with("gopher://x/y", "/root/children/0/params/url"), {"gopher", "is not supported"});
  expectParts(with("https://example.org/x.cif", "/root/children/0/params/url"),
              {"not in the cache", "--offline"});
  expectParts(with("file://other/x.pdb", "/root/children/0/params/url"), {"another machine"});
}

// Before the memory is taken: the system would end the process without a word.
TEST_F(SceneErrors, copiesThatDoNotFitIntoMemoryAreRefused) {
  Json surface = shown("all");  // whose copies share nothing
  surface["children"][0]["params"]["type"] = "surface";
  for (const Json& component :
       {surface, node("component", {{"selector", "all"}}, {surface["children"][0], node("focus")})}) {
    Json scene = structureScene("2hhb.pdb.gz", {component});
    Json& structure = scene["root"]["children"][0]["children"][0]["children"][0];
    structure = withCustom(structure, {{"replicate", "100x100x100"}});
    expectParts(errorOf(scene), {"'fig.mvsj'", "GB of memory, more than there is"});
  }
}

TEST_F(SceneErrors, moreAtomsThanCanBeToldApartAreRefused) {
  EXPECT_NO_THROW(requireIds("a.pdb", 4294967294.0, 4294967294.0));
  try {
    requireIds("a.pdb", 5000, 5e9);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    expectParts(error.what(), {"'a.pdb': 1000000 copies of 5000 atoms", "4,294,967,294", "--select"});
  }
}

TEST_F(SceneErrors, referencesMustLeadSomewhereElse) {
  Json scene = structureScene("1ubq.pdb", {shown("all")});
  Json& structure = scene["root"]["children"][0]["children"][0]["children"][0];
  structure["ref"] = "s";
  structure["params"]["coordinates_ref"] = "s";  // itself
  expectParts(errorOf(scene), {"coordinates_ref", "'s' is of kind 'structure'"});
  structure["params"]["coordinates_ref"] = "gone";
  expectParts(errorOf(scene), {"coordinates_ref", "no node has the ref 'gone'"});
  structure["params"].erase("coordinates_ref");
  scene["root"]["children"][0]["ref"] = "s";
  expectParts(errorOf(scene), {"ref: 's' is the ref of another node"});
}

TEST_F(SceneErrors, settingsAreNamedByTheirKeys) {
  const auto rootWith = [&](Json meniscus) {
    Json scene = structureScene("1ubq.pdb", {shown("all")});
    scene["root"] = withCustom(scene["root"], std::move(meniscus));
    return errorOf(scene);
  };
  const std::string place = "fig.mvsj: root.custom.meniscus";
  expectParts(rootWith({{"shadow", "soft"}}), {place + ".shadow: there is no such setting"});
  expectParts(rootWith({{"shadows", "fuzzy"}}),
              {place + ".shadows: 'fuzzy' is not allowed; give off, hard or soft"});
  expectParts(rootWith({{"shadows", 1}}), {place + ".shadows: is a number, not a text"});
  expectParts(rootWith({{"samples", 1000}}), {place + ".samples", "1 to 256"});
  expectParts(rootWith({{"occlusion", "yes"}}), {place + ".occlusion: is a text, not true or false"});
  expectParts(rootWith({{"outlines", "silhouettes"}}), {place + ".outlines: is a text, not a list"});
  expectParts(rootWith({{"representation", "licorice"}}), {place + ".representation"});
  expectParts(rootWith(Json(3)), {place, "not an object"});
}

TEST_F(SceneErrors, archivesHoldTheirFilesAndNothingElse) {
  Json scene = structureScene("1ubq.pdb", {shown("all")});
  const std::string structure = readFile(moleculePath("1ubq.pdb"));
  const auto withUrl = [&](const std::string& url) {
    scene["root"]["children"][0]["params"]["url"] = url;
    return scene.dump();
  };
  writeArchive("good.mvsx", {{"index.mvsj", withUrl("data/./1ubq.pdb")}, {"data/1ubq.pdb", structure}});
  EXPECT_EQ(errorOfArchive("good.mvsx"), "no error");
  writeArchive("gone.mvsx", {{"index.mvsj", withUrl("2ubq.pdb")}, {"1ubq.pdb", structure}});
  expectParts(errorOfArchive("gone.mvsx"), {"root.children[0].params.url", "holds no '2ubq.pdb'"});
  writeArchive("climbs.mvsx", {{"index.mvsj", withUrl("../../etc/passwd")}});
  expectParts(errorOfArchive("climbs.mvsx"), {"params.url", "outside of the archive"});
  writeArchive("entry.mvsx", {{"index.mvsj", withUrl("x")}, {"../../x", "y"}});
  expectParts(errorOfArchive("entry.mvsx"), {"entry '../../x'", "outside"});
  writeArchive("empty.mvsx", {{"other.json", "{}"}});
  expectParts(errorOfArchive("empty.mvsx"), {"empty.mvsx", "holds no 'index.mvsj'"});
  writeArchive("bomb.mvsx", {{"index.mvsj", withUrl("bomb.pdb")}, {"bomb.pdb", std::string(80u << 20, ' ')}});
  expectParts(errorOfArchive("bomb.mvsx"), {"params.url", "bomb.pdb", "200 times"});
  std::string bytes = readFile(folder_ / "good.mvsx");
  writeFile(folder_ / "cut.mvsx", bytes.substr(0, bytes.size() / 2));
  expectParts(errorOfArchive("cut.mvsx"), {"cut.mvsx", "no sound zip archive"});
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i)
    bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
  writeFile(folder_ / "bad.mvsx", bytes);
  expectParts(errorOfArchive("bad.mvsx"), {"damaged"});
}

// The schema says what the program takes: the same keys, and the same bounds.
TEST(SceneSchema, isWhatIsValidated) {
  const nlohmann::json schema = nlohmann::json::parse(readFile(projectFile("docs/meniscus.schema.json")));
  const std::pair<SettingPlace, const char*> places[] = {{SettingPlace::picture, "root"},
                                                         {SettingPlace::structure, "structure"},
                                                         {SettingPlace::look, "representation"}};
  const auto accepts = [](SettingPlace place, const std::string& key, const nlohmann::json& value) {
    const nlohmann::json json{{key, value}};
    const JsonPlace meniscus(json, "x");
    try {
      namingKeys(meniscus, [&] { return parseSettings(asArguments(settingsOf(meniscus, place))); });
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  std::size_t bounds = 0, words = 0;
  for (const auto& [place, name] : places) {
    const nlohmann::json& properties = schema["$defs"][name]["properties"];
    std::size_t known = 0;
    for (const Setting& setting : settings()) known += setting.place == place ? 1 : 0;
    EXPECT_EQ(properties.size(), known + (properties.contains("made_from") ? 1 : 0));
    for (const auto& [key, property] : properties.items()) {
      if (key == "made_from") continue;
      for (const char* end : {"minimum", "maximum"}) {
        if (!property.contains(end)) continue;
        const double value = property[end], beyond = end == std::string("minimum") ? -1 : 1;
        const bool whole = property["type"] == "integer";
        EXPECT_TRUE(accepts(place, key, property[end])) << key << " " << value;
        EXPECT_FALSE(accepts(place, key, value + beyond * (whole ? 1 : 1e-7))) << key << " beyond " << value;
        ++bounds;
      }
      if (property.contains("enum")) {
        for (const nlohmann::json& word : property["enum"])
          EXPECT_TRUE(accepts(place, key, word)) << key << word;
        EXPECT_FALSE(accepts(place, key,
                             property["enum"][0].is_string() ? nlohmann::json("nothing") : nlohmann::json(3)))
            << key;
        ++words;
      }
      const nlohmann::json wrong =
          property["type"] == "string" ? nlohmann::json(1.5) : nlohmann::json("text");
      EXPECT_FALSE(accepts(place, key, wrong)) << key;
    }
  }
  EXPECT_GT(bounds, 50u);
  EXPECT_GT(words, 5u);
}

}  // namespace
}  // namespace meniscus::test
