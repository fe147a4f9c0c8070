// `meniscus info`, `meniscus doctor` and the program's own options.

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

std::vector<std::string> keysOf(const nlohmann::ordered_json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

class Info : public CliTest {
 protected:
  nlohmann::ordered_json infoOf(const std::string& name) const {
    const ProcessResult result = run({"info", molecule(name), "--json"});
    expectSuccess(result);
    return nlohmann::ordered_json::parse(result.out, nullptr, false);
  }
};

TEST_F(Info, jsonHasExactlyItsKeys) {
  const nlohmann::ordered_json json = infoOf("1ubq.pdb");
  EXPECT_EQ(keysOf(json),
            (std::vector<std::string>{"file", "atoms", "residues", "chains", "models", "assemblies", "bonds",
                                      "ligands", "box", "notes", "seconds"}));
  EXPECT_EQ(json["file"], molecule("1ubq.pdb"));
  EXPECT_EQ(json["atoms"], 660);
  EXPECT_EQ(json["residues"], 134);
  EXPECT_EQ(json["chains"], 1);
  EXPECT_EQ(json["models"], 1);
  EXPECT_EQ(keysOf(json["bonds"]),
            (std::vector<std::string>{"connection", "conect", "template", "distance"}));
  EXPECT_GT(json["bonds"]["template"], 600);
  EXPECT_EQ(keysOf(json["box"]), (std::vector<std::string>{"a", "b", "c", "alpha", "beta", "gamma"}));
  EXPECT_TRUE(json["notes"].is_array());
  EXPECT_GT(json["seconds"], 0);
}

TEST_F(Info, countsModelsAndTheAtomsOfTheFirst) {
  const nlohmann::ordered_json json = infoOf("1d3z.pdb.gz");
  EXPECT_EQ(json["models"], 10);
  EXPECT_EQ(json["atoms"], 1231);
}

TEST_F(Info, listsAssembliesAndLigands) {
  const nlohmann::ordered_json json = infoOf("1cbs.cif.gz");
  EXPECT_EQ(json["assemblies"], nlohmann::ordered_json::array({"1"}));
  EXPECT_EQ(json["ligands"]["REA"], 1);
}

TEST_F(Info, textSaysTheSame) {
  const ProcessResult result = run({"info", molecule("1cbs.cif.gz")});
  expectSuccess(result);
  for (const char* part : {"1cbs.cif.gz", "atoms", "residues", "chains", "models", "assemblies", "bonds",
                           "from residue templates", "1 REA", "box", "notes", "time"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " is not in:\n" << result.out;
}

class Doctor : public CliTest {};

TEST_F(Doctor, jsonDescribesEveryWayToOpenGl) {
  const ProcessResult result = run({"doctor", "--json"});
  expectSuccess(result);
  const nlohmann::json json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << result.out;
  EXPECT_TRUE(json["chosen"].is_string());
  std::vector<std::string> names;
  for (const auto& backend : json["backends"]) {
    names.push_back(backend["name"]);
    const std::vector<const char*> keys = backend["works"].get<bool>()
                                              ? std::vector{"vendor", "renderer", "gl", "glsl", "limits"}
                                              : std::vector{"reason", "remedy"};
    for (const char* key : keys) EXPECT_FALSE(backend[key].empty()) << names.back() << ' ' << key;
  }
  for (const char* name : {"EGL surfaceless", "OSMesa", "window"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST_F(Doctor, textNamesTheOneThatIsUsed) {
  const ProcessResult result = run({"doctor"});
  expectSuccess(result);
  EXPECT_NE(result.out.find("meniscus render uses: "), std::string::npos) << result.out;
}

TEST_F(Doctor, exitsWith3AndRemediesIfNothingWorks) {
  const ProcessResult text = run({"doctor"}, kNoGraphics);
  EXPECT_EQ(text.exitCode, 3);
  EXPECT_TRUE(text.err.starts_with("meniscus: no way to OpenGL 4.5")) << text.err;
  EXPECT_NE(text.out.find("remedy"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("/nonexistent/libEGL.so"), std::string::npos) << text.out;

  const ProcessResult json = run({"doctor", "--json"}, kNoGraphics);
  EXPECT_EQ(json.exitCode, 3);
  const nlohmann::json parsed = nlohmann::json::parse(json.out, nullptr, false);
  ASSERT_TRUE(parsed.is_object()) << json.out;
  EXPECT_TRUE(parsed["chosen"].is_null());
  for (const auto& backend : parsed["backends"]) {
    EXPECT_FALSE(backend["works"].get<bool>());
    EXPECT_FALSE(backend["reason"].get<std::string>().empty());
    EXPECT_FALSE(backend["remedy"].get<std::string>().empty());
  }
}

class Program : public CliTest {};

TEST_F(Program, knowsItsVersion) {
  for (const char* option : {"--version", "-V"}) {
    const ProcessResult result = run({option});
    expectSuccess(result);
    EXPECT_EQ(result.out, "meniscus " MENISCUS_VERSION "\n");
  }
}

TEST_F(Program, helpsWithItselfAndEveryCommand) {
  for (const char* option : {"--help", "-h", "help"}) {
    const ProcessResult result = run({option});
    expectSuccess(result);
    for (const char* part : {"render", "info", "measure", "doctor", "Examples:", "Exit codes"})
      EXPECT_NE(result.out.find(part), std::string::npos) << part;
  }
  for (const char* command : {"render", "info", "measure", "doctor"}) {
    const ProcessResult result = run({command, "--help"});
    expectSuccess(result);
    EXPECT_NE(result.out.find("Usage: meniscus " + std::string(command)), std::string::npos);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos);
    EXPECT_EQ(run({"help", command}).out, result.out);
  }
}

}  // namespace
}  // namespace meniscus::test
