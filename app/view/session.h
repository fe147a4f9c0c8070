#pragma once
// What `meniscus view` shows, without a window: files, the options of `meniscus render` that say how each is
// drawn, a camera, and what was picked. The options are all there is to a look, so what they mean is what
// render draws of them, undoing is going back to those before, and the command that draws the same can be
// written down.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/settings.h"
#include "core/image.h"
#include "core/primitives.h"
#include "core/scene.h"
#include "core/view.h"

namespace meniscus {

/// An atom that was clicked.
struct Pick {
  std::string cid;   ///< that selects it and no other atom of its molecule
  std::string name;  ///< for people: "ALA 12 CA, chain A"
  glm::dvec3 position{0.0};
  bool copy = false;         ///< it belongs to another placement of its molecule than the first
  std::size_t molecule = 0;  ///< its number in objectsByMolecule()
};

/// Of each molecule of a scene, the first object that shows it.
std::vector<const SceneObject*> objectsByMolecule(const Scene& scene);

/// The atoms that were picked, in the scene as it is now: those that it no longer has go, and others may have
/// moved.
void updatePicks(std::vector<Pick>& picks, const Scene& scene);

/// A CID for an atom of a molecule, and its name. An empty CID if none tells it from all others.
std::string cidOf(const Molecule& molecule, std::uint32_t atom);
std::string nameOf(const Molecule& molecule, std::uint32_t atom);

/// Representations in the order in which they are offered.
inline constexpr std::array<Representation, 8> kRepresentationsOffered{
    Representation::spacefill, Representation::ballAndStick, Representation::licorice,
    Representation::cartoon,   Representation::surface,      Representation::backbone,
    Representation::putty,     Representation::ellipsoids};

/// A file that is open, and how it is drawn.
class Document {
 public:
  /// A scene if `isScene` says so or the name does (.mvsj, .mvsx).
  Document(std::string file, GivenOptions given, bool isScene = false);

  const std::string& file() const { return file_; }
  bool isScene() const { return scene_; }

  // --- Options, by name without "--". All but those about the camera can be undone.
  const GivenOptions& given() const { return given_; }
  /// The last value; nothing if it is not given.
  std::optional<std::string> value(std::string_view option) const;
  std::vector<std::string> values(std::string_view option) const;
  bool has(std::string_view option) const { return value(option).has_value(); }
  /// Replaces all values of an option by one. While `goesOn` (a slider that is being dragged), changes of the
  /// same option are undone together.
  void set(const std::string& option, const std::string& value, bool goesOn = false);
  /// Replaces all values of an option that may be repeated; `goesOn` as above.
  void setAll(const std::string& option, const std::vector<std::string>& values, bool goesOn = false);
  void remove(std::string_view option);
  /// Several changes as one step.
  void replace(GivenOptions given);
  bool undo();
  bool redo();
  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  /// Ends a run of changes that are undone together.
  void endChange() { open_.clear(); }
  /// Counts every change of options.
  std::uint64_t revision() const { return revision_; }

  // --- Where it is seen from.
  /// Nothing: as the options say, which is what reset gives.
  std::optional<Camera> camera;

  // --- Models of a structure or states of a scene that are shown one at a time.
  bool oneByOne = false;
  std::size_t shown = 0;  ///< index among them

  std::vector<Pick> picks;  ///< at most four
  /// A fifth begins anew; an atom that is picked already is let go.
  void pick(Pick pick);
  /// --measure for what is picked; nothing unless two to four are, all of the first placement of the first
  /// molecule.
  std::optional<std::string> measureOption() const;

 private:
  void changed(std::string_view option, bool goesOn);

  std::string file_;
  bool scene_;
  GivenOptions given_;
  std::vector<GivenOptions> undo_, redo_;
  std::string open_;  // option whose changes go on
  std::uint64_t revision_ = 1;
};

/// The arguments after `meniscus render` that draw what is shown: the file, `output`, and all options, the
/// camera to the last digit. `model` is the number of the model that is shown, if it is one of several.
std::vector<std::string> renderArguments(const Document& document, const std::optional<Camera>& camera,
                                         ImageSize size, const std::string& output,
                                         std::optional<int> model = {});

/// The same as one would type it.
std::string commandLine(const std::vector<std::string>& arguments);

/// A camera in place of a scene's own: the planes that only the scene's has are where they cut nothing,
/// because no option takes them away.
Camera inPlaceOf(const Camera& own, Camera camera);

/// What the options become in the viewer: as renderArguments(), but of all models or states if they are shown
/// one by one, and without a camera.
std::vector<std::string> preparationArguments(const Document& document, ImageSize size);

}  // namespace meniscus
