#include "app/panels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/render_options.h"
#include "core/error.h"

namespace meniscus {
namespace {

TEST(PlacePanels, CoverThePictureWithoutOverlap) {
  for (std::size_t count = 2; count <= kMostPanels; ++count) {
    for (const ImageSize whole :
         {ImageSize{640, 480}, ImageSize{481, 641}, ImageSize{17, 13}, ImageSize{1, 1}}) {
      for (const double divider : {-1.0, 0.0, 0.3, 1.0}) {
        if (divider >= 0 && count != 2) continue;
        const auto places = placePanels(count, whole, divider < 0 ? std::nullopt : std::optional(divider));
        ASSERT_EQ(places.size(), count);
        long long area = 0;
        for (const PanelPlace& p : places) {
          area += static_cast<long long>(p.width) * p.height;
          EXPECT_GE(p.x, p.pictureX);
          EXPECT_LE(p.x + p.width, std::min(whole.width, p.pictureX + p.picture.width));
          EXPECT_LE(p.y + p.height, std::min(whole.height, p.pictureY + p.picture.height));
          for (const PanelPlace& q : places) {
            const bool apart = p.x + p.width <= q.x || q.x + q.width <= p.x || p.y + p.height <= q.y ||
                               q.y + q.height <= p.y;
            EXPECT_TRUE(&p == &q || apart || whole.width == 1);
          }
        }
        // What is left are the lines between them.
        if (whole.width > 100) {
          EXPECT_GE(area,
                    static_cast<long long>(whole.width) * whole.height - 4 * (whole.width + whole.height));
        }
      }
    }
  }
}

TEST(PanelCanvas, PastesWhatIsSeenOfAPanel) {
  const ImageSize whole{8, 2};
  const auto places = placePanels(2, whole, 0.5);
  PanelCanvas canvas(whole);
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<std::byte> picture(4 * 16);
    for (std::size_t k = 0; k < picture.size(); ++k) picture[k] = static_cast<std::byte>(100 * i + k);
    canvas.paste(places[i], picture);
  }
  const auto at = [&](std::size_t x, std::size_t y) {
    return std::to_integer<int>(canvas.bytes()[4 * (8 * y + x)]);
  };
  EXPECT_EQ(at(0, 0), 0);
  EXPECT_EQ(at(3, 1), 44);
  EXPECT_EQ(at(4, 0), 0x80);  // the line
  EXPECT_EQ(at(5, 1), 0x80);
  EXPECT_EQ(at(6, 1), 100 + 56);
}

TEST(ParsePanel, TakesRepresentationsLabelsAndOptions) {
  const PanelOptions plain = parsePanel("--panel", "surface");
  EXPECT_EQ(plain.label, "surface");
  EXPECT_EQ(plain.arguments, (std::vector<std::string>{"--representation", "surface"}));
  const PanelOptions labelled = parsePanel("--panel", "my skin: --representation surface --opacity 0.5");
  EXPECT_EQ(labelled.label, "my skin");
  EXPECT_EQ(labelled.arguments.size(), 4u);
  EXPECT_EQ(parsePanel("--panel", "--color chain").label, "");
  // A panel's style must not give way to what all panels share, as a style does to all that stands beside it.
  const std::vector<std::string> styled = parsePanel("--panel", "--style soft --samples 4").arguments;
  EXPECT_EQ(std::count(styled.begin(), styled.end(), "--style"), 0);
  EXPECT_EQ(std::count(styled.begin(), styled.end(), "--shadows"), 1);
  EXPECT_EQ(styled.back(), "4");
}

TEST(ParsePanel, KnowsErrors) {
  EXPECT_FALSE(parsePanel("--panel", "surface").error);
  const PanelOptions plain = parsePanel("--panel", "error"), named = parsePanel("--panel", "how far: error");
  EXPECT_TRUE(plain.error && named.error);
  EXPECT_EQ(plain.label, "error");
  EXPECT_EQ(named.label, "how far");
}

TEST(ParsePanel, NamesWhatIsWrong) {
  for (const char* bad : {"", "x: ", "nonsense", "--nonsense 1", "--size 3x3", "--panel surface", "-o a.png",
                          "a.pdb b.pdb", "--opacity 7", "--export a.ply", "--turntable 5", "--focus (HEM)",
                          "--distance 50", "--style glossy"}) {
    try {
      parsePanel("--panel", bad);
      ADD_FAILURE() << bad;
    } catch (const UsageError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("--panel: ")) << error.what();
    }
  }
}

TEST(PanelOptions, MustMakeSense) {
  const auto parse = [](std::vector<std::string> more) {
    std::vector<std::string> arguments{"a.pdb", "-o", "a.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return parseRenderOptions(arguments);
  };
  EXPECT_TRUE(parse({"--panel", "surface", "--panel", "cartoon", "--divider", "0.2"}));
  EXPECT_THROW(parse({"--panel", "surface"}), UsageError);
  EXPECT_THROW(parse({"--divider", "0.5"}), UsageError);
  EXPECT_TRUE(parse({"--panel", "surface", "--panel", "cartoon", "--panel", "error"}));
  EXPECT_THROW(parse({"--panel", "surface", "--panel", "error"}), UsageError);
  EXPECT_THROW(parse({"--panel", "error", "--panel", "surface", "--panel", "cartoon"}), UsageError);
  EXPECT_THROW(parse({"--panel", "surface", "--panel", "cartoon", "--depth", "16"}), UsageError);
  EXPECT_THROW(parse({"--panel", "surface", "--panel", "cartoon", "-o", "a.exr"}), UsageError);
  EXPECT_THROW(parse({"--panel", "surface", "--panel", "cartoon", "--save-scene", "s.mvsj"}), UsageError);
}

}  // namespace
}  // namespace meniscus
