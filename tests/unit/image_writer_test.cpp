// Pictures are read back through OpenImageIO, which shares nothing with the writers but libpng and OpenEXR.

#include "io/image_writer.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "tests/support/process.h"

namespace meniscus {
namespace {

using test::readFile;
using test::TemporaryFolder;

constexpr ImageSize kSize{7, 5};

/// Channel c (0..3) of pixel (x, y from the top), 0..1, different everywhere.
float valueAt(int x, int y, int c) {
  return static_cast<float>((x + kSize.width * y) * 4 + c) /
         static_cast<float>(kSize.width * kSize.height * 4);
}

template <typename Value>
std::vector<Value> testPixels(float scale) {
  std::vector<Value> pixels;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      for (int c = 0; c < 4; ++c) pixels.push_back(static_cast<Value>(valueAt(x, y, c) * scale));
  return pixels;
}

template <typename Value>
void write(const std::filesystem::path& path, const ImageFileOptions& options,
           const std::vector<Value>& pixels) {
  const auto file = ImageFile::create(path, options);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(pixels));
  const std::size_t row = bytes.size() / static_cast<std::size_t>(options.size.height);
  // Bands of 2, 1 and 2 rows.
  file->writeRows(bytes.subspan(0, 2 * row));
  file->writeRows(bytes.subspan(2 * row, row));
  file->writeRows(bytes.subspan(3 * row));
  file->finish();
}

struct ReadBack {
  OIIO::ImageSpec spec;
  std::vector<float> pixels;
};

ReadBack readBack(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) throw std::runtime_error(OIIO::geterror());
  ReadBack result{input->spec(), {}};
  result.pixels.resize(static_cast<std::size_t>(result.spec.image_pixels()) *
                       static_cast<std::size_t>(result.spec.nchannels));
  input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, result.pixels.data());
  return result;
}

/// `expected(x, y, c)` must be what was read, within `tolerance`.
template <typename Expected>
void expectPixels(const ReadBack& image, int channels, float tolerance, Expected expected) {
  ASSERT_EQ(image.spec.width, kSize.width);
  ASSERT_EQ(image.spec.height, kSize.height);
  ASSERT_EQ(image.spec.nchannels, channels);
  std::size_t i = 0;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      for (int c = 0; c < channels; ++c)
        EXPECT_NEAR(image.pixels[i++], expected(x, y, c), tolerance)
            << "at " << x << ' ' << y << " channel " << c;
}

ImageFileOptions optionsFor(PixelFormat format, bool alpha) {
  ImageFileOptions options;
  options.size = kSize;
  options.format = format;
  options.alpha = alpha;
  return options;
}

TEST(ImageTypeOf, goesByTheExtensionInAnyCase) {
  EXPECT_EQ(imageTypeOf("a.png"), ImageType::png);
  EXPECT_EQ(imageTypeOf("a.b/c.PNG"), ImageType::png);
  EXPECT_EQ(imageTypeOf("a.Exr"), ImageType::exr);
  EXPECT_THROW(imageTypeOf("a.jpg"), UsageError);
  EXPECT_THROW(imageTypeOf("png"), UsageError);
}

TEST(PngFile, holdsRgbOf8BitsWithoutAlpha) {
  const TemporaryFolder folder;
  write(folder / "a.png", optionsFor(PixelFormat::rgba8, false), testPixels<std::uint8_t>(255));
  const ReadBack image = readBack(folder / "a.png");
  EXPECT_EQ(image.spec.format, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(image.spec.get_string_attribute("oiio:ColorSpace"), "sRGB");
  expectPixels(image, 3, 1e-6f, [](int x, int y, int c) { return std::floor(valueAt(x, y, c) * 255) / 255; });
}

TEST(PngFile, holdsRgbaOf16Bits) {
  const TemporaryFolder folder;
  write(folder / "a.png", optionsFor(PixelFormat::rgba16, true), testPixels<std::uint16_t>(65535));
  const auto input = OIIO::ImageInput::open((folder / "a.png").string());
  ASSERT_NE(input, nullptr);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT16);
  ASSERT_EQ(input->spec().nchannels, 4);
  // Native reads are as stored, without OpenImageIO's premultiplication.
  OIIO::ImageSpec asStored;
  asStored.attribute("oiio:UnassociatedAlpha", 1);
  const auto straight = OIIO::ImageInput::open((folder / "a.png").string(), &asStored);
  ReadBack image{straight->spec(),
                 std::vector<float>(static_cast<std::size_t>(kSize.width * kSize.height) * 4)};
  straight->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, image.pixels.data());
  expectPixels(image, 4, 1e-6f,
               [](int x, int y, int c) { return std::floor(valueAt(x, y, c) * 65535) / 65535; });
}

TEST(PngFile, recordsResolutionAndText) {
  const TemporaryFolder folder;
  ImageFileOptions options = optionsFor(PixelFormat::rgba8, false);
  options.dpi = 300;
  options.metadata = {{"Software", "Meniscus 1"}, {"Comment", "meniscus render \xC3\xA5.pdb"}};
  write(folder / "a.png", options, testPixels<std::uint8_t>(255));
  const ReadBack image = readBack(folder / "a.png");
  EXPECT_EQ(image.spec.get_string_attribute("Software"), "Meniscus 1");
  EXPECT_EQ(image.spec.get_string_attribute("Comment"), "meniscus render \xC3\xA5.pdb");
  const float perUnit = image.spec.get_float_attribute("XResolution");
  const bool metric = image.spec.get_string_attribute("ResolutionUnit") == "m";
  EXPECT_NEAR(metric ? perUnit * 0.0254f : perUnit, 300, 0.01);
}

