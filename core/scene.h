#pragma once
// What is to be seen: molecules and how they are drawn, light, background, camera. No GPU objects, no
// window state, no files.

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/assembly.h"
#include "core/elements.h"
#include "core/metaball_field.h"
#include "core/molecule.h"
#include "core/view.h"

namespace meniscus {

using Rgb = std::uint32_t;  ///< 0xRRGGBB, sRGB

enum class Representation : std::uint8_t {
  spacefill,     ///< van der Waals spheres
  ballAndStick,  ///< small spheres and thin cylinders
  licorice,      ///< cylinders with rounded ends
  ellipsoids,    ///< displacement ellipsoids and thin cylinders (ORTEP)
  surface,       ///< molecular surface: the metaball field of all atoms
  cartoon,       ///< ribbons along the backbones of proteins and nucleic acids
  backbone,      ///< sticks from one residue to the next
  putty          ///< tubes along the backbones, thick where the B factor is large
};

enum class ColorScheme : std::uint8_t { element, chain, residue, bFactor, plddt, rainbow, uniform };

struct Coloring {
  ColorScheme scheme = ColorScheme::element;
  Rgb uniform = 0xCCCCCC;       ///< for ColorScheme::uniform
  bool carbonsByChain = false;  ///< with element: carbons take their chain's colour
};

/// A molecular surface: a metaball per atom, of coefficient 1.
struct SurfaceShape {
  Kernel kernel;
  double blend = 2;  ///< support as a multiple of the van der Waals radius, > 1; larger is smoother
  std::optional<double> level;  ///< nothing = a lone atom shows its van der Waals radius
};

/// One molecule, or some of its atoms, in one representation, at one or more places.
struct SceneObject {
  std::shared_ptr<const Molecule> molecule;
  std::vector<std::uint32_t> atoms;   ///< that are drawn, ascending indices; empty = all
  std::vector<Placement> placements;  ///< see placeOnce, placeAssembly, replicate
  Representation representation = Representation::spacefill;
  Coloring coloring;
  std::vector<Rgb> colors;  ///< one for each atom of the molecule, instead of `coloring`; or empty
  RadiusSet radii = RadiusSet::bondi;
  double radiusScale = 1;        ///< of van der Waals radii (space-filling, surface)
  double ballScale = 0.25;       ///< ball radius as a share of the van der Waals radius (ball and stick)
  double stickRadius = 0.15;     ///< cylinder radius [Å], ball and stick
  double licoriceRadius = 0.25;  ///< cylinder and sphere radius [Å], licorice
  double ellipsoidStickRadius = 0.06;  ///< cylinder radius [Å], ellipsoids
  double ribbonScale = 1;              ///< of all widths of cartoon, backbone and putty
  double probability = 0.5;            ///< that an atom is inside its ellipsoid, 0 < p < 1
  SurfaceShape surface;
};

/// A line of text in the picture, centred on the point of a sphere that is nearest to the viewer: what lies
/// before that point hides it, what lies in the sphere does not.
struct Label {
  std::string text;  ///< UTF-8
  glm::dvec3 center{0.0};
  double radius = 0;  ///< of the sphere [Å]
};

/// A dashed line between two points [Å, world], as thick as it is; an id of its own.
struct DashedLine {
  glm::dvec3 from{0.0}, to{0.0};
  Rgb color = 0x000000;
  double radius = 0.06;
};

/// Light from infinity, fixed to the viewer.
struct DirectionalLight {
  glm::dvec3 direction{0, 0, -1};  ///< the way the light travels, view space; need not be unit length
  double intensity = 0;
};

/// Key, fill and ambient light, and the highlight of the key light (Blinn-Phong), in linear light.
struct Lighting {
  DirectionalLight key{{0.45, -0.6, -0.8}, 0.76};
  DirectionalLight fill{{-0.7, 0.25, -0.6}, 0.16};
  double ambient = 0.12;
  double specular = 0.16;
  double shininess = 60;
};

/// Light for ambient occlusion: most of it comes from all around, or occlusion would hardly show. As bright
/// as the default on what nothing occludes.
inline Lighting ambientLighting() {
  Lighting lighting;
  lighting.key.intensity = 0.34;
  lighting.fill.intensity = 0.10;
  lighting.ambient = 0.62;
  return lighting;
}

struct Background {
  Rgb color = 0xFFFFFF;
  bool transparent = false;
};

struct Scene {
  std::vector<SceneObject> objects;
  std::vector<Label> labels;
  std::vector<DashedLine> dashes;
  Lighting lighting;
  Background background;
  Camera camera;
};

}  // namespace meniscus
