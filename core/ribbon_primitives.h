#pragma once
// Objects that are drawn by their backbones: cartoon, putty and backbone.

#include <vector>

#include "core/backbone.h"
#include "core/primitives.h"
#include "core/ribbon.h"

namespace meniscus {

/// Whether a representation is drawn from backbones, not atom by atom.
bool followsBackbone(Representation representation);

/// By atom, of an object that follows the backbone: the radius about a trace atom that holds what is drawn
/// there [Å]; negative for all other atoms.
std::vector<double> backboneReach(const SceneObject& object);

class BackboneObject {
 public:
  /// Nothing if the representation does not follow the backbone. `object` must outlive it.
  explicit BackboneObject(const SceneObject& object);

  /// Adds one placement; `colors` by atom, `firstId` the id of the molecule's first atom.
  void addPlacement(const Placement& placement, const std::vector<Rgb>& colors, std::uint32_t firstId,
                    Primitives& out) const;

 private:
  void addRibbon(const Placement& placement, const std::vector<bool>& placed, const std::vector<Rgb>& colors,
                 std::uint32_t firstId, Primitives& out) const;
  void addTrace(const Placement& placement, const std::vector<bool>& placed, const std::vector<Rgb>& colors,
                std::uint32_t firstId, Primitives& out) const;

  const SceneObject& object_;
  std::vector<bool> chosen_;  // by atom; empty = all
  std::vector<Backbone> backbones_;
  Ribbon ribbon_;
};

}  // namespace meniscus
