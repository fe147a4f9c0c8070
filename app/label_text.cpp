#include "app/label_text.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_STROKER_H

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr const char* kFonts[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/local/share/fonts/dejavu/DejaVuSans.ttf"};
constexpr double kSeam = 0.09;  // width of the seam around letters, of their height
constexpr int kLargest = 8192;  // sides of a label [pixels]

class Library {
 public:
  Library() {
    if (FT_Init_FreeType(&library_) != 0) throw InputError("FreeType does not start");
  }
  ~Library() { FT_Done_FreeType(library_); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  FT_Library get() const { return library_; }

 private:
  FT_Library library_ = nullptr;
};

/// Reads the next character of UTF-8; what is none becomes U+FFFD.
char32_t nextCharacter(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80       ? 1
                             : first >> 5 == 6  ? 2
                             : first >> 4 == 14 ? 3
                             : first >> 3 == 30 ? 4
                                                : 0;
  if (length == 0 || length > text.size()) {
    text.remove_prefix(1);
    return 0xFFFD;
  }
  char32_t code = length == 1 ? first : first & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3Fu);
  text.remove_prefix(length);
  return code;
}

/// Draws lines of text with one face.
class Writer {
 public:
  Writer(const std::filesystem::path& font, double pixels) {
    const char* path = font.c_str();
    FT_Error error = font.empty() ? 1 : FT_New_Face(library_.get(), path, 0, &face_);
    for (std::size_t i = 0; font.empty() && error != 0 && i < std::size(kFonts); ++i)
      error = FT_New_Face(library_.get(), kFonts[i], 0, &face_);
    if (error != 0)
      throw InputError(font.empty()
                           ? std::string("labels need the font DejaVu Sans (package fonts-dejavu-core); "
                                         "install it, or name a font with --label-font")
                           : fmt::format("{}: is no font that FreeType reads", path));
    FT_Size_RequestRec request{};
    request.type = FT_SIZE_REQUEST_TYPE_REAL_DIM;  // ascender to descender
    request.height = static_cast<FT_Long>(std::lround(pixels * 64));
    if (FT_Request_Size(face_, &request) != 0 || FT_Stroker_New(library_.get(), &stroker_) != 0) {
      FT_Done_Face(face_);
      throw InputError(fmt::format("the labels' font has no letters {} pixels high", pixels));
    }
    seam_ = std::max(kSeam * pixels, 1.0);
    FT_Stroker_Set(stroker_, static_cast<FT_Fixed>(std::lround(seam_ * 64)), FT_STROKER_LINECAP_ROUND,
                   FT_STROKER_LINEJOIN_ROUND, 0);
  }
  ~Writer() {
    FT_Stroker_Done(stroker_);
    FT_Done_Face(face_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  LabelSprite draw(const Label& label);

 private:
  enum class Ink { text, seam };
  double widthOf(std::string_view line);
  void drawLine(std::string_view line, double x, double baseline, LabelSprite& sprite);
  void blend(FT_Glyph glyph, FT_Vector origin, Ink ink, LabelSprite& sprite);

  Library library_;
  FT_Face face_ = nullptr;
  FT_Stroker stroker_ = nullptr;
  double seam_ = 1;
};

constexpr FT_Int32 kLoad = FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP;

double Writer::widthOf(std::string_view line) {
  double width = 0;
  while (!line.empty())
    if (FT_Load_Char(face_, nextCharacter(line), kLoad) == 0)
      width += static_cast<double>(face_->glyph->linearHoriAdvance) / 65536.0;
  return width;
}

// Glyphs are drawn at their place to a 64th of a pixel, which keeps the distances between letters even.
void Writer::blend(FT_Glyph glyph, FT_Vector origin, Ink ink, LabelSprite& sprite) {
  FT_Glyph bitmapGlyph = glyph;
  if (FT_Glyph_To_Bitmap(&bitmapGlyph, FT_RENDER_MODE_NORMAL, &origin, 0) != 0) return;
  const auto* drawn = reinterpret_cast<FT_BitmapGlyph>(bitmapGlyph);
  const FT_Bitmap& bitmap = drawn->bitmap;
  for (unsigned row = 0; row < bitmap.rows; ++row) {
    for (unsigned column = 0; column < bitmap.width; ++column) {
      const int x = drawn->left + static_cast<int>(column);
      const int y = sprite.height - drawn->top + static_cast<int>(row);
      if (x < 0 || y < 0 || x >= sprite.width || y >= sprite.height) continue;
      LabelTexel& texel = sprite.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(sprite.width) +
                                        static_cast<std::size_t>(x)];
      const unsigned char value =
          bitmap.buffer[static_cast<int>(row) * bitmap.pitch + static_cast<int>(column)];
      std::uint8_t& target = ink == Ink::text ? texel.text : texel.seam;
      target = std::max(target, value);
    }
  }
  FT_Done_Glyph(bitmapGlyph);
}

// `baseline` is counted from the sprite's lower edge.
void Writer::drawLine(std::string_view line, double x, double baseline, LabelSprite& sprite) {
  while (!line.empty()) {
    if (FT_Load_Char(face_, nextCharacter(line), kLoad) != 0) continue;
    const double advance = static_cast<double>(face_->glyph->linearHoriAdvance) / 65536.0;
    const FT_Vector origin{std::lround(x * 64), std::lround(baseline * 64)};
    FT_Glyph glyph = nullptr;
    if (FT_Get_Glyph(face_->glyph, &glyph) == 0) {
      blend(glyph, origin, Ink::text, sprite);
      blend(glyph, origin, Ink::seam, sprite);
      FT_Glyph seam = glyph;
      if (FT_Glyph_StrokeBorder(&seam, stroker_, 0, 0) == 0) {
        blend(seam, origin, Ink::seam, sprite);
        FT_Done_Glyph(seam);
      }
      FT_Done_Glyph(glyph);
    }
    x += advance;
  }
}

LabelSprite Writer::draw(const Label& label) {
  std::vector<std::string_view> lines;
  std::string_view rest = label.text;
  for (;;) {
    const std::size_t end = rest.find('\n');
    lines.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  const FT_Size_Metrics& metrics = face_->size->metrics;
  const double ascent = static_cast<double>(metrics.ascender) / 64,
               descent = -static_cast<double>(metrics.descender) / 64;
  const double spacing = ascent + descent;
  std::vector<double> widths;
  for (const std::string_view line : lines) widths.push_back(widthOf(line));
  const double widest = *std::max_element(widths.begin(), widths.end());
  const double margin = std::ceil(seam_) + 1;

  LabelSprite sprite;
  sprite.label = label;
  const double width = std::ceil(widest + 2 * margin);
  const double height = std::ceil(spacing * static_cast<double>(lines.size()) + 2 * margin);
  if (width > kLargest || height > kLargest)
    throw InputError(
        fmt::format("the label '{:.40}' would be {} by {} pixels; shorten it, or make it smaller", label.text,
                    width, height));
  sprite.width = static_cast<int>(width);
  sprite.height = static_cast<int>(height);
  sprite.texels.resize(static_cast<std::size_t>(sprite.width) * static_cast<std::size_t>(sprite.height));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double baseline = height - margin - ascent - spacing * static_cast<double>(i);
    drawLine(lines[i], (width - widths[i]) / 2, std::round(baseline), sprite);
  }
  return sprite;
}

}  // namespace

std::vector<LabelSprite> drawLabels(const std::vector<Label>& labels, double pixels,
                                    const std::filesystem::path& font) {
  std::vector<LabelSprite> sprites;
  if (labels.empty()) return sprites;
  Writer writer(font, pixels);
  for (const Label& label : labels) {
    LabelSprite sprite = writer.draw(label);
    if (!label.text.empty()) sprites.push_back(std::move(sprite));
  }
  return sprites;
}

}  // namespace meniscus
