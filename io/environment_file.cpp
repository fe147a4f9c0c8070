#include "io/environment_file.h"

#include <ImfRgbaFile.h>
#include <ImfStdIO.h>
#include <fmt/format.h>
#include <stb_image.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/srgb.h"
#include "core/text.h"
#include "io/file_bytes.h"

namespace meniscus {
namespace {

constexpr std::int64_t kMostWidth = 8192;
constexpr std::string_view kNames[] = {".hdr", ".exr", ".png", ".jpg", ".jpeg"};

enum class Kind : std::uint8_t { exr, radiance, png, jpeg };

struct File {
  const std::filesystem::path& path;
  std::string bytes;

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(fmt::format("cannot read '{}' as an environment: {}", path.string(), why));
  }
  void requireSize(std::int64_t width, std::int64_t height) const {
    if (width > kMostWidth)
      fail(fmt::format("it has {} x {} pixels, of which {} x {} are possible; scale it down", width, height,
                       kMostWidth, kMostWidth / 2));
    if (width < 1 || height < 1 || std::abs(width - 2 * height) > 1)
      fail(fmt::format("it has {} x {} pixels; an equirectangular picture is twice as wide as high", width,
                       height));
  }
};

Kind kindOf(const File& file) {
  using namespace std::string_view_literals;
  const std::pair<std::string_view, Kind> beginnings[] = {{"\x76\x2f\x31\x01"sv, Kind::exr},
                                                          {"#?RADIANCE\n"sv, Kind::radiance},
                                                          {"#?RGBE\n"sv, Kind::radiance},
                                                          {"\x89PNG\r\n\x1a\n"sv, Kind::png},
                                                          {"\xff\xd8\xff"sv, Kind::jpeg}};
  for (const auto& [beginning, kind] : beginnings)
    if (std::string_view(file.bytes).starts_with(beginning)) return kind;
  file.fail("it is neither OpenEXR, Radiance .hdr, PNG nor JPEG");
}

struct Texels {
  int width = 0, height = 0;
  std::vector<glm::vec3> light;
};

Texels readExr(const File& file) {
  try {
    Imf::StdISStream stream;
    stream.str(file.bytes);
    Imf::RgbaInputFile exr(stream);
    if ((exr.channels() & (Imf::WRITE_RGB | Imf::WRITE_Y)) == 0)
      file.fail("it has no colours (channels R, G, B or Y)");
    const Imath::Box2i& window = exr.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    file.requireSize(width, height);
    std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(width * height));
    exr.setFrameBuffer(pixels.data() - window.min.x - window.min.y * width, 1,
                       static_cast<std::size_t>(width));
    exr.readPixels(window.min.y, window.max.y);
    Texels texels{static_cast<int>(width), static_cast<int>(height), {}};
    texels.light.reserve(pixels.size());
    for (const Imf::Rgba& p : pixels)
      texels.light.emplace_back(static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b));
    return texels;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    file.fail(std::string("OpenEXR: ") + error.what());
  }
}

// Radiance's format: lines of text, an empty one, the size, and then mantissas of red, green and blue and
// their exponent, rows from the top, each run-length encoded channel by channel or not at all. (stb never
// ends on such files that are cut short.)
class RadianceReader {
 public:
  explicit RadianceReader(const File& file) : file_(file), left_(file.bytes) {}

  Texels read() {
    bool known = false;
    for (std::string_view text = line(); !text.empty(); text = line())
      known = known || text == "FORMAT=32-bit_rle_rgbe";
    if (!known) file_.fail("its FORMAT is not 32-bit_rle_rgbe");
    const std::string size(line());
    int width = 0, height = 0, end = 0;
    if (std::sscanf(size.c_str(), "-Y %9d +X %9d%n", &height, &width, &end) != 2 ||
        static_cast<std::size_t>(end) != size.size())
      file_.fail("its rows do not go from left to right and from the top down (-Y height +X width)");
    file_.requireSize(width, height);
    Texels texels{width, height, {}};
    texels.light.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) readRow(static_cast<std::size_t>(width), texels.light);
    return texels;
  }

 private:
  std::string_view take(std::size_t count) {
    if (left_.size() < count) file_.fail("it is damaged: it ends too early");
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }
  std::size_t byte() { return static_cast<unsigned char>(take(1)[0]); }
  std::string_view line() {
    const std::size_t length = left_.find('\n');
    const std::string_view text = take(std::min(length, left_.size()) + 1);
    return text.substr(0, text.size() - 1);
  }
  void readRow(std::size_t width, std::vector<glm::vec3>& light) {
    row_.clear();
    if (width >= 8 && left_.starts_with("\x02\x02")) {
      if (take(4).substr(2) != std::string{static_cast<char>(width >> 8), static_cast<char>(width & 255u)})
        file_.fail("it is damaged: a row is not as long as the others");
      while (row_.size() < 4 * width) {
        const std::size_t channelLeft = width - row_.size() % width, code = byte();
        const std::size_t count = code > 128 ? code - 128 : code;
        if (count == 0 || count > channelLeft) file_.fail("it is damaged: a row is longer than the others");
        if (code > 128) {
          row_.append(count, take(1)[0]);
        } else {
          row_ += take(count);
        }
      }
      for (std::size_t x = 0; x < width; ++x) light.push_back(lightOf(x, width));
    } else {
      row_ = take(4 * width);
      for (std::size_t x = 0; x < width; ++x) light.push_back(lightOf(4 * x, 1));
    }
  }
  // Channels are `step` bytes apart.
  glm::vec3 lightOf(std::size_t at, std::size_t step) const {
    const auto value = [&](std::size_t c) { return static_cast<unsigned char>(row_[at + c * step]); };
    if (value(3) == 0) return glm::vec3(0);
    return std::ldexp(1.0f, value(3) - (128 + 8)) * glm::vec3(value(0), value(1), value(2));
  }

  const File& file_;
  std::string_view left_;
  std::string row_;
};

template <class Value, class ToLight>
std::vector<glm::vec3> lightOf(Value* pixels, std::size_t count, const File& file, const ToLight& toLight) {
  const std::unique_ptr<Value, decltype(&stbi_image_free)> owner(pixels, stbi_image_free);
  if (pixels == nullptr) file.fail(std::string("it is damaged: ") + stbi_failure_reason());
  std::vector<glm::vec3> light(count);
  for (std::size_t i = 0; i < count; ++i)
    light[i] = {toLight(pixels[3 * i]), toLight(pixels[3 * i + 1]), toLight(pixels[3 * i + 2])};
  return light;
}

Texels readByStb(const File& file, Kind kind) {
  if (file.bytes.size() > INT_MAX) file.fail("it is larger than 2 GiB");
  const auto* bytes = reinterpret_cast<const stbi_uc*>(file.bytes.data());
  const int length = static_cast<int>(file.bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(bytes, length, &width, &height, &channels) == 0)
    file.fail(std::string("it is damaged: ") + stbi_failure_reason());
  file.requireSize(width, height);
  // stb takes what is missing for zeros.
  if (kind == Kind::jpeg && file.bytes.rfind("\xff\xd9") == std::string::npos)
    file.fail("it is damaged: it ends too early");
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Texels texels{width, height, {}};
  if (stbi_is_16_bit_from_memory(bytes, length) != 0) {
    texels.light =
        lightOf(stbi_load_16_from_memory(bytes, length, &width, &height, &channels, 3), count, file,
                [](stbi_us value) { return static_cast<float>(linearFromSrgb(value / 65535.0)); });
  } else {
    const std::array<double, 256>& linear = linearOfBytes();
    texels.light = lightOf(stbi_load_from_memory(bytes, length, &width, &height, &channels, 3), count, file,
                           [&](stbi_uc value) { return static_cast<float>(linear[value]); });
  }
  return texels;
}

}  // namespace

bool isEnvironmentName(const std::filesystem::path& path) {
  return std::find(std::begin(kNames), std::end(kNames), lowerCase(path.extension().string())) !=
         std::end(kNames);
}

std::shared_ptr<const EnvironmentMap> readEnvironment(const std::filesystem::path& path) {
  const File file{path, readBytes(path)};
  const Kind kind = kindOf(file);
  Texels texels = kind == Kind::exr        ? readExr(file)
                  : kind == Kind::radiance ? RadianceReader(file).read()
                                           : readByStb(file, kind);
  for (std::size_t i = 0; i < texels.light.size(); ++i) {
    glm::vec3& light = texels.light[i];
    for (int c = 0; c < 3; ++c) {
      const auto width = static_cast<std::size_t>(texels.width);
      if (!std::isfinite(light[c]))
        file.fail(fmt::format("its light in column {}, row {} is not finite", i % width + 1, i / width + 1));
      light[c] = std::max(light[c], 0.0f);
    }
  }
  return std::make_shared<const EnvironmentMap>(texels.width, texels.height, std::move(texels.light));
}

}  // namespace meniscus
