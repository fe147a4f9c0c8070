// `meniscus render --scene`, batches and films: the program as scripts use it.

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/cli/cli_test.h"
#include "tests/support/paths.h"

namespace meniscus::test {
namespace {

using Words = std::vector<std::string>;

class Scenes : public CliTest {
 protected:
  ProcessResult render(Words arguments) const {
    arguments.insert(arguments.begin(), {"render", "-q"});
    return run(arguments);
  }
  std::vector<nlohmann::json> manifest(const std::string& name) const {
    std::istringstream lines(readFile(folder_ / name));
    std::vector<nlohmann::json> entries;
    for (std::string line; std::getline(lines, line);) entries.push_back(nlohmann::json::parse(line));
    return entries;
  }
  /// Stands in for ffmpeg, whether it is there or not: a film is its frames as raw pixels.
  Environment rawFilms() const {
    std::filesystem::create_directory(folder_ / "bin");
    writeFile(folder_ / "bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\nexec cat > \"${last#file:}\"\n");
    std::filesystem::permissions(folder_ / "bin/ffmpeg", std::filesystem::perms::owner_all);
    return {{"PATH", (folder_ / "bin").string() + ":/usr/bin:/bin"}};
  }
};

const Words kSmall{"--size", "64x48", "--samples", "1"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(Scenes, aSavedSceneGivesTheSameBytes) {
  const std::vector<Words> commands{
      {molecule("1cbs.cif.gz"), "--representation", "cartoon", "--color", "rainbow", "--show",
       "(REA)=ball_and_stick:element", "--label", "(REA)=retinoic acid", "--style", "full", "--size",
       "120x90"},
      {molecule("1a8o.cif.gz"), "--assembly", "1", "--representation", "surface", "--blend", "1.5", "--color",
       "chain", "--background", "transparent", "--orthographic", "--rotate", "10,20,30", "--size", "80x60"},
      {molecule("1d3z.pdb.gz"), "--model", "all", "--select", "1-20", "--hydrogens", "off", "--replicate",
       "2x1x1", "--representation", "licorice", "--stick-radius", "0.1", "--zoom", "1.3", "--fov", "50",
       "--size", "80x60"},
      {molecule("133d.pdb"), "--representation", "putty", "--orient", "x", "--outlines",
       "silhouettes,residues", "--unsharp-radius", "3%", "--depth-unsharp", "both", "--focus", "//A",
       "--size", "80x60"},
  };
  for (const Words& command : commands) {
    expectSuccess(render(with(command, {"--samples", "4", "-o", "a.png", "--save-scene", "a.mvsj"})));
    expectSuccess(render({"--scene", "a.mvsj", "-o", "b.png"}));
    EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png")) << command[2];
  }
}

TEST_F(Scenes, aSavedSceneKnowsTheSpacingOfItsMesh) {
  const Words mesh = with({molecule("c60.pdb"), "--representation", "surface", "--surface-method", "mesh",
                           "--mesh-spacing", "+1.5"},
                          kSmall);
  expectSuccess(render(with(mesh, {"-o", "a.png", "--save-scene", "a.mvsj"})));
  expectSuccess(render({"--scene", "a.mvsj", "-o", "b.png"}));
  EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png"));
  expectSuccess(render(with(mesh, {"--mesh-spacing", "0.5", "-o", "fine.png"})));
  EXPECT_NE(readPicture(folder_ / "a.png").pixels, readPicture(folder_ / "fine.png").pixels);
}

TEST_F(Scenes, severalPicturesAreSavedAsStates) {
  expectSuccess(render(with(
      {molecule("1d3z.pdb.gz"), "--model", "all", "-o", "{model}.png", "--save-scene", "a.mvsj"}, kSmall)));
  expectSuccess(render({"--scene", "a.mvsj", "-o", "again-{state}.png"}));
  for (const char* model : {"1", "2", "10"})
    EXPECT_EQ(readFile(folder_ / (std::string(model) + ".png")),
              readFile(folder_ / ("again-" + std::string(model) + ".png")));
}

TEST_F(Scenes, aFilmIsSavedAsStates) {
  const Environment path = rawFilms();
  expectSuccess(run(with({"render", "-q", molecule("c60.pdb"), "--turntable", "3", "-o", "film.gif",
                          "--save-scene", "a.mvsj"},
                         kSmall),
                    path));
  expectSuccess(render({"--scene", "a.mvsj", "-o", "{state}.png"}));
  expectSuccess(render(with({molecule("c60.pdb"), "--turntable", "3", "-o", "f{frame}.png"}, kSmall)));
  const Names states{"film.png", "film-2.png", "film-3.png"};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(readPicture(folder_ / states[i]).pixels,
              readPicture(folder_ / ("f0000" + std::to_string(i + 1) + ".png")).pixels);

  expectSuccess(run({"render", "-q", "--scene", "a.mvsj", "-o", "again.gif", "--stats", "s.json"}, path));
  const nlohmann::json stats = nlohmann::json::parse(readFile(folder_ / "s.json"));
  EXPECT_EQ(stats["width"], 64);  // as the scene says
  EXPECT_EQ(stats["samples"], 1);
  ASSERT_EQ(stats["pictures"].size(), 3u);
  EXPECT_EQ(stats["pictures"][2]["output"], "again.gif");
  EXPECT_EQ(stats["pictures"][2]["height"], 48);
  EXPECT_EQ(stats["pictures"][2]["spheres"], 60);
  EXPECT_EQ(readFile(folder_ / "again.gif").size(), 3u * 64 * 48 * 4);
  EXPECT_EQ(readFile(folder_ / "again.gif"), readFile(folder_ / "film.gif"));
  expectError(render({"--scene", "a.mvsj", "-o", "again.png"}), ExitCode::badInput, {"3 states", "{state}"});
  nlohmann::json scene = nlohmann::json::parse(readFile(folder_ / "a.mvsj"));
  scene["snapshots"][1]["root"]["custom"]["meniscus"]["size"] = "32x48";
  writeFile(folder_ / "b.mvsj", scene.dump());
  expectError(run({"render", "-q", "--scene", "b.mvsj", "-o", "b.gif"}, path), ExitCode::badInput,
              {"'b.mvsj'", "64x48", "32x48", "--size"});
}

// With --resume, pictures that are done are not made again, so they cannot be written.
TEST_F(Scenes, aResumedRunSavesNoScene) {
  writeFile(folder_ / "a.mvsj", "an older one");
  expectError(render(with({molecule("c60.pdb"), "-o", "a.png", "--save-scene", "a.mvsj", "--manifest",
                           "m.jsonl", "--resume"},
                          kSmall)),
              ExitCode::badUsage, {"--save-scene", "leave out --resume"});
  EXPECT_EQ(readFile(folder_ / "a.mvsj"), "an older one");
}

/// A BinaryCIF file of two atoms.
std::string binaryCif() {
  using Json = nlohmann::json;
  const auto bytes = [](const auto& values, int type) {
    std::vector<std::uint8_t> out(values.size() * sizeof values[0]);
    std::memcpy(out.data(), values.data(), out.size());
    const Json encoding{{"kind", "ByteArray"}, {"type", type}};
    return std::pair{Json::binary(out), encoding};
  };
  Json columns = Json::array();
  const auto add = [&](const char* name, const Json& data, const Json& encoding) {
    columns.push_back(
        {{"name", name}, {"data", {{"data", data}, {"encoding", {encoding}}}}, {"mask", nullptr}});
  };
  const auto addNumbers = [&](const char* name, const std::vector<float>& values) {
    const auto [data, encoding] = bytes(values, 32);
    add(name, data, encoding);
  };
  const auto addText = [&](const char* name, const std::string& text) {  // the same for both
    const auto [indices, each] = bytes(std::vector<std::int8_t>{0, 0}, 1);
    const auto [offsets, place] =
        bytes(std::vector<std::int32_t>{0, static_cast<std::int32_t>(text.size())}, 3);
    add(name, indices,
        {{"kind", "StringArray"},
         {"dataEncoding", {each}},
         {"stringData", text},
         {"offsetEncoding", {place}},
         {"offsets", offsets}});
  };
  addNumbers("Cartn_x", {-1, 2});
  addNumbers("Cartn_y", {0, 1});
  addNumbers("Cartn_z", {0, 0});
  addText("type_symbol", "C");
  addText("label_atom_id", "C1");
  addText("label_comp_id", "LIG");
  addText("auth_asym_id", "A");
  addText("auth_seq_id", "1");
  const Json atoms{{"name", "_atom_site"}, {"rowCount", 2}, {"columns", columns}};
  const Json block{{"header", "TEST"}, {"categories", {atoms}}};
  const std::vector<std::uint8_t> packed =
      Json::to_msgpack({{"version", "0.3.0"}, {"encoder", "test"}, {"dataBlocks", {block}}});
  return {packed.begin(), packed.end()};
}

TEST_F(Scenes, aSavedSceneNamesTheFormatOfItsFile) {
  writeFile(folder_ / "a.bcif", binaryCif());
  const std::pair<std::string, const char*> files[] = {
      {"a.bcif", "bcif"}, {molecule("1a8o.cif.gz"), "mmcif"}, {molecule("c60.pdb"), "pdb"}};
  for (const auto& [file, format] : files) {
    expectSuccess(render(with({file, "-o", "a.png", "--save-scene", "a.mvsj"}, kSmall)));
    const nlohmann::json scene = nlohmann::json::parse(readFile(folder_ / "a.mvsj"));
    EXPECT_EQ(scene["root"]["children"][0]["children"][0]["params"]["format"], format);
    expectSuccess(render({"--scene", "a.mvsj", "-o", "b.png"}));
    EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png")) << file;
  }
}

TEST_F(Scenes, strictMakesWhatIsNotSupportedAnError) {
  writeFile(folder_ / "a.mvsj", R"({"metadata":{"version":"1"},"root":{"kind":"root","children":[
    {"kind":"transition"},{"kind":"download","params":{"url":")" +
                                    molecule("1ubq.pdb") + R"("},"children":[
    {"kind":"parse","params":{"format":"pdb"},"children":[{"kind":"structure","params":{"type":"model"},"children":[
    {"kind":"component","params":{"selector":"all"},"children":[
    {"kind":"representation","params":{"type":"spacefill"}}]}]}]}]}]}})");
  const ProcessResult lax = run(with({"render", "--scene", "a.mvsj", "-o", "a.png"}, kSmall));
  EXPECT_EQ(lax.exitCode, 0);
  EXPECT_NE(lax.err.find("a.mvsj: root.children[0]: has no meaning"), std::string::npos) << lax.err;
  expectError(render(with({"--scene", "a.mvsj", "-o", "b.png", "--strict"}, kSmall)), ExitCode::badInput,
              {"a.mvsj: root.children[0]", "--strict"});
  expectError(render(with({"--scene", "a.mvsj", "-o", "b.png", "--color", "chain"}, kSmall)),
              ExitCode::badUsage, {"--color", "the scene says it"});
  EXPECT_EQ(folder_.names(), (Names{"a.mvsj", "a.png"}));
}

