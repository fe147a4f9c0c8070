#pragma once
// Pictures that follow each other: turntables, and films written by ffmpeg.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "app/output_name.h"
#include "app/picture.h"
#include "core/image.h"

namespace meniscus {

/// Whether an output is a film by its name: .mp4, .webm or .gif.
bool isFilm(const std::filesystem::path& output);

/// Throws UsageError if the pictures of a turntable would have one name, or {frame} has no meaning.
void requireFilmNames(const RenderOptions& options, const OutputPattern& pattern);

/// Makes a picture the one of that number of a turntable, and names it.
void turn(Picture& picture, int frame, const RenderOptions& options, const OutputPattern& pattern);

/// A film under construction: frames go as raw pixels to ffmpeg, which must be installed. Written under a
/// temporary name and renamed by finish(); destroyed before, it leaves nothing.
class FilmFile : public RowSink {
 public:
  /// Throws UsageError if there is no ffmpeg, InputError if it cannot be started or the file not be written.
  FilmFile(const std::filesystem::path& path, ImageSize size, double framesPerSecond);
  ~FilmFile() override;
  void writeRows(std::span<const std::byte> rows) override;
  /// Waits for ffmpeg. Throws InputError if it fails.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus
