#include "tests/cli/cli_test.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "tests/support/paths.h"

namespace meniscus::test {

std::array<float, 4> Picture::at(int x, int y) const {
  std::array<float, 4> pixel{0, 0, 0, 1};
  const auto first = static_cast<std::size_t>((y * width + x) * channels);
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) pixel[c] = pixels[first + c];
  return pixel;
}

double Picture::covered() const {
  int count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (at(x, y) != at(0, 0)) ++count;
  return static_cast<double>(count) / (width * height);
}

Picture readPicture(const std::filesystem::path& path) {
  OIIO::ImageSpec asStored;
  asStored.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path.string(), &asStored);
  if (!input) {
    ADD_FAILURE() << "cannot read " << path << ": " << OIIO::geterror();
    return {};
  }
  const OIIO::ImageSpec& spec = input->spec();
  Picture picture{spec.width, spec.height, spec.nchannels, static_cast<int>(spec.format.size()) * 8, {}, {}};
  picture.pixels.resize(static_cast<std::size_t>(spec.image_pixels()) *
                        static_cast<std::size_t>(spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, picture.pixels.data()))
      << input->geterror();
  for (const auto& attribute : spec.extra_attribs)
    picture.text[attribute.name().string()] = attribute.get_string();
  return picture;
}

ProcessResult CliTest::run(const std::vector<std::string>& arguments, const Environment& environment) const {
  std::vector<std::string> argv{program()};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  ProcessOptions options;
  options.folder = folder_.path();
  options.environment = environment;
  ProcessResult result = runProcess(argv, options);
  EXPECT_FALSE(result.timedOut);
  return result;
}

Picture CliTest::render(const std::string& input, const std::vector<std::string>& more,
                        const std::string& output) const {
  std::vector<std::string> arguments{"render", molecule(input), "-o",        output, "-q",
                                     "--size", "64x48",         "--samples", "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  expectSuccess(run(arguments));
  return readPicture(folder_ / output);
}

const Picture& CliTest::usual() const {
  static const Picture picture = render(kProtein);
  return picture;
}

nlohmann::json CliTest::stats(const std::string& input, std::vector<std::string> more) const {
  more.insert(more.end(), {"--stats", "stats.json"});
  render(input, more);
  return nlohmann::json::parse(readFile(folder_ / "stats.json"), nullptr, false);
}

std::string molecule(const std::string& name) {
  return projectFile("molecules/" + name);
}

void expectError(const ProcessResult& result, ExitCode code, const std::vector<std::string>& parts) {
  EXPECT_EQ(result.exitCode, static_cast<int>(code)) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(result.err.starts_with("meniscus: ")) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_TRUE(result.err.ends_with('\n'));
  for (const std::string& part : parts)
    EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
}

void expectSuccess(const ProcessResult& result) {
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

}  // namespace meniscus::test
