// Pictures of what is all around, written by OpenImageIO, and what is refused.

#include "io/environment_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/srgb.h"
#include "tests/support/process.h"

namespace meniscus {
namespace {

constexpr int kAround = 32, kDown = 16;

// The direction in which the middle of a texel lies.
glm::dvec3 directionOf(double column, double row, int width, int height) {
  const double right = ((column + 0.5) / width - 0.5) * 6.283185307179586;
  const double down = (row + 0.5) / height * 3.141592653589793;
  return {std::sin(down) * std::sin(right), std::cos(down), -std::sin(down) * std::cos(right)};
}

// Different everywhere, 0..0.9.
float valueIn(int column, int row, int channel) {
  return static_cast<float>((column * 7 + row * 13 + channel * 29) % 10) / 10;
}

class EnvironmentFile : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  std::filesystem::path write(const std::string& name, OIIO::TypeDesc type, const std::vector<float>& values,
                              int width = kAround, int height = kDown, int channels = 3) const {
    const std::filesystem::path path = file(name);
    const auto output = OIIO::ImageOutput::create(path.string());
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.attribute("CompressionQuality", 100);
    EXPECT_TRUE(output && output->open(path.string(), spec));
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
    output->close();
    return path;
  }
  static std::vector<float> manyValues(int channels = 3) {
    std::vector<float> values;
    for (int row = 0; row < kDown; ++row)
      for (int column = 0; column < kAround; ++column)
        for (int c = 0; c < channels; ++c) values.push_back(valueIn(column, row, c));
    return values;
  }
  template <class Expected>
  static void expectTexels(const EnvironmentMap& map, double tolerance, const Expected& expected) {
    ASSERT_EQ(map.width(), kAround);
    ASSERT_EQ(map.height(), kDown);
    for (int row = 0; row < kDown; ++row) {
      for (int column = 0; column < kAround; ++column) {
        const glm::dvec3 light = map.light(directionOf(column, row, kAround, kDown));
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(light[c], expected(static_cast<double>(valueIn(column, row, c))), tolerance)
              << column << " " << row;
      }
    }
  }
  void expectRefused(const std::filesystem::path& path, const std::string& why) const {
    try {
      readEnvironment(path);
      ADD_FAILURE() << "read " << path;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(path.filename().string()), std::string::npos) << text;
      EXPECT_NE(text.find(why), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
  }
  // The same file without its end.
  std::filesystem::path cut(const std::filesystem::path& path, double share) const {
    std::string bytes = test::readFile(path);
    bytes.resize(static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
    std::ofstream(file("cut" + path.extension().string()), std::ios::binary) << bytes;
    return file("cut" + path.extension().string());
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(EnvironmentFile, LinearFilesAreTakenAsTheyAre) {
  const auto same = [](double value) { return value; };
  expectTexels(*readEnvironment(write("a.exr", OIIO::TypeDesc::HALF, manyValues())), 5e-4, same);
  expectTexels(*readEnvironment(write("b.exr", OIIO::TypeDesc::FLOAT, manyValues(4), kAround, kDown, 4)),
               5e-4, same);
  // One exponent for three mantissas of 8 bits.
  expectTexels(*readEnvironment(write("c.hdr", OIIO::TypeDesc::FLOAT, manyValues())), 4e-3, same);
}

TEST_F(EnvironmentFile, StoredColoursBecomeLight) {
  const auto linear = [](double value) { return linearFromSrgb(value); };
  expectTexels(*readEnvironment(write("a.png", OIIO::TypeDesc::UINT8, manyValues())), 6e-3, linear);
  expectTexels(*readEnvironment(write("b.png", OIIO::TypeDesc::UINT16, manyValues())), 3e-5, linear);
  const std::vector<float> grey(static_cast<std::size_t>(3 * kAround * kDown), 0.5f);
  const auto map = readEnvironment(write("c.JPG", OIIO::TypeDesc::UINT8, grey));
  EXPECT_NEAR(map->light({0, 1, 0}).y, linearFromSrgb(0.5), 0.01);
}

TEST_F(EnvironmentFile, LightMayBeBrightButNotNegative) {
  std::vector<float> values(static_cast<std::size_t>(3 * kAround * kDown), -0.25f);
  values[0] = 5000;
  const auto map = readEnvironment(write("a.exr", OIIO::TypeDesc::HALF, values));
  EXPECT_NEAR(map->light(directionOf(0, 0, kAround, kDown)).x, 5000, 1e-6);
  EXPECT_EQ(map->light({0, -1, 0}), glm::dvec3(0));
}

TEST_F(EnvironmentFile, WhatCannotBeReadIsNamed) {
  expectRefused(file("none.hdr"), "none.hdr");
  std::ofstream(file("text.png")) << "no picture at all";
  expectRefused(file("text.png"), "neither OpenEXR, Radiance .hdr, PNG nor JPEG");
  for (const char* name : {"wide.exr", "wide.hdr", "wide.png"})
    expectRefused(write(name, OIIO::TypeDesc::UNKNOWN, manyValues(), kDown, kAround),
                  "twice as wide as high");
  std::ofstream(file("large.hdr")) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4097 +X 8194\n";
  expectRefused(file("large.hdr"), "8192 x 4096");
  std::vector<float> values = manyValues();
  values[3 * (2 * kAround + 5) + 1] = std::numeric_limits<float>::infinity();
  expectRefused(write("sun.exr", OIIO::TypeDesc::HALF, values), "column 6, row 3 is not finite");
}

TEST_F(EnvironmentFile, DamagedFilesAreRefused) {
  for (const char* name : {"a.exr", "a.hdr", "a.png", "a.jpg"}) {
    const auto type = std::string(name) == "a.exr" ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UNKNOWN;
    const std::filesystem::path whole = write(name, type, manyValues());
    for (const double share : {0.3, 0.6, 0.9}) {
      SCOPED_TRACE(share);
      expectRefused(cut(whole, share), "cut");
    }
  }
  // Too narrow to be run-length encoded.
  expectRefused(cut(write("b.hdr", OIIO::TypeDesc::FLOAT, std::vector<float>(24, 0.5f), 4, 2), 0.9),
                "ends too early");
}

}  // namespace
}  // namespace meniscus
