// `--surface-method mesh`, `--mesh-spacing` and `--export`: what is written, what is refused.

#include <algorithm>
#include <fstream>

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

class RenderMesh : public CliTest {
 protected:
  // The header of a PLY file.
  std::string headerOf(const std::string& name) const {
    std::ifstream file(folder_.path() / name, std::ios::binary);
    std::string text, line;
    while (std::getline(file, line) && line != "end_header") text += line + "\n";
    return text;
  }
  std::size_t verticesOf(const std::string& name) const {
    const std::string header = headerOf(name);
    const std::size_t at = header.find("element vertex ");
    return at == std::string::npos ? 0 : std::stoul(header.substr(at + 15));
  }
};

TEST_F(RenderMesh, exportsWithoutAPicture) {
  expectSuccess(
      run({"render", molecule("c60.pdb"), "--representation", "surface", "--export", "c60.ply", "-q"},
          kNoGraphics));
  const std::size_t vertices = verticesOf("c60.ply");
  EXPECT_GT(vertices, 1000u);
  expectSuccess(run({"render", molecule("c60.pdb"), "--representation", "surface", "--export",
                     "{stem}-fine.ply", "--mesh-spacing", "0.25", "-q"}));
  EXPECT_GT(verticesOf("c60-fine.ply"), 3 * vertices);
  expectSuccess(
      run({"render", molecule("c60.pdb"), "--representation", "surface", "--export", "c60.glb", "-q"}));
  std::ifstream glb(folder_.path() / "c60.glb", std::ios::binary);
  char magic[4] = {};
  glb.read(magic, 4);
  EXPECT_EQ(std::string(magic, 4), "glTF");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 3) << "nothing else";
}

TEST_F(RenderMesh, exportsBesideAPicture) {
  const Picture picture = render("c60.pdb", {"--representation", "surface", "--export", "a.ply",
                                             "--surface-method", "mesh", "--mesh-spacing", "1"});
  EXPECT_GT(picture.covered(), 0.1);
  EXPECT_GT(verticesOf("a.ply"), 100u);
  EXPECT_LT(verticesOf("a.ply"), 2000u);
}

TEST_F(RenderMesh, drawsNearlyTheSameSurface) {
  const std::vector<std::string> surface{"--representation", "surface"};
  std::vector<std::string> mesh = surface;
  mesh.insert(mesh.end(), {"--surface-method", "mesh", "--mesh-spacing", "0.2"});
  const Picture a = render("c60.pdb", surface), b = render("c60.pdb", mesh);
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += static_cast<double>(std::abs(a.pixels[i] - b.pixels[i]));
  EXPECT_LT(sum / static_cast<double>(a.pixels.size()), 0.01);
  EXPECT_GT(sum, 0);
}

TEST_F(RenderMesh, isRefused) {
  const std::string c60 = molecule("c60.pdb");
  const auto refuse = [&](std::vector<std::string> more, ExitCode code,
                          const std::vector<std::string>& parts) {
    more.insert(more.begin(), {"render", c60});
    expectError(run(more), code, parts);
  };
  refuse({"--export", "a.ply"}, ExitCode::badUsage, {"--export", "add --representation surface"});
  refuse({"--representation", "surface", "--export", "a.obj"}, ExitCode::badUsage,
         {"a.obj", ".ply nor .glb"});
  refuse({"--representation", "surface", "-o", "a.png", "--mesh-spacing", "1"}, ExitCode::badUsage,
         {"--mesh-spacing", "--surface-method mesh"});
  refuse({"--representation", "surface", "--export", "none/a.ply"}, ExitCode::badInput, {"none", "mkdir"});
  refuse({"--representation", "surface", "--export", "a.ply", "--mesh-spacing", "0.01"}, ExitCode::badUsage,
         {"--mesh-spacing", "0.1 to 4"});
  refuse({"--representation", "surface", "--export", "a.ply", "--level", "1000", "-q"}, ExitCode::badInput,
         {"a.ply", "no surface"});
  refuse({"--representation", "surface", "--export", "a.ply", "-o", "{model}.png", "--model", "all"},
         ExitCode::badUsage, {"--export", "{model}"});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace meniscus::test