TEST(PngFile, isTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "b.png"})
    write(folder / name, optionsFor(PixelFormat::rgba8, true), testPixels<std::uint8_t>(255));
  EXPECT_EQ(readFile(folder / "a.png"), readFile(folder / "b.png"));
}

TEST(ExrFile, holdsLinearHalfFloats) {
  const TemporaryFolder folder;
  write(folder / "a.exr", optionsFor(PixelFormat::rgbaFloat, true), testPixels<float>(4));
  const ReadBack image = readBack(folder / "a.exr");
  EXPECT_EQ(image.spec.format, OIIO::TypeDesc::HALF);
  EXPECT_EQ(image.spec.channelnames, (std::vector<std::string>{"R", "G", "B", "A"}));
  // A half has 11 significant bits.
  expectPixels(image, 4, 4.0f / 2048, [](int x, int y, int c) { return valueAt(x, y, c) * 4; });
}

// Ids that a float cannot hold are stored as whole numbers.
TEST(ExrFile, keepsEveryIdExact) {
  const TemporaryFolder folder;
  ImageFileOptions options = optionsFor(PixelFormat::rgbaFloat, false);
  options.layers = {.color = false, .depth = true, .id = true};
  for (const bool wide : {false, true}) {
    options.wideIds = wide;
    const std::uint32_t first = wide ? (1u << 24) + 1 : 1;
    std::vector<std::uint32_t> words;
    for (int i = 0; i < kSize.width * kSize.height; ++i) {
      const float z = i == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(i) / 3;
      words.insert(words.end(), {std::bit_cast<std::uint32_t>(z), first + static_cast<std::uint32_t>(i)});
    }
    write(folder / "a.exr", options, words);
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_NE(input, nullptr);
    const int z = input->spec().channelindex("Z"), id = input->spec().channelindex("id");
    EXPECT_EQ(input->spec().channelformat(z), OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(input->spec().channelformat(id), wide ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
    std::vector<std::byte> pixels(words.size() * 4);
    ASSERT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UNKNOWN, pixels.data()));
    for (std::size_t i = 0; i < words.size() / 2; ++i) {
      std::uint32_t number = 0;
      float value = 0;
      std::memcpy(&value, pixels.data() + 4 * (2 * i + static_cast<std::size_t>(id)), 4);
      std::memcpy(&number, pixels.data() + 4 * (2 * i + static_cast<std::size_t>(id)), 4);
      EXPECT_EQ(wide ? number : static_cast<std::uint32_t>(value), words[2 * i + 1]);
      std::memcpy(&number, pixels.data() + 4 * (2 * i + static_cast<std::size_t>(z)), 4);
      EXPECT_EQ(number, words[2 * i]);
    }
  }
}

TEST(ExrFile, dropsAlphaAndRecordsText) {
  const TemporaryFolder folder;
  ImageFileOptions options = optionsFor(PixelFormat::rgbaFloat, false);
  options.metadata = {{"Software", "Meniscus 1"}};
  options.dpi = 150;
  for (const char* name : {"a.exr", "b.exr"}) write(folder / name, options, testPixels<float>(1));
  const ReadBack image = readBack(folder / "a.exr");
  EXPECT_EQ(image.spec.channelnames, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.spec.get_string_attribute("Software"), "Meniscus 1");
  EXPECT_EQ(image.spec.get_float_attribute("XResolution"), 150);
  EXPECT_EQ(readFile(folder / "a.exr"), readFile(folder / "b.exr"));
}

TEST(ImageFile, leavesNothingBehindUnlessFinished) {
  for (const char* name : {"a.png", "a.exr"}) {
    const TemporaryFolder folder;
    test::writeFile(folder / name, "old");
    const bool exr = imageTypeOf(name) == ImageType::exr;
    auto file = ImageFile::create(folder / name,
                                  optionsFor(exr ? PixelFormat::rgbaFloat : PixelFormat::rgba8, false));
    const std::vector<std::byte> row(static_cast<std::size_t>(kSize.width) * (exr ? 16 : 4));
    file->writeRows(row);
    EXPECT_EQ(folder.names().size(), 2u);
    file.reset();
    EXPECT_EQ(folder.names(), std::vector<std::string>{name});
    EXPECT_EQ(readFile(folder / name), "old");
  }
}

TEST(ImageFile, saysThatTheDiskIsFull) {
  for (const char* name : {"a.png", "a.exr"}) {
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/full", folder / name);
    const bool exr = imageTypeOf(name) == ImageType::exr;
    try {
      if (exr)
        write(folder / name, optionsFor(PixelFormat::rgbaFloat, true), testPixels<float>(1));
      else
        write(folder / name, optionsFor(PixelFormat::rgba8, true), testPixels<std::uint8_t>(255));
      FAIL() << name << " was written to a full disk";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("free some space"), std::string::npos) << error.what();
    }
    EXPECT_EQ(folder.names(), std::vector<std::string>{name});
  }
}

TEST(ImageFile, streamsAPosterInBands) {
  const TemporaryFolder folder;
  ImageFileOptions options = optionsFor(PixelFormat::rgba8, false);
  options.size = {30000, 3000};
  const auto file = ImageFile::create(folder / "poster.png", options);
  const std::vector<std::byte> row(static_cast<std::size_t>(options.size.width) * 4, std::byte{77});
  for (int y = 0; y < options.size.height; ++y) file->writeRows(row);
  file->finish();
  const auto input = OIIO::ImageInput::open((folder / "poster.png").string());
  ASSERT_NE(input, nullptr);
  EXPECT_EQ(input->spec().width, 30000);
  EXPECT_EQ(input->spec().height, 3000);
}

}  // namespace
}  // namespace meniscus
