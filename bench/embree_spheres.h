#pragma once
// The same spheres and rays by Embree: what a ray tracer for the processor takes, for comparison.

#include <memory>
#include <vector>

#include "core/primitives.h"
#include "core/view.h"

namespace meniscus::bench {

class EmbreeSpheres {
 public:
  explicit EmbreeSpheres(const Primitives& primitives);
  ~EmbreeSpheres();
  EmbreeSpheres(const EmbreeSpheres&) = delete;
  EmbreeSpheres& operator=(const EmbreeSpheres&) = delete;
  /// The hierarchy.
  void build();
  /// A ray through every pixel's centre, eight at a time, on all processors.
  void cast(const View& view);
  const std::vector<float>& distances() const {
    return distance_;
  }  ///< rows from the bottom; infinity = none

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  glm::dvec3 origin_;
  std::vector<float> distance_;
};

}  // namespace meniscus::bench
