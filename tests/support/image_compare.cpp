#include "tests/support/image_compare.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace meniscus::test {

namespace {

OIIO::ImageBuf wrap(const std::vector<std::byte>& picture, ImageSize size) {
  OIIO::ImageSpec spec(size.width, size.height, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::ImageBuf image(spec);
  image.set_pixels(OIIO::ROI(0, size.width, 0, size.height), OIIO::TypeDesc::UINT8, picture.data());
  return image;
}

void compare(const OIIO::ImageBuf& actual, const OIIO::ImageBuf& expected, const std::string& name,
             const Tolerance& tolerance) {
  const auto threshold = static_cast<float>(tolerance.threshold), hard = static_cast<float>(tolerance.hard);
  const auto result = OIIO::ImageBufAlgo::compare(actual, expected, threshold, threshold);
  const double percent =
      100.0 * static_cast<double>(result.nfail) / static_cast<double>(actual.spec().image_pixels());
  if (!result.error && percent <= tolerance.percent && result.maxerror <= static_cast<double>(hard)) return;
  const std::string actualFile = name + "-actual.png", differenceFile = name + "-difference.png";
  actual.write(actualFile);
  const OIIO::ImageBuf difference = OIIO::ImageBufAlgo::absdiff(actual, expected);
  OIIO::ImageBuf amplified = OIIO::ImageBufAlgo::mul(difference, {10.0f, 10.0f, 10.0f, 0.0f});
  OIIO::ImageBufAlgo::add(amplified, amplified, {0.0f, 0.0f, 0.0f, 1.0f});
  amplified.write(differenceFile, OIIO::TypeDesc::UINT8);
  ADD_FAILURE() << name << ": " << percent << " % of the pixels differ by more than " << tolerance.threshold
                << ", the largest difference is " << result.maxerror << " at " << result.maxx << ", "
                << result.maxy << "; see " << std::filesystem::absolute(actualFile) << " and "
                << std::filesystem::absolute(differenceFile);
}

}  // namespace

void expectMatchesStored(const std::vector<std::byte>& picture, ImageSize size,
                         const std::filesystem::path& stored, const Tolerance& tolerance) {
  const OIIO::ImageBuf actual = wrap(picture, size);
  if (std::getenv("MENISCUS_UPDATE_GOLDEN")) {
    ASSERT_TRUE(actual.write(stored.string())) << stored;
    return;
  }
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // as it is stored, not premultiplied
  const OIIO::ImageBuf expected(stored.string(), 0, 0, nullptr, &config);
  ASSERT_EQ(expected.spec().width, size.width) << stored << " is missing or of another size";
  ASSERT_EQ(expected.spec().height, size.height) << stored;
  ASSERT_EQ(expected.nchannels(), 4) << stored;
  compare(actual, expected, stored.stem().string(), tolerance);
}

void expectSimilar(const std::vector<std::byte>& picture, const std::vector<std::byte>& other, ImageSize size,
                   const std::string& name, const Tolerance& tolerance) {
  ASSERT_EQ(picture.size(), other.size());
  compare(wrap(picture, size), wrap(other, size), name, tolerance);
}

}  // namespace meniscus::test
