// OpenEXR scan lines through libOpenEXR: half-float channels R, G, B and A (if wanted), linear light,
// premultiplied, ZIP compressed. OpenEXR writes its table of line offsets last, so the file must be one that
// can seek.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <array>
#include <cerrno>
#include <optional>
#include <vector>

#include "core/error.h"
#include "io/image_files.h"
#include "io/output_file.h"

namespace meniscus {
namespace {

/// OpenEXR's door to an OutputFile; reports the file system's own errors.
class FileStream final : public Imf::OStream {
 public:
  explicit FileStream(OutputFile& file) : Imf::OStream(file.path().c_str()), file_(file) {
    if (std::fseek(file.stream(), 0, SEEK_SET) != 0)
      throw InputError("cannot write '" + file.path().string() +
                       "': OpenEXR cannot be written to a pipe; write to a file, or write a .png");
  }
  void write(const char bytes[], int count) override {
    file_.write({bytes, static_cast<std::size_t>(count)});
  }
  std::uint64_t tellp() override { return static_cast<std::uint64_t>(ftello(file_.stream())); }
  void seekp(std::uint64_t position) override { file_.seek(position); }

 private:
  OutputFile& file_;
};

class ExrFile final : public ImageFile {
 public:
  ExrFile(const std::filesystem::path& path, const ImageFileOptions& options);
  void writeRows(std::span<const std::byte> rows) override;
  void finish() override;

 private:
  static constexpr std::size_t kChannels = 4;
  static constexpr std::array<const char*, kChannels> kChannelNames{"R", "G", "B", "A"};

  // OpenEXR wraps or swallows what a stream throws; OutputFile remembers it.
  template <typename Action>
  void guarded(Action action);

  OutputFile file_;
  FileStream stream_;
  std::optional<Imf::OutputFile> exr_;
  std::size_t width_;
  std::size_t written_ = 0, height_;
  std::size_t channelCount_;
  std::vector<half> pixels_;
};

template <typename Action>
void ExrFile::guarded(Action action) {
  try {
    action();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    if (file_.failure() != 0) throwWriteError(file_.path(), file_.failure());
    throw InputError("cannot write '" + file_.path().string() + "': OpenEXR: " + error.what());
  }
}

ExrFile::ExrFile(const std::filesystem::path& path, const ImageFileOptions& options)
    : file_(path),
      stream_(file_),
      width_(static_cast<std::size_t>(options.size.width)),
      height_(static_cast<std::size_t>(options.size.height)),
      channelCount_(options.alpha ? kChannels : kChannels - 1) {
  MENISCUS_CHECK(options.format == PixelFormat::rgbaFloat);
  Imf::Header header(options.size.width, options.size.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (std::size_t c = 0; c < channelCount_; ++c)
    header.channels().insert(kChannelNames[c], Imf::Channel(Imf::HALF));
  if (options.dpi > 0) Imf::addXDensity(header, static_cast<float>(options.dpi));
  for (const auto& [key, value] : options.metadata) header.insert(key, Imf::StringAttribute(value));
  guarded([&] { exr_.emplace(stream_, header); });
}

void ExrFile::writeRows(std::span<const std::byte> rows) {
  const std::size_t rowFloats = width_ * kChannels;
  const std::size_t count = rows.size() / (rowFloats * sizeof(float));
  MENISCUS_CHECK(count * rowFloats * sizeof(float) == rows.size() && written_ + count <= height_);
  const auto* values = reinterpret_cast<const float*>(rows.data());
  pixels_.assign(values, values + count * rowFloats);

  // OpenEXR addresses a pixel as base + y * rowStride with y counted from the top of the whole picture.
  const std::size_t rowStride = rowFloats * sizeof(half);
  char* base = reinterpret_cast<char*>(pixels_.data()) - written_ * rowStride;
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channelCount_; ++c)
    frame.insert(kChannelNames[c],
                 Imf::Slice(Imf::HALF, base + c * sizeof(half), kChannels * sizeof(half), rowStride));
  guarded([&] {
    exr_->setFrameBuffer(frame);
    exr_->writePixels(static_cast<int>(count));
  });
  written_ += count;
}

void ExrFile::finish() {
  MENISCUS_CHECK(written_ == height_);
  exr_.reset();
  file_.commit();
}

}  // namespace

std::unique_ptr<ImageFile> createExrFile(const std::filesystem::path& path, const ImageFileOptions& options) {
  return std::make_unique<ExrFile>(path, options);
}

}  // namespace meniscus
