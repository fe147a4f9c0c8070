// OpenEXR scan lines through libOpenEXR, ZIP compressed: R, G, B and A (if wanted) in linear light,
// premultiplied, as half floats if they are alone; with other layers every channel has 32 bits, under the
// names that compositing programs know (docs/methods.md, "Layers"). OpenEXR writes its table of line offsets
// last, so the file must be one that can seek.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <cerrno>
#include <cstring>
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

/// One channel of the file, and where its values lie within a pixel of the rows.
struct ExrChannel {
  const char* name;
  std::size_t offset;
  Imf::PixelType stored;
  bool whole = false;  // the rows hold std::uint32_t instead of float
};

std::vector<ExrChannel> channelsOf(const ImageFileOptions& options) {
  const Layers& layers = options.layers;
  const Imf::PixelType colorType = layers.data() ? Imf::FLOAT : Imf::HALF;
  std::vector<ExrChannel> channels;
  std::size_t offset = 0;
  const auto add = [&](const char* name, Imf::PixelType type) {
    channels.push_back({name, offset, type});
    offset += sizeof(float);
  };
  if (layers.color) {
    for (const char* name : {"R", "G", "B", "A"}) add(name, colorType);
    if (!options.alpha) channels.pop_back();
  }
  if (layers.albedo)
    for (const char* name : {"albedo.R", "albedo.G", "albedo.B"}) add(name, Imf::FLOAT);
  if (layers.normal)
    for (const char* name : {"N.X", "N.Y", "N.Z"}) add(name, Imf::FLOAT);
  if (layers.depth) add("Z", Imf::FLOAT);
  if (layers.distance) add("distance", Imf::FLOAT);
  if (layers.id) {
    add("id", options.wideIds ? Imf::UINT : Imf::FLOAT);
    channels.back().whole = true;
  }
  return channels;
}

// A value as it lies in the rows, as the file holds it.
void convert(const ExrChannel& channel, const std::byte* from, std::byte* to) {
  if (channel.whole && channel.stored == Imf::FLOAT) {
    std::uint32_t number = 0;
    std::memcpy(&number, from, sizeof(number));
    const auto value = static_cast<float>(number);
    std::memcpy(to, &value, sizeof(value));
  } else if (channel.stored == Imf::HALF) {
    float value = 0;
    std::memcpy(&value, from, sizeof(value));
    const half narrow(value);
    std::memcpy(to, &narrow, sizeof(narrow));
  } else {
    std::memcpy(to, from, sizeof(float));
  }
}

class ExrFile final : public ImageFile {
 public:
  ExrFile(const std::filesystem::path& path, const ImageFileOptions& options);
  void writeRows(std::span<const std::byte> rows) override;
  void finish() override;

 private:
  // OpenEXR wraps or swallows what a stream throws; OutputFile remembers it.
  template <typename Action>
  void guarded(Action action);

  OutputFile file_;
  FileStream stream_;
  std::optional<Imf::OutputFile> exr_;
  std::size_t width_;
  std::size_t written_ = 0, height_;
  std::vector<ExrChannel> channels_;
  std::size_t pixelBytes_;
  std::vector<std::byte> values_;  // of the rows at hand, channel by channel
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
      channels_(channelsOf(options)),
      pixelBytes_(bytesPerPixel({options.format, options.layers})) {
  MENISCUS_CHECK(options.format == PixelFormat::rgbaFloat);
  Imf::Header header(options.size.width, options.size.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const ExrChannel& channel : channels_)
    header.channels().insert(channel.name, Imf::Channel(channel.stored));
  if (options.dpi > 0) Imf::addXDensity(header, static_cast<float>(options.dpi));
  for (const auto& [key, value] : options.metadata) header.insert(key, Imf::StringAttribute(value));
  guarded([&] { exr_.emplace(stream_, header); });
}

void ExrFile::writeRows(std::span<const std::byte> rows) {
  const std::size_t count = rows.size() / (width_ * pixelBytes_);
  MENISCUS_CHECK(count * width_ * pixelBytes_ == rows.size() && written_ + count <= height_);
  const std::size_t planeBytes = count * width_ * sizeof(float);
  values_.resize(channels_.size() * planeBytes);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const ExrChannel& channel = channels_[c];
    std::byte* plane = values_.data() + c * planeBytes;
    const std::size_t bytes = channel.stored == Imf::HALF ? sizeof(half) : sizeof(float);
    for (std::size_t i = 0; i < count * width_; ++i)
      convert(channel, rows.data() + i * pixelBytes_ + channel.offset, plane + i * bytes);
    // OpenEXR addresses a pixel as base + y * rowStride with y counted from the top of the whole picture.
    const std::size_t rowStride = width_ * bytes;
    frame.insert(
        channel.name,
        Imf::Slice(channel.stored, reinterpret_cast<char*>(plane) - written_ * rowStride, bytes, rowStride));
  }
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
