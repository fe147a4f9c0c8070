#pragma once
// What was drawn and where it is wrong, as pictures and as data.

#include <filesystem>
#include <functional>

#include "core/hit_image.h"
#include "core/primitives.h"
#include "core/reference_tracer.h"

namespace meniscus::measure {

/// A PNG, at most about 1000 pixels wide: on the left what was drawn, on the right the error in false colour
/// (kErrorLegend); where it is made smaller, the worst of some pixels is shown.
void writeErrorPicture(const std::filesystem::path& path, const HitImage& image, const ReferenceImage& truth,
                       const Primitives& primitives);

/// A PNG of the same size, lit from the eye: the same for the same distances, normals and ids, whoever found
/// them.
void writeShaded(const std::filesystem::path& path, const HitImage& image, const Primitives& primitives);

/// Normal, distance and id as an OpenEXR file.
void writeLayers(const std::filesystem::path& path, const HitImage& image);
/// Grazing pixels white, the others black.
void writeGrazing(const std::filesystem::path& path, const ReferenceImage& truth);

struct LegendEntry {
  std::uint32_t color;
  const char* meaning;
};
/// The false colours, the scale by its decades.
std::vector<LegendEntry> errorLegend();

}  // namespace meniscus::measure
