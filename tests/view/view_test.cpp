// The window as its user knows it.

#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/paths.h"
#include "tests/view/display_resources.h"
#include "tests/view/file_drop.h"
#include "tests/view/window_fixture.h"

namespace meniscus::test {
namespace {

constexpr int kPanel = 330;   // width of the panels
constexpr int kBeside = 900;  // a place on the screen beside the window

std::string molecule(const std::string& name) {
  return projectFile("molecules/" + name);
}

struct PdbAtom {
  std::string name;  ///< as the viewer calls it
  std::array<double, 3> position;
};

std::string field(const std::string& line, std::size_t from, std::size_t count) {
  std::string text = line.substr(from, count);
  std::erase(text, ' ');
  return text;
}

/// Atoms of a PDB file without waters, in its order.
std::vector<PdbAtom> atomsOf(const std::string& file) {
  std::vector<PdbAtom> atoms;
  std::istringstream lines(readFile(file));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("ATOM  ") || line.size() < 54) continue;
    atoms.push_back(
        {field(line, 17, 3) + " " + field(line, 22, 4) + " " + field(line, 12, 4) + ", chain " +
             field(line, 21, 1),
         {std::stod(field(line, 30, 8)), std::stod(field(line, 38, 8)), std::stod(field(line, 46, 8))}});
  }
  return atoms;
}

/// Atoms' ids, rows from the top.
struct Ids {
  int width = 0, height = 0;
  std::vector<std::uint32_t> of;
};

Ids readIds(const std::filesystem::path& exr) {
  Ids ids;
  const auto input = OIIO::ImageInput::open(exr.string());
  EXPECT_TRUE(input) << OIIO::geterror();
  if (!input) return ids;
  const OIIO::ImageSpec& spec = input->spec();
  ids.width = spec.width;
  ids.height = spec.height;
  std::vector<float> pixels(static_cast<std::size_t>(spec.image_pixels()) *
                            static_cast<std::size_t>(spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels.data()));
  for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(spec.nchannels))
    ids.of.push_back(static_cast<std::uint32_t>(pixels[i]));
  return ids;
}

struct Seen {
  std::size_t atom;
  int x, y;
};

/// Atoms that are seen with all of their surroundings of 7 x 7 pixels, one pixel of each.
std::vector<Seen> wellSeen(const Ids& ids) {
  std::map<std::uint32_t, Seen> found;
  const auto at = [&](int x, int y) { return ids.of[static_cast<std::size_t>(y * ids.width + x)]; };
  for (int y = 3; y + 3 < ids.height; ++y) {
    for (int x = 3; x + 3 < ids.width; ++x) {
      const std::uint32_t id = at(x, y);
      bool alone = id != 0;
      for (int j = -3; j <= 3 && alone; ++j)
        for (int i = -3; i <= 3; ++i) alone = alone && at(x + i, y + j) == id;
      if (alone) found.try_emplace(id, Seen{id - 1, x, y});
    }
  }
  std::vector<Seen> seen;
  for (const auto& [id, place] : found) seen.push_back(place);
  return seen;
}

/// A picture of 8 bits.
WindowPixels readPicture(const std::filesystem::path& png) {
  WindowPixels picture;
  const auto input = OIIO::ImageInput::open(png.string());
  EXPECT_TRUE(input) << OIIO::geterror();
  if (!input) return picture;
  const OIIO::ImageSpec& spec = input->spec();
  picture.width = spec.width;
  picture.height = spec.height;
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  EXPECT_GE(channels, 3u);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(spec.image_pixels()) * channels);
  EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT8, bytes.data()));
  for (std::size_t i = 0; i + 2 < bytes.size(); i += channels)
    picture.rgb.push_back(bytes[i] * 0x10000u + bytes[i + 1] * 0x100u + bytes[i + 2]);
  return picture;
}

nlohmann::json messages(const std::filesystem::path& stats) {
  return nlohmann::json::parse(readFile(stats)).at("messages");
}

bool anyContains(const nlohmann::json& lines, const std::string& part) {
  for (const auto& line : lines)
    if (line.get<std::string>().find(part) != std::string::npos) return true;
  return false;
}

TEST_F(WindowTest, RotatesPicksMeasuresSavesAndReproduces) {
  const std::string file = molecule("1ubq.pdb");
  const std::vector<PdbAtom> atoms = atomsOf(file);
  ASSERT_NO_FATAL_FAILURE(open({file, "--size", "480x360", "--samples", "2"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_EQ(clipboard(), "meniscus render " + file + " -o 1ubq.png --samples=2 --size=480x360");

  drag(kPanel + 200, 180, 60, 30);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  const std::string turned = clipboard();
  EXPECT_NE(turned.find("--orient="), std::string::npos) << turned;

  // What the command draws is where the atoms are.
  const TemporaryFolder elsewhere;
  ASSERT_EQ(runCommand(turned + " -o ids.exr --channels id", elsewhere.path()).exitCode, 0);
  const std::vector<Seen> seen = wellSeen(readIds(elsewhere / "ids.exr"));
  ASSERT_GT(seen.size(), 20u);
  const Seen &first = seen.front(), &second = seen[seen.size() / 2];
  click(kPanel + first.x, first.y);
  click(kPanel + second.x, second.y);
  key("ctrl+shift+c");
  const PdbAtom &a = atoms.at(first.atom), &b = atoms.at(second.atom);
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) square += std::pow(a.position[i] - b.position[i], 2);
  const std::string copied = clipboard();
  EXPECT_TRUE(copied.starts_with(a.name + " - " + b.name + ": ")) << copied;
  ASSERT_TRUE(copied.ends_with(" Å")) << copied;
  EXPECT_NEAR(std::stod(copied.substr(copied.rfind(": ") + 2)), std::sqrt(square), 0.0051);

  key("m");  // into the picture
  key("3");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  const std::string command = clipboard();
  EXPECT_NE(command.find("--representation=licorice"), std::string::npos) << command;
  EXPECT_NE(command.find("--measure="), std::string::npos) << command;
  key("ctrl+s");
  waitFor("a picture", [&] { return std::filesystem::exists(folder_ / "1ubq.png"); });
  ASSERT_EQ(runCommand(command, elsewhere.path()).exitCode, 0);
  EXPECT_TRUE(readFile(folder_ / "1ubq.png") == readFile(elsewhere / "1ubq.png"));

  key("ctrl+z");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_EQ(clipboard().find("--representation"), std::string::npos);
  key("ctrl+y");
  key("r");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_NE(clipboard().find("--representation=licorice"), std::string::npos);
  EXPECT_EQ(clipboard().find("--orient"), std::string::npos);
  EXPECT_EQ(quit(), 0);
  const auto stats = nlohmann::json::parse(readFile(folder_ / "stats.json"));
  EXPECT_GT(stats.at("input_to_picture_ms").at("count").get<int>(), 0);
}

TEST_F(WindowTest, BrokenAndMissingFilesAreMessages) {
  writeFile(folder_ / "broken.pdb", "this is no structure\n");
  std::filesystem::copy(molecule("adrenaline.pdb"), folder_ / "good.pdb");
  ASSERT_NO_FATAL_FAILURE(open({"good.pdb", "broken.pdb", "--size", "320x240", "--samples", "1"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("Next");  // to the broken one, which is closed
  ASSERT_NO_FATAL_FAILURE(waitForTitle("good.pdb - Meniscus"));
  // What was read stays when the file is being written again, and when it goes.
  std::filesystem::resize_file(folder_ / "good.pdb", 0);
  key("F5");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+s");
  ASSERT_NO_FATAL_FAILURE(waitForFile("good.png"));
  std::filesystem::remove(folder_ / "good.pdb");
  key("2");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("F5");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  // A command that the picture cannot follow is undone.
  key("4");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_NE(clipboard().find("--representation=ball_and_stick"), std::string::npos);
  EXPECT_EQ(quit(), 0);
  const nlohmann::json said = messages(folder_ / "stats.json");
  EXPECT_TRUE(anyContains(said, "broken.pdb")) << said;
  EXPECT_TRUE(anyContains(said, "good.pdb: is empty")) << said;
  EXPECT_TRUE(anyContains(said, "saved good.png")) << said;
  EXPECT_TRUE(anyContains(said, "good.pdb: no such file")) << said;
  EXPECT_TRUE(anyContains(said, "nothing that its representation draws")) << said;
}

TEST_F(WindowTest, OpensWithoutAFileAndWithABrokenOne) {
  writeFile(folder_ / "broken.cif", "data_x\nloop_\n_atom_site.id\n");
#ifdef MENISCUS_SANITIZED
  // GLX's driver leaks, and is named (tests/support/lsan.supp) only where a picture's context keeps it
  // loaded.
  ASSERT_NO_FATAL_FAILURE(open({"broken.cif", molecule("adrenaline.pdb"), "--samples", "1"}));
  ASSERT_NO_FATAL_FAILURE(waitForTitle("adrenaline.pdb - Meniscus"));
#else
  ASSERT_NO_FATAL_FAILURE(open({"broken.cif"}));
  ASSERT_NO_FATAL_FAILURE(waitForTitle("Meniscus"));
#endif
  EXPECT_EQ(quit(), 0);
  EXPECT_TRUE(anyContains(messages(folder_ / "stats.json"), "broken.cif"));
  EXPECT_EQ(readFile(folder_ / "view.log"), "");
}

TEST_F(WindowTest, IsResized) {
  ASSERT_NO_FATAL_FAILURE(open({molecule("adrenaline.pdb"), "--size", "320x240", "--samples", "2"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  resize(1, 1);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  resize(1280, 1024);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_NE(clipboard().find("--size=950x1024"), std::string::npos) << clipboard();
  key("Tab");  // without panels
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_NE(clipboard().find("--size=1280x1024"), std::string::npos) << clipboard();
  // A camera of one's own stays what it is while the window changes; reset fits it to what the window is now.
  drag(500, 500, 80, 30);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  resize(320, 640);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("adrenaline.png"));
  key("r");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("adrenaline.png"));
  EXPECT_EQ(clipboard().find("--orient"), std::string::npos) << clipboard();
  EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, ADenseDisplayHasLargerWidgetsAndTheSamePicture) {
  ASSERT_TRUE(setDisplayResources(display_, "Xft.dpi:\t192\n"));
  // Twice as large it would not fit on the screen.
  ASSERT_NO_FATAL_FAILURE(open({molecule("adrenaline.pdb"), "--size", "600x600", "--samples", "2"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("ctrl+c");
  EXPECT_NE(clipboard().find("--size=" + std::to_string(1280 - 2 * kPanel) + "x1024"), std::string::npos)
      << clipboard();
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("adrenaline.png"));
  EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, GoesOnAfterItWasHidden) {
  ASSERT_NO_FATAL_FAILURE(open({molecule("adrenaline.pdb"), "--size", "320x240", "--samples", "2"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  xdotool({"windowunmap", "--sync", window_});
  resize(600, 400);
  xdotool({"windowmap", "--sync", window_});
  xdotool({"windowfocus", window_});
  drag(450, 200, 40, 30);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("adrenaline.png"));
  EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, WhatIsToBeSavedHasNamesOfItsOwnAndIsWrittenBeforeTheEnd) {
  std::filesystem::copy(projectFile("tests/data/structures/models.pdb"), folder_ / "a{b}.pdb");
  ASSERT_EQ(runCommand("meniscus render 'a{b}.pdb' -o '{model}.png' --model all --size 64x48 "
                       "--samples 1 --save-scene s.mvsj",
                       folder_.path())
                .exitCode,
            0);
  ASSERT_NO_FATAL_FAILURE(open({"a{b}.pdb", "s.mvsj", "--size", "320x240", "--samples", "64"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  for (int i = 0; i < 3; ++i) key("ctrl+s");
  key("Next");
  ASSERT_NO_FATAL_FAILURE(waitForTitle("s.mvsj - Meniscus"));
  for (int i = 0; i < 2; ++i) key("ctrl+s");
  EXPECT_EQ(quit(), 0);
  for (const char* name :
       {"a{b}.png", "a{b}-2.png", "a{b}-3.png", "s-3.png", "s-9.png", "s-2-3.png", "s-2-9.png"})
    EXPECT_FALSE(readFile(folder_ / name).empty()) << name;
  EXPECT_EQ(readFile(folder_ / "s-3.png"), readFile(folder_ / "s-2-3.png"));
  EXPECT_EQ(readFile(folder_ / "view.log"), "");
}

TEST_F(WindowTest, DividerIsDragged) {
  ASSERT_NO_FATAL_FAILURE(
      open({molecule("adrenaline.pdb"), "--size", "320x240", "--samples", "2", "--panel", "ball_and_stick",
            "--panel", "skin: --representation surface", "--divider", "0.5"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  drag(kPanel + 160, 120, -80, 0);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("adrenaline.png"));
  const std::string command = clipboard();
  EXPECT_NE(command.find("--divider=0.25"), std::string::npos) << command;
  EXPECT_EQ(command.find("--orient"), std::string::npos) << command;  // the molecule has not turned
  EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, ModelsArePlayedAndSavedOneByOne) {
  std::filesystem::copy(projectFile("tests/data/structures/models.pdb"), folder_ / "models.pdb");
  ASSERT_NO_FATAL_FAILURE(open({"models.pdb", "--size", "200x160", "--samples", "1"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("space");
  // Somewhere in the film, until it is not the first model that is shown.
  std::string command;
  waitFor("another model", [&] {
    key("ctrl+c");
    command = clipboard();
    return command.find("--model=") != std::string::npos && command.find("--model=1 ") == std::string::npos;
  });
  key("space");
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("models.png"));
  EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, SceneIsDrawnFromWhereItIsSeen) {
  const std::string file = molecule("adrenaline.pdb");
  ASSERT_EQ(
      runCommand("meniscus render " + file +
                     " -o first.png --size 320x240 --samples 2 --representation ball_and_stick --save-scene "
                     "scene.mvsj",
                 folder_.path())
          .exitCode,
      0);
  // By --scene, whatever its name; of the others --strict takes one no more than --offline the other.
  std::filesystem::rename(folder_ / "scene.mvsj", folder_ / "scene.json");
  std::string odd = readFile(folder_ / "scene.json");
  const std::string children = "\"children\":";
  const std::size_t first = odd.find(children);
  ASSERT_NE(first, std::string::npos);
  odd.insert(odd.find('[', first) + 1, R"({"kind":"transition"},)");
  writeFile(folder_ / "odd.json", odd);
  std::string web = readFile(folder_ / "scene.json");
  const std::string url = "\"url\": \"";
  ASSERT_NE(web.find(url), std::string::npos);
  web.insert(web.find(url) + url.size(), "https://example.invalid");
  writeFile(folder_ / "web.json", web);
  ASSERT_NO_FATAL_FAILURE(open({"--scene", "odd.json", "--scene", "web.json", "--scene", "scene.json",
                                "--strict", "--offline", "--cache", "cache", "--size", "320x240"}));
  ASSERT_NO_FATAL_FAILURE(waitForTitle("scene.json - Meniscus"));
  drag(kPanel + 100, 100, 50, 20);
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("scene.png"));
  const std::string turned = readFile(folder_ / "scene.png");
  EXPECT_FALSE(readFile(folder_ / "first.png") == turned);
  wheel(kPanel + 100, 100, 20, {"ctrl"});
  wheel(kPanel + 100, 100, 20, {"ctrl", "shift"});
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  ASSERT_NO_FATAL_FAILURE(saveAndCompare("scene.png"));
  EXPECT_NE(clipboard().find(" --near="), std::string::npos) << clipboard();
  EXPECT_NE(clipboard().find(" --far="), std::string::npos) << clipboard();
  EXPECT_FALSE(readFile(folder_ / "scene.png") == turned);
  EXPECT_EQ(quit(), 0);
  const nlohmann::json said = messages(folder_ / "stats.json");
  EXPECT_TRUE(anyContains(said, "(--strict)")) << said;
  EXPECT_TRUE(anyContains(said, "leave out --offline once")) << said;
}

TEST_F(WindowTest, FilesAreDropped) {
  writeFile(folder_ / "broken.pdb", "this is no structure\n");
  std::filesystem::copy(molecule("adrenaline.pdb"), folder_ / "a name of its own.pdb");
  ASSERT_NO_FATAL_FAILURE(open({}));
  ASSERT_NO_FATAL_FAILURE(waitForTitle("Meniscus"));
  EXPECT_EQ(
      dropFiles(display_, std::stoul(window_), {folder_ / "broken.pdb", folder_ / "a name of its own.pdb"}),
      "");
  ASSERT_NO_FATAL_FAILURE(waitForTitle("a name of its own.pdb - Meniscus"));
  key("ctrl+c");
  EXPECT_TRUE(clipboard().starts_with("meniscus render '" + (folder_ / "a name of its own.pdb").string() +
                                      "' -o 'a name of its own.png'"))
      << clipboard();
  key("Prior");  // to the other, which is closed
  ASSERT_NO_FATAL_FAILURE(waitForTitle("a name of its own.pdb - Meniscus"));
  EXPECT_EQ(quit(), 0);
  EXPECT_TRUE(anyContains(messages(folder_ / "stats.json"), "broken.pdb: is no structure"));
}

TEST_F(WindowTest, OsmesaShowsWhatGlxShows) {
  const std::string picture = molecule("adrenaline.pdb") + " --size 320x240 --samples 2";
  ASSERT_EQ(runCommand("meniscus render " + picture + " -o rendered.png", folder_.path()).exitCode, 0);
  const WindowPixels rendered = readPicture(folder_ / "rendered.png");
  const std::vector<std::string> arguments{molecule("adrenaline.pdb"), "--size", "320x240", "--samples", "2"};
  const auto openBy = [&](const std::string& context, const std::string& backend) {
    std::vector<std::string> all = arguments;
    // The sanitizer knows whose leaks are not ours while a picture's context keeps that library loaded.
    all.insert(all.end(), {"--context", context, "--backend=" + backend});
    moveTo(kBeside, kBeside);
    open(all);
  };
  ASSERT_NO_FATAL_FAILURE(openBy("glx", "egl"));
  WindowPixels byGlx;
  ASSERT_NO_FATAL_FAILURE(waitFor("the picture in the window", [&] {
    byGlx = shown();
    return byGlx.rightOf(kPanel) == rendered;
  }));
  EXPECT_EQ(quit(), 0);

  ASSERT_NO_FATAL_FAILURE(openBy("osmesa", "osmesa"));
  ASSERT_NO_FATAL_FAILURE(waitFor("the same window", [&] { return shown() == byGlx; }));
  click(kPanel + 160, 120);
  moveTo(kBeside, kBeside);
  ASSERT_NO_FATAL_FAILURE(waitFor("a pick", [&] { return shown().rightOf(kPanel) != rendered; }));
  key("Escape");
  ASSERT_NO_FATAL_FAILURE(waitFor("no pick", [&] { return shown() == byGlx; }));
  EXPECT_EQ(quit(), 0);
  EXPECT_EQ(readFile(folder_ / "view.log"), "");
  EXPECT_EQ(nlohmann::json::parse(readFile(folder_ / "stats.json")).at("window"), "OSMesa");
}

class WithoutGlxAndEgl : public WindowTest {
 protected:
  void SetUp() override {
    startServer({"-extension", "GLX"});
    environment_ = {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent"}};
  }
};

TEST_F(WithoutGlxAndEgl, OsmesaShowsWhatRenderWrites) {
  ASSERT_NO_FATAL_FAILURE(open({molecule("adrenaline.pdb"), "--size", "320x240", "--samples", "2"}));
  ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
  key("Tab");  // the picture alone
  moveTo(kBeside, kBeside);
  WindowPixels rendered;
  const auto expectRendered = [&](int width, int height) {
    ASSERT_NO_FATAL_FAILURE(waitUntilDrawn());
    std::string command;
    ASSERT_NO_FATAL_FAILURE(waitFor("a command of this size", [&] {
      key("ctrl+c");
      command = clipboard();
      return command.find(" --size=" + std::to_string(width) + "x" + std::to_string(height)) !=
             std::string::npos;
    }));
    ASSERT_EQ(runCommand(command + " -o rendered.png --backend osmesa", folder_.path()).exitCode, 0);
    rendered = readPicture(folder_ / "rendered.png");
    key("Escape");  // what was said stands in the picture
    waitFor("the picture in the window", [&] { return shown() == rendered; });
  };
  ASSERT_NO_FATAL_FAILURE(expectRendered(320 + kPanel, 240));
  resize(401, 333);
  ASSERT_NO_FATAL_FAILURE(expectRendered(401, 333));
  const WindowPixels before = rendered;
  drag(150, 150, 60, 30);
  moveTo(kBeside, kBeside);
  ASSERT_NO_FATAL_FAILURE(expectRendered(401, 333));
  EXPECT_FALSE(rendered == before);
  xdotool({"windowunmap", "--sync", window_});
  xdotool({"windowmap", "--sync", window_});
  ASSERT_NO_FATAL_FAILURE(waitFor("the picture again", [&] { return shown() == rendered; }));
  xdotool({"windowfocus", window_});
  EXPECT_EQ(quit(), 0);
  EXPECT_EQ(readFile(folder_ / "view.log"), "");
  EXPECT_EQ(nlohmann::json::parse(readFile(folder_ / "stats.json")).at("window"), "OSMesa");
  EXPECT_TRUE(anyContains(messages(folder_ / "stats.json"), "the window is drawn by OSMesa"));
}

TEST(ViewWithoutDisplay, SaysSoAndNamesRender) {
  ProcessOptions options;
  options.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  const ProcessResult result = runProcess({program(), "view", molecule("1ubq.pdb")}, options);
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_TRUE(result.err.starts_with("meniscus: no window can be opened here")) << result.err;
  EXPECT_NE(result.err.find("'meniscus render FILE -o OUT.png'"), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(ViewWithoutDisplay, RefusesWhatIsNotForAWindow) {
  const ProcessResult missing = runProcess({program(), "view", "/nonexistent/x.pdb"});
  EXPECT_EQ(missing.exitCode, 1);
  EXPECT_EQ(missing.err, "meniscus: /nonexistent/x.pdb: no such file: check the path\n");
  const ProcessResult output = runProcess({program(), "view", molecule("1ubq.pdb"), "-o", "x.png"});
  EXPECT_EQ(output.exitCode, 2);
  EXPECT_TRUE(output.err.starts_with("meniscus: --output: is for meniscus render")) << output.err;
  const ProcessResult context = runProcess({program(), "view", "--context", "vulkan"});
  EXPECT_EQ(context.exitCode, 2);
  EXPECT_EQ(context.err, "meniscus: --context: 'vulkan' is not allowed; give auto, glx, egl or osmesa\n");
  const ProcessResult help = runProcess({program(), "view", "--help"});
  EXPECT_EQ(help.exitCode, 0);
  EXPECT_NE(help.out.find("Usage: meniscus view"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