TEST_F(Scenes, aManifestTellsOfEveryPictureAndABadFileStopsNothing) {
  writeFile(folder_ / "bad.pdb", "nothing\n");
  const ProcessResult result = render(with({molecule("c60.pdb"), "bad.pdb", molecule("adrenaline.pdb"), "-o",
                                            "{stem}.png", "--manifest", "m.jsonl", "--jobs", "3"},
                                           kSmall));
  expectError(result, ExitCode::badInput, {"bad.pdb"});
  const std::vector<nlohmann::json> entries = manifest("m.jsonl");
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0]["output"], "c60.png");
  EXPECT_TRUE(entries[0]["error"].is_null());
  EXPECT_GT(entries[0]["milliseconds"], 0);
  EXPECT_EQ(entries[1]["input"], "bad.pdb");
  EXPECT_TRUE(entries[1]["output"].is_null());
  EXPECT_NE(entries[1]["error"].get<std::string>().find("bad.pdb"), std::string::npos);
  EXPECT_EQ(entries[2]["output"], "adrenaline.png");
}

TEST_F(Scenes, aRunIsResumedByContent) {
  std::filesystem::copy_file(molecule("c60.pdb"), folder_ / "a.pdb");
  std::filesystem::copy_file(molecule("adrenaline.pdb"), folder_ / "b.pdb");
  const Words command =
      with({"a.pdb", "b.pdb", "-o", "{stem}.png", "--manifest", "m.jsonl", "--resume"}, kSmall);
  expectSuccess(render(command));
  const std::string first = readFile(folder_ / "a.png");
  expectSuccess(render(command));
  EXPECT_EQ(manifest("m.jsonl").size(), 2u);  // nothing was done again
  std::filesystem::remove(folder_ / "a.png");
  std::ofstream(folder_ / "m.jsonl", std::ios::app) << "{\"input\": \"torn";  // as a killed run leaves it
  expectSuccess(render(command));
  EXPECT_EQ(readFile(folder_ / "a.png"), first);
  std::filesystem::copy_file(molecule("1ubq.pdb"), folder_ / "b.pdb",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string before = readFile(folder_ / "b.png");
  expectSuccess(render(command));
  EXPECT_NE(readFile(folder_ / "b.png"), before);
  expectSuccess(render(with(command, {"--color", "chain"})));
  EXPECT_NE(readFile(folder_ / "a.png"), first);
  expectError(render(with({"a.pdb", "-o", "x.png", "--resume"}, kSmall)), ExitCode::badUsage, {"--manifest"});
}

TEST_F(Scenes, anInterruptFinishesThePictureAndTheRestIsResumed) {
  Words command{"render", "-q",         "--size",     "500x400", "--samples", "64",
                "-o",     "{stem}.png", "--manifest", "m.jsonl", "--resume"};
  for (int i = 0; i < 8; ++i) {
    const std::string name = "m" + std::to_string(i) + ".pdb";
    std::filesystem::copy_file(molecule("1ubq.pdb"), folder_ / name);
    command.push_back(name);
  }
  ProcessOptions options;
  options.folder = folder_.path();
  options.signal = SIGINT;
  options.signalAfter = std::chrono::milliseconds(700);
  Words argv = command;
  argv.insert(argv.begin(), program());
  const ProcessResult result = runProcess(argv, options);
  const std::size_t done = std::filesystem::exists(folder_ / "m.jsonl") ? manifest("m.jsonl").size() : 0;
  if (result.exitCode != 0) {  // a fast machine may have been done before
    EXPECT_EQ(result.exitCode, -SIGINT);
    EXPECT_LT(done, 8u);
  }
  for (const std::string& name : folder_.names()) EXPECT_EQ(name.find("tmp"), std::string::npos) << name;
  expectSuccess(run(command));
  EXPECT_EQ(manifest("m.jsonl").size(), 8u);
  for (int i = 1; i < 8; ++i)
    EXPECT_EQ(readPicture(folder_ / ("m" + std::to_string(i) + ".png")).pixels,
              readPicture(folder_ / "m0.png").pixels);
}

TEST_F(Scenes, whatAKilledRunLeftIsTidiedUpAndTheRestIsResumed) {
  const Words command = with(
      {molecule("c60.pdb"), molecule("133d.pdb"), "-o", "{stem}.png", "--manifest", "m.jsonl", "--resume"},
      kSmall);
  // No process has such a number; the second file's has.
  const std::string left = ".meniscus-4194305-0.tmp", writing = fmt::format(".meniscus-{}-7.tmp", getpid());
  writeFile(folder_ / left, "half");
  writeFile(folder_ / writing, "half");
  writeFile(folder_ / "c60.png", "of before");
  writeFile(folder_ / "m.jsonl", "{\"input\":\"c60");
  expectSuccess(render(command));
  EXPECT_EQ(folder_.names(), (Names{writing, "133d.png", "c60.png", "m.jsonl"}));
  EXPECT_EQ(readPicture(folder_ / "c60.png").pixels.size(), readPicture(folder_ / "133d.png").pixels.size());
}

// Too many atoms behind a pixel are the file's doing, not the driver's.
TEST_F(Scenes, aSurfaceThatIsTooDeepStopsNothing) {
  std::string atoms;
  for (int i = 0; i < 2000; ++i)
    atoms += fmt::format("HETATM{:5}  C   LIG A{:4}    {:8.3f}{:8.3f}{:8.3f}  1.00 20.00           C\n",
                         i + 1, i + 1, 0.001 * i, 0.0, 0.0);
  writeFile(folder_ / "deep.pdb", atoms + "END\n");
  const Words lists = with({"-o", "{stem}.png", "--representation", "surface", "--surface-method", "lists",
                            "--surface-option", "memory=0.01"},
                           kSmall);
  expectSuccess(render(with({molecule("c60.pdb")}, lists)));
  const std::string alone = readFile(folder_ / "c60.png");
  std::filesystem::remove(folder_ / "c60.png");
  expectError(render(with({"deep.pdb", molecule("c60.pdb")}, lists)), ExitCode::badInput,
              {"balls lie behind one pixel"});
  EXPECT_EQ(readFile(folder_ / "c60.png"), alone);
}

TEST_F(Scenes, aTimeLimitGivesUpAPicture) {
  const ProcessResult result = render({molecule("2hhb.pdb.gz"), molecule("c60.pdb"), "-o", "{stem}.png",
                                       "--size", "1000x1000", "--samples", "256", "--time-limit", "0.2"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.err.find("'2hhb.png': takes longer than the time limit of 0.2 s"), std::string::npos)
      << result.err;
  EXPECT_EQ(folder_.names(), Names{});
}

TEST_F(Scenes, aTurntableTurnsAboutTheVerticalAxis) {
  expectSuccess(render(with({molecule("c60.pdb"), "-o", "f{frame}.png", "--turntable", "4"}, kSmall)));
  EXPECT_EQ(folder_.names(), (Names{"f00001.png", "f00002.png", "f00003.png", "f00004.png"}));
  expectSuccess(render(with({molecule("c60.pdb"), "-o", "plain.png"}, kSmall)));
  EXPECT_EQ(readPicture(folder_ / "plain.png").pixels, readPicture(folder_ / "f00001.png").pixels);
  EXPECT_NE(readPicture(folder_ / "plain.png").pixels, readPicture(folder_ / "f00002.png").pixels);
  expectError(render(with({molecule("c60.pdb"), "-o", "x.png", "--turntable", "4"}, kSmall)),
              ExitCode::badUsage, {"--turntable", "{frame}"});
}

TEST_F(Scenes, aTurntableOfOnePictureNumbersIt) {
  expectSuccess(render(with({molecule("c60.pdb"), "-o", "f{frame}.png", "--turntable", "1"}, kSmall)));
  EXPECT_EQ(folder_.names(), (Names{"f00001.png"}));
}

TEST_F(Scenes, filmsAndTurntablesAreExported) {
  const Environment path = rawFilms();
  const Words surface = with({"render", "-q", molecule("c60.pdb"), "--representation", "surface",
                              "--mesh-spacing", "1", "--turntable", "2"},
                             kSmall);
  expectSuccess(run(with(surface, {"-o", "a.mp4", "--export", "a.ply"}), path));
  expectSuccess(run(with(surface, {"-o", "b{frame}.png", "--export", "b.ply"})));
  EXPECT_EQ(folder_.names(), (Names{"a.mp4", "a.ply", "b.ply", "b00001.png", "b00002.png", "bin"}));
  EXPECT_EQ(readFile(folder_ / "a.ply"), readFile(folder_ / "b.ply"));
  expectError(run(with(surface, {"-o", "c{frame}.png", "--export", "c{frame}.ply"})), ExitCode::badUsage,
              {"--export", "{frame}"});
  expectError(run(with(surface, {"--export", "c.ply"})), ExitCode::badUsage, {"--turntable", "-o"});
  expectError(run({"render", molecule("1d3z.pdb.gz"), "--model", "all", "--representation", "surface", "-o",
                   "c.mp4", "--export", "c.ply"},
                  path),
              ExitCode::badUsage, {"--export", "'c.ply'", "{model}"});
  expectError(run({"render", "--scene", "c.mvsj", "--export", "c.ply"}), ExitCode::badUsage,
              {"--export", "only pictures"});
}

// What decides what the files hold, or which there are, decides whether they are done.
TEST_F(Scenes, fpsAndExportAreNotDoneByARunWithoutThem) {
  const Environment path = rawFilms();
  const auto lines = [&](const Words& more) {
    expectSuccess(run(with(with({"render", "-q", molecule("c60.pdb"), "--representation", "surface",
                                 "--turntable", "1", "-o", "a.mp4", "--manifest", "m.jsonl", "--resume"},
                                kSmall),
                           more),
                      path));
    return manifest("m.jsonl").size();
  };
  EXPECT_EQ(lines({}), 1u);
  EXPECT_EQ(lines({}), 1u);
  EXPECT_EQ(lines({"--fps", "10"}), 2u);
  EXPECT_EQ(lines({"--export", "a.ply"}), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.ply"));
}

TEST_F(Scenes, aMeshByItselfIsResumed) {
  const Words command{molecule("c60.pdb"), "--representation", "surface",    "--mesh-spacing", "1",
                      "--export",          "{stem}.ply",       "--manifest", "m.jsonl",        "--resume"};
  expectSuccess(render(command));
  expectSuccess(render(command));
  ASSERT_EQ(manifest("m.jsonl").size(), 1u);
  EXPECT_EQ(manifest("m.jsonl")[0]["output"], "c60.ply");
  std::filesystem::remove(folder_ / "c60.ply");
  expectSuccess(render(command));
  EXPECT_EQ(manifest("m.jsonl").size(), 2u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "c60.ply"));
}

TEST_F(Scenes, aFilmIsEveryFrameInFfmpegsHands) {
  const Environment path = rawFilms();
  const Words film =
      with({"render", "-q", molecule("1d3z.pdb.gz"), "--model", "all", "-o", "film.mp4"}, kSmall);
  expectSuccess(run(film, path));
  EXPECT_EQ(readFile(folder_ / "film.mp4").size(), 10u * 64 * 48 * 4);
  writeFile(folder_ / "bin/ffmpeg", "#!/bin/sh\necho no >&2\nexit 1\n");
  const ProcessResult result = run(film, path);
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.err.find("film.mp4"), std::string::npos) << result.err;
  expectError(run(film, {{"PATH", "/nonexistent"}}), ExitCode::badUsage, {"ffmpeg", "not installed"});
  EXPECT_EQ(readFile(folder_ / "film.mp4").size(), 10u * 64 * 48 * 4);  // the old one stays
}

// docs/scene.md: its files are written and its commands are run, with small pictures.
TEST_F(Scenes, theExamplesOfTheDocumentationWork) {
  for (const char* name : {"1ubq.pdb", "1cbs.cif.gz", "133d.pdb"})
    std::filesystem::copy_file(molecule(name), folder_ / name);
  std::istringstream document(readFile(projectFile("docs/scene.md")));
  std::string block, name, line, kind;
  std::size_t files = 0, commands = 0;
  while (std::getline(document, line)) {
    if (kind.empty() && line.ends_with(".mvsj`:")) name = line.substr(1, line.size() - 3);
    if (!line.starts_with("```")) {
      block += line + "\n";
      continue;
    }
    if (kind == "json") {
      ASSERT_FALSE(name.empty());
      writeFile(folder_ / name, block);
      ++files;
    } else if (kind == "sh") {
      std::istringstream lines(block);
      for (std::string command; std::getline(lines, command); ++commands) {
        if (command.starts_with("meniscus render ")) {
          // A scene that was saved knows its size; options beside it would be recorded in the picture.
          const bool again = command.find("again") != std::string::npos;
          command = program() + command.substr(8) + (again ? " -q" : " -q --size 60x45 --samples 1");
        } else {
          ASSERT_TRUE(command.starts_with("cmp ")) << command;
        }
        ProcessOptions options;
        options.folder = folder_.path();
        const ProcessResult result = runProcess({"/bin/sh", "-c", command}, options);
        EXPECT_EQ(result.exitCode, 0) << command << "\n" << result.err;
        EXPECT_EQ(result.err, "") << command;
      }
    }
    kind = kind.empty() ? line.substr(3) + " " : "";
    if (!kind.empty() && kind != " ") kind.pop_back();
    block.clear();
  }
  EXPECT_EQ(files, 1u);
  EXPECT_EQ(commands, 11u);
}

}  // namespace
}  // namespace meniscus::test
