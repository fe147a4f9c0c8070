#include "app/option_values.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/error.h"

namespace meniscus {
namespace {

/// The value is refused in one line that names the option, the value and `allowed`.
void expectRefused(const std::string& value, const std::string& allowed,
                   const std::function<void(const std::string&)>& parse) {
  try {
    parse(value);
    ADD_FAILURE() << "'" << value << "' was taken";
  } catch (const UsageError& error) {
    const std::string line = error.what();
    EXPECT_TRUE(line.starts_with("--name: '" + value + "'")) << line;
    EXPECT_NE(line.find(allowed), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(ParseNumber, takesNumbersInRange) {
  EXPECT_EQ(parseNumber("--name", "30", 1, 170), 30);
  EXPECT_EQ(parseNumber("--name", "+1.5e1", 1, 170), 15);
  EXPECT_EQ(parseNumber("--name", ".5", 0, 1), 0.5);
  for (const char* value : {"", "x", "30x", "0.99", "171", "nan", "inf", "-inf", "1e999", " 30", "0x20"})
    expectRefused(value, "from 1 to 170 degrees",
                  [](auto& v) { parseNumber("--name", v, 1, 170, "degrees"); });
}

TEST(ParseKernel, takesNamesAndExponents) {
  EXPECT_EQ(parseKernel("--name", "Sextic"), (Kernel{KernelShape::sextic}));
  EXPECT_EQ(parseKernel("--name", "quartic"), (Kernel{KernelShape::quartic}));
  EXPECT_EQ(parseKernel("--name", "power:2"), (Kernel{KernelShape::power, 2}));
  EXPECT_EQ(parseKernel("--name", "power:16"), (Kernel{KernelShape::power, 16}));
  for (const char* value : {"", "cubic", "power", "power:", "power:1", "power:17", "power:2.5", "power:x"})
    expectRefused(value, "power:N with N from 2 to 16", [](auto& v) { parseKernel("--name", v); });
}

TEST(ParseSurfaceOption, takesANameAndANumber) {
  EXPECT_EQ(parseSurfaceOption("--name", "tolerance=1e-4"),
            (std::pair<std::string, double>{"tolerance", 1e-4}));
  for (const char* value : {"", "tolerance", "=1", "tolerance=", "tolerance=x", "tolerance=nan", "a=1=2"})
    expectRefused(value, "NAME=NUMBER", [](auto& v) { parseSurfaceOption("--name", v); });
}

TEST(ParseShown, takesASelectionAndARepresentation) {
  const ShownApart shown = parseShown("--name", "(HEM)=ball-and-stick");
  EXPECT_EQ(shown.cid, "(HEM)");
  EXPECT_EQ(shown.representation, Representation::ballAndStick);
  EXPECT_FALSE(shown.coloring);
  EXPECT_EQ(parseShown("--name", "(HEM)=licorice:element").coloring->scheme, ColorScheme::element);
  EXPECT_EQ(parseShown("--name", "//A=licorice:#f00").coloring->uniform, Rgb{0xFF0000});
  for (const char* value : {"", "(HEM)", "=licorice"})
    expectRefused(value, "CID=REPRESENTATION", [](auto& v) { parseShown("--name", v); });
  EXPECT_THROW(parseShown("--name", "(HEM)=cartoonish"), UsageError);
  EXPECT_THROW(parseShown("--name", "(HEM)=licorice:"), UsageError);
}

TEST(ParseInteger, takesWholeNumbersInRange) {
  EXPECT_EQ(parseInteger("--name", "256", 1, 256), 256);
  for (const char* value : {"", "0", "257", "1.5", "1e2", "99999999999999999999"})
    expectRefused(value, "whole number from 1 to 256", [](auto& v) { parseInteger("--name", v, 1, 256); });
}

TEST(ParseSize, takesASizeOrASquare) {
  EXPECT_EQ(parseSize("--name", "1920x1080"), (ImageSize{1920, 1080}));
  EXPECT_EQ(parseSize("--name", "1X2"), (ImageSize{1, 2}));
  EXPECT_EQ(parseSize("--name", "512"), (ImageSize{512, 512}));
  EXPECT_EQ(parseSize("--name", "65535x32767"), (ImageSize{65535, 32767}));
  for (const char* value : {"", "x", "12x", "x12", "0x10", "10x0", "-1x5", "10x20x30", "65536x1", "1e3x5",
                            "10 x 20", "99999999999999999999x1"})
    expectRefused(value, "WIDTHxHEIGHT", [](auto& v) { parseSize("--name", v); });
  expectRefused("65535x65535", "2147483647 pixels", [](auto& v) { parseSize("--name", v); });
}

TEST(ParseAngles, takesThreeNumbers) {
  EXPECT_EQ(parseAngles("--name", "-30,0,4.5"), glm::dvec3(-30, 0, 4.5));
  for (const char* value : {"", "1", "1,2", "1,2,3,4", "1,2,", "a,b,c", "1;2;3", "1,nan,2"})
    expectRefused(value, "three angles", [](auto& v) { parseAngles("--name", v); });
}

TEST(ParseCopies, takesThreeCounts) {
  EXPECT_EQ(parseCopies("--name", "3x1x2"), glm::ivec3(3, 1, 2));
  EXPECT_EQ(parseCopies("--name", "100X100x100"), glm::ivec3(100));
  for (const char* value :
       {"", "2", "2x2", "0x1x1", "-1x1x1", "101x100x100", "1x1x1x1", "2000000000x2000000000x4"})
    expectRefused(value, "NxMxK", [](auto& v) { parseCopies("--name", v); });
}

TEST(ColorFromHex, takesThreeOrSixDigits) {
  EXPECT_EQ(colorFromHex("#1a2B3c"), Rgb{0x1A2B3C});
  EXPECT_EQ(colorFromHex("1a2b3c"), Rgb{0x1A2B3C});
  EXPECT_EQ(colorFromHex("#f80"), Rgb{0xFF8800});
  EXPECT_EQ(colorFromHex("000"), Rgb{0x000000});
  for (const char* value : {"", "#", "#12", "#1234", "#1234567", "#gggggg", "#-12345", "##123456", "+12345"})
    EXPECT_FALSE(colorFromHex(value)) << value;
}

TEST(ParseColoring, takesSchemesAndColors) {
  EXPECT_EQ(parseColoring("--name", "bfactor").scheme, ColorScheme::bFactor);
  EXPECT_EQ(parseColoring("--name", "Chain").scheme, ColorScheme::chain);
  const Coloring uniform = parseColoring("--name", "#f00");
  EXPECT_EQ(uniform.scheme, ColorScheme::uniform);
  EXPECT_EQ(uniform.uniform, Rgb{0xFF0000});
  expectRefused("mauve", "element, chain, residue, bfactor, plddt, rainbow or a colour",
                [](auto& v) { parseColoring("--name", v); });
}

TEST(ParseBackground, takesNamesAndColors) {
  EXPECT_EQ(parseBackground("--name", "white").color, Rgb{0xFFFFFF});
  EXPECT_EQ(parseBackground("--name", "black").color, Rgb{0x000000});
  EXPECT_TRUE(parseBackground("--name", "transparent").transparent);
  EXPECT_EQ(parseBackground("--name", "#123456").color, Rgb{0x123456});
  expectRefused("none", "white, black, transparent", [](auto& v) { parseBackground("--name", v); });
}

TEST(ParseOrientation, takesAxesAndQuaternions) {
  EXPECT_EQ(parseOrientation("--name", "principal").kind, Orientation::Kind::principal);
  const Orientation axis = parseOrientation("--name", "Y");
  EXPECT_EQ(axis.kind, Orientation::Kind::axis);
  EXPECT_EQ(axis.axis, 1);
  const Orientation free = parseOrientation("--name", "0,0,-2,0");
  EXPECT_EQ(free.kind, Orientation::Kind::quaternion);
  EXPECT_EQ(free.quaternion, glm::dquat(0, 0, -1, 0));
  for (const char* value : {"", "w", "1,2,3", "0,0,0,0", "1,0,0,inf", "1,0,0,0,0"})
    expectRefused(value, "quaternion W,X,Y,Z", [](auto& v) { parseOrientation("--name", v); });
}

TEST(ParseAltloc, takesFirstAllOrALetter) {
  StructureOptions options;
  parseAltloc("--name", "first", options);
  EXPECT_EQ(options.altlocs, Altlocs::first);
  parseAltloc("--name", "all", options);
  EXPECT_EQ(options.altlocs, Altlocs::all);
  parseAltloc("--name", "b", options);
  EXPECT_EQ(options.altlocs, Altlocs::named);
  EXPECT_EQ(options.altloc, 'b');
  for (const char* value : {"", " ", "AB"})
    expectRefused(value, "first, all or the letter", [](auto& v) {
      StructureOptions o;
      parseAltloc("--name", v, o);
    });
}

TEST(ParseModel, takesANumberOrAll) {
  StructureOptions options;
  parseModel("--name", "all", options);
  EXPECT_TRUE(options.allModels);
  parseModel("--name", "12", options);
  EXPECT_FALSE(options.allModels);
  EXPECT_EQ(options.model, 12);
  for (const char* value : {"", "x", "1.5", "1,2"})
    expectRefused(value, "a model number", [](auto& v) {
      StructureOptions o;
      parseModel("--name", v, o);
    });
}

TEST(ParseChoice, ignoresCaseAndKindOfDash) {
  const auto parse = [](const std::string& v) {
    return parseChoice<int>("--name", v, {{"ball_and_stick", 1}, {"licorice", 2}, {"spacefill", 3}});
  };
  EXPECT_EQ(parse("ball-and-stick"), 1);
  EXPECT_EQ(parse("Licorice"), 2);
  expectRefused("cartoon", "ball_and_stick, licorice or spacefill", parse);
  expectRefused("", "ball_and_stick, licorice or spacefill", parse);
}

}  // namespace
}  // namespace meniscus
