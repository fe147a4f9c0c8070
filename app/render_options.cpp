#include "app/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <sstream>

#include "app/command_line.h"
#include "app/film.h"
#include "app/scene/settings.h"
#include "app/style.h"
#include "core/error.h"
#include "core/render_settings.h"
#include "core/text.h"
#include "io/environment_file.h"
#include "io/image_writer.h"
#include "io/mesh_file.h"
#include "io/output_file.h"
#include "render/surface_method.h"

namespace meniscus {
namespace {

constexpr const char* kDescription =
    "Draws structure files (PDB, mmCIF, plain or .gz, BinaryCIF) as pictures. Needs no display and no GPU.\n";

constexpr const char* kExamples =
    "  meniscus render 1crn.pdb -o crambin.png\n"
    "  meniscus render 4hhb.cif.gz -o heme.png --representation ball_and_stick \\\n"
    "      --carbons chain --focus '(HEM)' --size 1920x1080 --background transparent\n"
    "  meniscus render models/*.pdb -o 'pictures/{stem}-{model}.png' --model all --color rainbow\n";

constexpr std::array<std::string_view, 20> kNotForThePicture{
    "output",   "stats",  "explain",    "quiet",      "backend", "quadrics", "shader-dir",
    "help",     "scene",  "strict",     "save-scene", "offline", "cache",    "jobs",
    "manifest", "resume", "time-limit", "turntable",  "fps",     "export"};

/// Adds the options of a group to a parser; each hands its text to a function of its own.
class OptionGroup {
 public:
  OptionGroup(CLI::App& app, std::string title) : app_(app), title_(std::move(title)) {}

  using Setter = std::function<void(const std::string& option, const std::string& value)>;

  void value(const std::string& names, const std::string& form, const std::string& help, Setter set) {
    const std::string option = longName(names);
    app_.add_option_function<std::string>(
            names, [option, set](const std::string& text) { set(option, text); }, help)
        ->type_name(form)
        ->group(title_)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  }
  /// An option that may be given several times; `set` gets each value.
  void values(const std::string& names, const std::string& form, const std::string& help, Setter set) {
    const std::string option = longName(names);
    app_.add_option_function<std::vector<std::string>>(
            names,
            [option, set](const std::vector<std::string>& texts) {
              for (const std::string& text : texts) set(option, text);
            },
            help)
        ->type_name(form)
        ->group(title_)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
  void flag(const std::string& names, const std::string& help, bool& target) {
    app_.add_flag(names, target, help)->group(title_)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  }

 private:
  static std::string longName(const std::string& names) {
    const std::size_t start = names.find("--");
    return names.substr(start, names.find(',', start) - start);
  }

  CLI::App& app_;
  std::string title_;
};

void addOutputOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Picture");
  group.value("-o,--output", "OUT",
              "Name of the picture, .png or .exr. {stem} stands for the\n"
              "input's name, {model} for the model's number",
              [&o](auto&, auto& v) { o.output = v; });
  group.value("--size", "WxH", "Pixels, or one number for a square [1024x768]",
              [&o](auto& n, auto& v) { o.size = parseSize(n, v); });
  group.value("--background", "COLOR", "white, black, transparent or '#RRGGBB' [white]",
              [&o](auto& n, auto& v) { o.background = parseBackground(n, v); });
  group.value("--samples", "N", "Rays per pixel, 1 to 256: more gives smoother edges [16]",
              [&o](auto& n, auto& v) { o.samples = parseInteger(n, v, 1, kMaxSamples); });
  group.value("--level-of-detail", "on|off",
              "Where every atom is less than 0.7 pixels across, a ball may\n"
              "stand for several of them, which covers as much [on]",
              [&o](auto& n, auto& v) {
                o.levelOfDetail = parseChoice<bool>(n, v, {{"on", true}, {"off", false}});
              });
  group.value("--depth", "8|16", "Bits per channel of a PNG [8]; EXR is floating point",
              [&o](auto& n, auto& v) {
                o.bitDepth = parseChoice<int>(n, v, {{"8", 8}, {"16", 16}});
              });
  group.value("--channels", "LIST",
              "What an EXR holds: color, and data of each pixel's centre\n"
              "ray: albedo, normal, depth, distance (Angstrom), id (atom);\n"
              "names separated by commas [color]",
              [&o](auto& n, auto& v) { o.layers = parseLayers(n, v); });
  group.value("--dpi", "N", "Printing resolution recorded in the file, pixels per inch",
              [&o](auto& n, auto& v) { o.dpi = parseNumber(n, v, 1, 100000, "pixels per inch"); });
}

void addPanelOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Panels");
  group.values("--panel", "[LABEL: ]OPTIONS",
               "Two to four pictures in one, seen by one camera; each with\n"
               "options of its own, as in 'skin: --representation surface',\n"
               "or the name of a representation; the third or fourth may be\n"
               "'error': how far the second is from the first, in false\n"
               "colour. May be repeated",
               [&o](auto& n, auto& v) { o.panels.push_back(parsePanel(n, v)); });
  group.value("--divider", "F",
              "Instead of beside each other, two panels lie on both sides of\n"
              "a line through one picture, 0 to 1 of its width",
              [&o](auto& n, auto& v) { o.divider = parseNumber(n, v, 0, 1); });
}

// Methods and their parameters, a line each.
std::string surfaceMethodHelp() {
  std::string help = "How it is computed; all but mesh draw the exact surface [auto]";
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    help += fmt::format("\n{}: {}", method.name, method.summary);
    for (const SurfaceParameter& p : method.parameters)
      help += fmt::format("\n  {}={}: {}", p.name, p.value, p.help);
  }
  return help;
}

void addLabelOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Labels");
  group.values("--label", "CID=TEXT",
               "Write a text at the middle of these atoms (as --select);\n"
               "may be repeated",
               [&o](auto& n, auto& v) { o.labels.push_back(parseLabel(n, v)); });
  group.values("--measure", "CID;CID...",
               "Draw the distance between two groups of atoms, the angle of\n"
               "three or the torsion of four; may be repeated",
               [&o](auto& n, auto& v) { o.measures.push_back(parseMeasure(n, v)); });
  group.value("--label-size", "P", "Height of letters, percent of the picture's height [4]",
              [&o](auto& n, auto& v) { o.labelSize = parseNumber(n, v, 0.1, 100, "percent"); });
  group.value("--label-color,--label-colour", "COLOR", "black, white or '#RRGGBB' [black]",
              [&o](auto& n, auto& v) { o.labelColors.text = parseColor(n, v); });
  group.value("--label-seam", "COLOR", "Colour of the seam around letters [white]",
              [&o](auto& n, auto& v) { o.labelColors.seam = parseColor(n, v); });
  group.value("--label-font", "FILE", "A font that FreeType reads [DejaVu Sans]",
              [&o](auto&, auto& v) { o.labelFont = v; });
}

void addLookOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Look");
  group.value("--representation", "NAME",
              "spacefill (van der Waals spheres), ball_and_stick, licorice,\n"
              "ellipsoids (atomic displacements, as ORTEP draws them),\n"
              "surface (a smooth skin over all atoms), cartoon, backbone or\n"
              "putty (tubes, thick where the B factor is large)\n"
              "[spacefill: it shows any molecule, of any size]",
              [&o](auto& n, auto& v) { o.representation = parseRepresentation(n, v); });
  group.values("--show", "CID=NAME[:SCHEME]",
               "Draw these atoms (as --select) in a way and colours of\n"
               "their own, as in '(HEM)=licorice:element'; may be repeated",
               [&o](auto& n, auto& v) { o.shown.push_back(parseShown(n, v)); });
  group.values("--hide", "CID", "Leave these atoms out of the picture; may be repeated",
               [&o](auto&, auto& v) { o.hidden.push_back(v); });
  group.value("--color,--colour", "SCHEME",
              "element (Jmol), chain, residue (chemical kind), bfactor,\n"
              "plddt (AlphaFold's 90/70/50), rainbow (along each chain)\nor one colour '#RRGGBB' [element]",
              [&o](auto& n, auto& v) {
                const bool carbonsByChain = o.coloring.carbonsByChain;
                o.coloring = parseColoring(n, v);
                o.coloring.carbonsByChain = carbonsByChain;
              });
  group.value("--carbons", "element|chain", "Colour of carbons when colouring by element [element]",
              [&o](auto& n, auto& v) {
                o.coloring.carbonsByChain = parseChoice<bool>(n, v, {{"element", false}, {"chain", true}});
              });
  group.value("--radii", "bondi|alvarez",
              "van der Waals radii: Bondi 1964 (doi 10.1021/j100785a001)\n"
              "or Alvarez 2013 (doi 10.1039/c3dt50599e) [bondi]",
              [&o](auto& n, auto& v) {
                o.radii = parseChoice<RadiusSet>(
                    n, v, {{"bondi", RadiusSet::bondi}, {"alvarez", RadiusSet::alvarez}});
              });
  group.value("--ball-scale", "F", "Radius of a ball as a share of the atom's [0.25]",
              [&o](auto& n, auto& v) { o.ballScale = parseNumber(n, v, 0.01, 10); });
  group.value("--stick-radius", "R", "Radius of sticks in Angstrom [0.15; licorice 0.25;\nellipsoids 0.06]",
              [&o](auto& n, auto& v) { o.stickRadius = parseNumber(n, v, 0.001, 100, "Angstrom"); });
  group.value("--ribbon-scale", "F", "Widths of cartoons, backbones and putty [1]",
              [&o](auto& n, auto& v) { o.ribbonScale = parseNumber(n, v, 0.01, 100); });
  group.value("--probability", "P",
              "How likely an atom is inside its displacement ellipsoid,\nbetween 0 and 1 [0.5]",
              [&o](auto& n, auto& v) { o.probability = parseProbability(n, v); });
}

void addSurfaceOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Surface");
  group.value("--blend", "S",
              "How smooth: an atom's reach as a multiple of its van der\n"
              "Waals radius, 1.05 to 10 [2]",
              [&o](auto& n, auto& v) { o.surfaceShape.blend = parseNumber(n, v, 1.05, 10); });
  group.value("--kernel", "NAME",
              "sextic (Wyvill), quartic (POV-Ray's blob) or power:N, N from\n"
              "2 to 16 [sextic]",
              [&o](auto& n, auto& v) { o.surfaceShape.kernel = parseKernel(n, v); });
  group.value("--level", "T",
              "The field's value on the surface; smaller is thicker\n"
              "[a lone atom shows its van der Waals radius]",
              [&o](auto& n, auto& v) { o.surfaceShape.level = parseNumber(n, v, 1e-6, 1e6); });
  group.value("--opacity", "F",
              "Of the surface, 0 to 1; below 1 one sees through it, and it\n"
              "is drawn by lists: four layers in order, the rest merged [1]",
              [&o](auto& n, auto& v) { o.surface.opacity = parseNumber(n, v, 0, 1); });
  group.value("--surface-method", "NAME", surfaceMethodHelp(), [&o](auto& n, auto& v) {
    std::vector<std::string_view> names{"auto"};
    for (const SurfaceMethodInfo& method : surfaceMethods()) names.push_back(method.name);
    o.surface.method = names[parseWord(n, v, names)];
  });
  group.values("--surface-option", "NAME=VALUE", "Something that the method can be told; may be repeated",
               [&o](auto& n, auto& v) {
                 const auto [name, value] = parseSurfaceOption(n, v);
                 o.surface.parameters[name] = value;
               });
  group.value("--mesh-spacing", "S",
              "Side of a cube of the mesh's grid in Angstrom, 0.1 to 4, of\n"
              "--surface-method mesh and of --export [0.5]",
              [&o](auto& n, auto& v) { o.meshSpacing = parseNumber(n, v, 0.1, 4, "Angstrom"); });
  group.value("--export", "MESH",
              "Write the surface as polygons, .ply or .glb, with the atoms'\n"
              "colours; names as those of pictures. -o may then be left out",
              [&o](auto&, auto& v) { o.exportMesh = v; });
}

// What the styles stand for, a line each.
std::string styleHelp() {
  std::string help = "A look with a name; options given beside it have their way:";
  for (const Style& style : styles()) {
    help += "\n" + std::string(style.name) + ": ";
    std::size_t width = style.name.size() + 2;
    std::istringstream words{std::string(style.options.empty() ? "no effects [the default]" : style.options)};
    for (std::string word; words >> word; width += word.size() + 1) {
      if (width + word.size() > 60) {
        help += "\n  ";
        width = 2;
      }
      help += word + " ";
    }
  }
  return help;
}

void addStyleOption(CLI::App& app) {
  OptionGroup group(app, "Style");
  group.value("--style", "NAME", styleHelp(), [](auto&, auto&) {});  // withStyle() has seen to it
}

void addLightOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Light");
  const auto light = [&](const char* name, const char* help, std::optional<double>& target) {
    group.value(name, "F", help, [&target](auto& n, auto& v) { target = parseNumber(n, v, 0, 100); });
  };
  light("--key-light", "Light from the upper left; it casts the shadows [0.76]", o.keyLight);
  light("--fill-light", "Light from the right [0.16]", o.fillLight);
  light("--ambient-light", "Light from all around [0.12; more with --occlusion]", o.ambientLight);
  light("--highlight", "Strength of highlights [0.16]", o.highlight);
  group.value("--light-direction", "X,Y,Z",
              "The way the key light travels: right, up and towards you in\nthe picture [0.45,-0.6,-0.8]",
              [&o](auto& n, auto& v) { o.keyDirection = parseDirection(n, v); });
  group.value("--shadows", "off|hard|soft", "Shadows of the key light [off]", [&o](auto& n, auto& v) {
    o.shadows.mode = parseChoice<ShadowMode>(
        n, v, {{"off", ShadowMode::off}, {"hard", ShadowMode::hard}, {"soft", ShadowMode::soft}});
  });
  group.value("--penumbra", "WIDTH", "Width of a soft shadow's edge in Angstrom [2]",
              [&o](auto& n, auto& v) { o.shadows.penumbra = parseNumber(n, v, 0, 1000, "Angstrom"); });
  group.value("--shadow-samples", "N",
              "Samples of a soft shadow per ray, 1 to 256 [64]; 16 are\ntaken where they agree",
              [&o](auto& n, auto& v) { o.shadows.samples = parseInteger(n, v, 1, kMaxShadowSamples); });
  group.value("--occlusion", "on|off",
              "Ambient occlusion: pockets and creases become dark, and\n"
              "more of the light comes from all around [off]",
              [&o](auto& n, auto& v) {
                o.occlusion.on = parseChoice<bool>(n, v, {{"on", true}, {"off", false}});
              });
  group.value("--occlusion-radius", "R",
              "How far things occlude each other, in Angstrom; they do in\n"
              "full up to half of it; 0 = without limit [30]",
              [&o](auto& n, auto& v) { o.occlusion.radius = parseNumber(n, v, 0, 1e6, "Angstrom"); });
  group.value("--occlusion-strength", "F", "0 = none, 1 = as computed [1]",
              [&o](auto& n, auto& v) { o.occlusion.strength = parseNumber(n, v, 0, 1); });
  group.value("--occlusion-directions", "N", "From how many sides light comes: 8, 16, 32, 64 or 128 [64]",
              [&o](auto& n, auto& v) {
                o.occlusion.directions =
                    parseChoice<int>(n, v, {{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}});
              });
}

void parseEnvironment(const std::string& option, const std::string& value, RenderOptions& o) {
  const std::string word = lowerCase(value);
  o.environmentFile.clear();
  if (isEnvironmentName(value)) {
    o.environmentFile = value;
    o.trace.environment = Environment::map;
  } else if (word == "sky" || word == "background") {
    o.trace.environment = word == "sky" ? Environment::sky : Environment::background;
  } else {
    throw UsageError(fmt::format(
        "{}: '{}' is neither sky nor background nor a picture's name, which ends in .hdr, .exr, .png or .jpg",
        option, value));
  }
}

void addTraceOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Ray tracing");
  const auto rays = [&](const char* name, const char* help, int most, int& target) {
    group.value(name, "N", help, [most, &target](auto& n, auto& v) { target = parseInteger(n, v, 0, most); });
  };
  rays("--trace-shadows",
       "Rays per pixel to the key light, exact, in place of a shadow\n"
       "map, 0 to 4096; soft unless --shadows says hard [0: off]",
       kMaxTracedRays, o.trace.shadows);
  rays("--trace-ao",
       "Rays per pixel to all around, for --occlusion, 0 to 4096\n"
       "[0: off]",
       kMaxTracedRays, o.trace.occlusion);
  rays("--reflect",
       "Surfaces mirror their surroundings, so many times one after\n"
       "the other, 0 to 16 [0: off]",
       kMaxBounces, o.trace.reflect);
  rays("--refract",
       "Surfaces are of glass; light passes so many of its walls,\n"
       "0 to 16 [0: off]",
       kMaxBounces, o.trace.refract);
  group.value("--refractive-index", "N",
              "Of the glass, 1 to 10; also how strongly surfaces mirror\n"
              "[1.5]",
              [&o](auto& n, auto& v) { o.trace.index = parseNumber(n, v, 1, kMostIndex); });
  group.value("--attenuation-color,--attenuation-colour", "COLOR",
              "What a way of --attenuation-distance through the glass\n"
              "leaves of white light: black, white or '#RRGGBB' [white]",
              [&o](auto& n, auto& v) { o.trace.attenuationColor = parseColor(n, v); });
  group.value("--attenuation-distance", "D", "In Angstrom, 0.01 to 1000000 [10]",
              [&o](auto& n, auto& v) { o.trace.attenuationDistance = parseNumber(n, v, 0.01, 1e6); });
  group.value("--environment", "sky|background|FILE",
              "What mirrors and glass show where there is nothing else; of\n"
              "a FILE, .hdr, .exr, .png or .jpg: an equirectangular picture,\n"
              "its middle straight ahead [sky]",
              [&o](auto& n, auto& v) { parseEnvironment(n, v, o); });
}

void addLineOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Lines and depth");
  group.value("--outlines", "LIST",
              "Lines: silhouettes (in front of what lies behind), creases\n"
              "(where surfaces meet), chains, residues or atoms (between\n"
              "them); names separated by commas, or off [off]",
              [&o](auto& n, auto& v) { parseOutlines(n, v, o.lines); });
  group.value("--line-width", "PIXELS", "Width of lines, 0.5 to 16 [1.5]",
              [&o](auto& n, auto& v) { o.lines.width = parseNumber(n, v, 0.5, kMaxLineWidth, "pixels"); });
  group.value("--line-color,--line-colour", "COLOR", "black, white or '#RRGGBB' [black]",
              [&o](auto& n, auto& v) { o.lines.color = parseColor(n, v); });
  group.value("--line-strength", "F", "Opacity of lines, 0 to 1 [1]",
              [&o](auto& n, auto& v) { o.lines.strength = parseNumber(n, v, 0, 1); });
  group.value("--line-gap", "DEPTH", "A smaller step in depth raises no silhouette, Angstrom [1]",
              [&o](auto& n, auto& v) { o.lines.gap = parseNumber(n, v, 0, 100000, "Angstrom"); });
  group.value("--crease-angle", "DEGREES", "Surfaces that meet at a smaller angle raise no crease [30]",
              [&o](auto& n, auto& v) { o.lines.creaseAngleDeg = parseNumber(n, v, 1, 180, "degrees"); });
  group.value("--depth-unsharp", "off|both|halo",
              "Brighten what lies in front of its surroundings and darken\n"
              "what lies behind, or only darken (halo) [off]",
              [&o](auto& n, auto& v) {
                o.depthUnsharp.mode = parseChoice<UnsharpMode>(
                    n, v,
                    {{"off", UnsharpMode::off}, {"both", UnsharpMode::both}, {"halo", UnsharpMode::halo}});
              });
  group.value("--unsharp-strength", "F", "Strength of depth unsharp masking, 0 to 100 [2]",
              [&o](auto& n, auto& v) { o.depthUnsharp.strength = parseNumber(n, v, 0, 100); });
  group.value("--unsharp-radius", "R",
              "Its radius: Angstrom, or a share of the picture's smaller\nside as in 3% [2%]",
              [&o](auto& n, auto& v) { parseUnsharpRadius(n, v, o.depthUnsharp); });
  group.value("--fog", "F", "Fade what is far away into the background, 0 to 1 [0: off]",
              [&o](auto& n, auto& v) { o.fog.strength = parseNumber(n, v, 0, 1); });
  group.value("--fog-start", "F", "Where fog begins: 0 = front of the scene, 1 = its back [0.2]",
              [&o](auto& n, auto& v) { o.fog.start = parseNumber(n, v, -10, 10); });
  group.value("--fog-end", "F", "Where fog is as strong as it gets [1]",
              [&o](auto& n, auto& v) { o.fog.end = parseNumber(n, v, -10, 10); });
}

void addCameraOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Camera");
  group.value("--orient", "HOW",
              "principal (the flattest side to the viewer), x, y, z (looking\n"
              "down that axis) or a quaternion W,X,Y,Z [principal]",
              [&o](auto& n, auto& v) { o.orientation = parseOrientation(n, v); });
  group.value("--rotate", "X,Y,Z",
              "Then turn by degrees about the picture's right, up and\n"
              "towards-you axes, in this order",
              [&o](auto& n, auto& v) { o.rotationDeg = parseAngles(n, v); });
  group.value("--zoom", "F", "Magnify about the middle of the picture [1: all is seen]",
              [&o](auto& n, auto& v) { o.zoom = parseNumber(n, v, 0.001, 1000); });
  group.value("--focus", "CID", "Fit the picture to these atoms instead of all (as --select)",
              [&o](auto&, auto& v) { o.focus = v; });
  group.value("--fov", "DEGREES", "Vertical field of view, 1 to 170 [30]",
              [&o](auto& n, auto& v) { o.fovYDeg = parseNumber(n, v, 1, 170, "degrees"); });
  group.value("--target", "X,Y,Z", "Point in the middle of the picture, Angstrom [fitted]",
              [&o](auto& n, auto& v) { o.target = parsePoint(n, v); });
  group.value("--distance", "D", "From the eye to that point, Angstrom [fitted]",
              [&o](auto& n, auto& v) { o.distance = parseNumber(n, v, 1e-3, 1e9, "Angstrom"); });
  group.value("--near", "D", "Cut off what is nearer to the eye than that, Angstrom [nothing]",
              [&o](auto& n, auto& v) { o.nearest = parseNumber(n, v, 0, 1e9, "Angstrom"); });
  group.value("--far", "D", "Cut off what is farther from the eye than that, Angstrom [nothing]",
              [&o](auto& n, auto& v) { o.farthest = parseNumber(n, v, 1e-3, 1e9, "Angstrom"); });
  group.flag("--orthographic", "Parallel instead of perspective projection", o.orthographic);
}

void addStructureOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Atoms");
  group.value("--select", "CID",
              "Draw only these: /model/chain/residues/atom[element], for\n"
              "example //A/10-20, '(HEM)', 'CA[C]' (gemmi's syntax)",
              [&o](auto&, auto& v) { o.structure.select = v; });
  group.value("--model", "N|all",
              "Model of the file by its number [the first]. With {model} in\n"
              "OUT, all gives one picture each, seen by one camera",
              [&o](auto& n, auto& v) { parseModel(n, v, o.structure); });
  group.value("--assembly", "ID", "Build this biological assembly ('meniscus info' lists them)",
              [&o](auto&, auto& v) { o.assembly = v; });
  group.value("--altloc", "WHICH", "Alternate locations: first, all or a letter [first]",
              [&o](auto& n, auto& v) { parseAltloc(n, v, o.structure); });
  group.value("--hydrogens", "on|off", "Draw hydrogens [on]", [&o](auto& n, auto& v) {
    o.structure.hydrogens = parseChoice<bool>(n, v, {{"on", true}, {"off", false}});
  });
  group.value("--waters", "on|off|auto", "Draw waters [auto: only if there is nothing else]",
              [&o](auto& n, auto& v) {
                o.structure.waters = parseChoice<Waters>(
                    n, v, {{"on", Waters::on}, {"off", Waters::off}, {"auto", Waters::automatic}});
              });
  group.value("--replicate", "NxMxK", "Repeat the molecule on a lattice",
              [&o](auto& n, auto& v) { o.replicate = parseCopies(n, v); });
}

void addSceneOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Scenes");
  group.values("--scene", "FILE",
               "Draw a MolViewSpec scene (.mvsj or .mvsx); may be repeated.\n"
               "{state} in OUT stands for the key of one of its states",
               [&o](auto&, auto& v) { o.scenes.push_back(v); });
  group.value("--save-scene", "FILE", "Write what files and options mean as a scene (.mvsj)",
              [&o](auto&, auto& v) { o.saveScene = v; });
  group.flag("--strict", "Fail if a scene has something that is not supported", o.strict);
  group.flag("--offline", "Fetch nothing from the web; what was fetched before is used", o.offline);
  group.value("--cache", "DIR", "Where fetched files are kept [$XDG_CACHE_HOME/meniscus]",
              [&o](auto&, auto& v) { o.cache = v; });
}

void addBatchOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Many pictures");
  group.value("--manifest", "FILE",
              "Write a line of JSON about every picture: input, output,\n"
              "milliseconds, warnings, error",
              [&o](auto&, auto& v) { o.manifest = v; });
  group.flag("--resume",
             "Leave out pictures that the manifest says are done, if\n"
             "input, options and program are the same",
             o.resume);
  group.value("--jobs", "N", "Inputs that are read while others are drawn, 1 to 64 [1]",
              [&o](auto& n, auto& v) { o.jobs = parseInteger(n, v, 1, 64); });
  group.value("--time-limit", "SECONDS", "Give up a picture that takes longer [0: no limit]",
              [&o](auto& n, auto& v) { o.timeLimit = parseNumber(n, v, 0, 1e6, "seconds"); });
  group.value("--turntable", "N",
              "N pictures of a full turn about the picture's vertical axis;\n"
              "OUT has {frame}, or ends in .mp4, .webm or .gif (by ffmpeg)",
              [&o](auto& n, auto& v) { o.turntable = parseInteger(n, v, 1, 100000); });
  group.value("--fps", "N", "Pictures per second of a film [30]",
              [&o](auto& n, auto& v) { o.framesPerSecond = parseNumber(n, v, 1, 240); });
}

void addOtherOptions(CLI::App& app, RenderOptions& o) {
  OptionGroup group(app, "Other");
  group.value("--backend", "auto|egl|osmesa", "How to reach OpenGL [auto]; see 'meniscus doctor'",
              [&o](auto& n, auto& v) { o.backend = parseBackend(n, v); });
  group.value("--quadrics", "splat|tiles|tiles_glsl|auto",
              "Spheres, cylinders and ellipsoids drawn by the GPU, a\n"
              "rectangle each (splat), or from lists of screen tiles, by the\n"
              "processor (tiles) or by shaders (tiles_glsl) [auto: tiles\n"
              "where there is no GPU, else splat]; the picture is the same",
              [&o](auto& n, auto& v) {
                o.quadrics = parseChoice<QuadricMethod>(n, v,
                                                        {{"splat", QuadricMethod::splat},
                                                         {"tiles", QuadricMethod::tiles},
                                                         {"tiles_glsl", QuadricMethod::tilesGlsl},
                                                         {"auto", QuadricMethod::automatic}});
              });
  group.flag("--explain",
             "Print what was drawn, what was left out and why, and what\n"
             "it cost, on standard output",
             o.explain);
  group.value("--stats", "FILE", "Write the same as JSON", [&o](auto&, auto& v) { o.statsFile = v; });
  group.value("--shader-dir", "DIR", "Take shaders from a folder instead of the program",
              [&o](auto&, auto& v) { o.shaderDir = v; });
  group.flag("-q,--quiet", "No progress and no notes, only errors", o.quiet);
}

// With a scene, what is drawn is the scene's business; from where, unless the command says it.
void requireOnlyPictureOptions(const RenderOptions& o) {
  constexpr std::array<std::string_view, 5> kCamera{"orient", "target", "distance", "near", "far"};
  if (!o.exportMesh.empty())
    throw UsageError("--export: is for structure files; of a --scene there are only pictures");
  for (const auto& [name, value] : o.given)
    if (!findSetting(SettingPlace::picture, name) &&
        std::find(kCamera.begin(), kCamera.end(), name) == kCamera.end())
      throw UsageError(
          fmt::format("--{}: is for structure files; with --scene, the scene says it (docs/scene.md)", name));
}

void requirePanelsConsistent(const RenderOptions& o) {
  if (o.divider && o.panels.size() != 2)
    throw UsageError("--divider: is between two panels; give --panel twice");
  if (o.panels.empty()) return;
  if (o.panels.size() == 1 || o.panels.size() > kMostPanels)
    throw UsageError(
        fmt::format("--panel: there are two to {} in a picture, not {}", kMostPanels, o.panels.size()));
  for (std::size_t i = 0; i < o.panels.size(); ++i)
    if (o.panels[i].error && i < 2)
      throw UsageError("--panel: 'error' compares the first two panels; give it after them");
  if (!o.exportMesh.empty() || !o.saveScene.empty())
    throw UsageError("--panel: pictures have panels; meshes and saved scenes do not");
  if (o.bitDepth != 8 || o.layers != Layers{} ||
      (!isFilm(o.output) && imageTypeOf(o.output) == ImageType::exr))
    throw UsageError("--panel: is for PNG with 8 bits a channel and for films");
}

void requireConsistent(const CLI::App& app, RenderOptions& o) {
  if (o.files.empty() && o.scenes.empty())
    throw UsageError("no input; give a structure file, as in meniscus render FILE -o OUT.png");
  if (o.output.empty() && o.exportMesh.empty())
    throw UsageError("no output; add the picture's name, as in -o picture.png");
  if (std::filesystem::is_directory(o.output)) requireWritable(o.output);  // says that it is a folder
  if (!o.exportMesh.empty()) requireMeshName("--export", o.exportMesh);
  if (o.turntable > 0 && o.output.empty())
    throw UsageError("--turntable: a mesh does not turn; add the pictures' name, as in -o '{frame}.png'");
  if (OutputPattern(o.exportMesh).namesFrame())
    throw UsageError("--export: {frame} numbers pictures; the mesh of a --turntable has one name");
  if (o.meshSpacing && o.surface.method == "mesh") o.surface.parameters["spacing"] = *o.meshSpacing;
  if (o.meshSpacing && o.surface.method != "mesh" && o.exportMesh.empty())
    throw UsageError("--mesh-spacing: there is no mesh; add --surface-method mesh or --export FILE.ply");
  if (!o.scenes.empty()) requireOnlyPictureOptions(o);
  if (!o.saveScene.empty() && !o.scenes.empty())
    throw UsageError(
        "--save-scene: writes what structure files and options mean; a scene is written already");
  if (!o.saveScene.empty() && !o.measures.empty())
    throw UsageError("--measure: a saved scene has no place for it; leave it or --save-scene out");
  requirePanelsConsistent(o);
  requireFilmNames(o, OutputPattern(o.output));
  if (o.resume && o.manifest.empty())
    throw UsageError("--resume: needs the --manifest of the run that is to be continued");
  if (o.resume && !o.saveScene.empty())
    throw UsageError("--save-scene: needs every picture, also those that are done; leave out --resume");
  requireSettingsConsistent(o);
  if (!o.output.empty() && !isFilm(o.output) && imageTypeOf(o.output) == ImageType::exr &&
      app.count("--depth") > 0)
    throw UsageError(
        "--depth: is for PNG; OpenEXR pictures are floating point (depth as a layer: --channels depth)");
  if (!o.shaderDir.empty() && !std::filesystem::is_directory(o.shaderDir))
    throw UsageError("--shader-dir: '" + o.shaderDir.string() + "' is not a folder; give a copy of shaders/");
}

bool isGiven(const CLI::Option& option) {
  return option.count() > 0 && !option.get_lnames().empty() && option.results().back() != "false";
}

bool isForThePicture(const CLI::Option& option) {
  return std::find(kNotForThePicture.begin(), kNotForThePicture.end(), option.get_lnames().front()) ==
         kNotForThePicture.end();
}

std::vector<std::pair<std::string, std::string>> givenOptions(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const CLI::Option* option : app.get_options({})) {
    if (!isGiven(*option) || !isForThePicture(*option)) continue;
    const std::string& name = option->get_lnames().front();
    if (option->get_items_expected_max() == 0) {
      given.emplace_back(name, "");
    } else if (option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll) {
      for (const std::string& value : option->results()) given.emplace_back(name, value);
    } else {
      given.emplace_back(name, option->results().back());
    }
  }
  return given;
}

std::string pictureOptionsOf(const RenderOptions& o) {
  std::string text;
  for (const auto& [name, value] : o.given)
    text += value.empty() ? " --" + name : " --" + name + " " + shellQuoted(value);
  return text;
}

void addAllOptions(CLI::App& app, RenderOptions& options) {
  options.structure.altlocs = Altlocs::first;
  options.structure.waters = Waters::automatic;
  app.add_option("FILE", options.files, "Structure files; {stem} in OUT gives each its own picture")
      ->type_name("FILE...");
  addOutputOptions(app, options);
  addLookOptions(app, options);
  addSurfaceOptions(app, options);
  addLabelOptions(app, options);
  addPanelOptions(app, options);
  addStyleOption(app);
  addLightOptions(app, options);
  addTraceOptions(app, options);
  addLineOptions(app, options);
  addCameraOptions(app, options);
  addStructureOptions(app, options);
  addSceneOptions(app, options);
  addBatchOptions(app, options);
  addOtherOptions(app, options);
}

}  // namespace

std::string shellQuoted(const std::string& text) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("_-+=.,:/@%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

void requireSettingsConsistent(const RenderOptions& o) {
  if (!(o.fog.start < o.fog.end))
    throw UsageError("--fog-start: must be less than --fog-end (they are 0.2 and 1 unless given)");
  if (o.surface.parameters.size() > 0 || o.surface.method != "auto" || o.surface.translucent())
    surfaceParametersFor(surfaceMethodFor(o.surface), o.surface);  // throws if it has no such parameter
  if (o.trace.any() && o.surface.translucent())
    throw UsageError("--opacity: rays are traced through opaque surfaces and glass (--refract) only");
  if (!o.output.empty() && (isFilm(o.output) || imageTypeOf(o.output) != ImageType::exr) &&
      o.layers != Layers{})
    throw UsageError("--channels: is for OpenEXR; a PNG holds the colour only, so let OUT end in .exr");
}

RenderOptions parseSettings(const std::vector<std::string>& arguments) {
  RenderOptions options;
  const std::unique_ptr<CLI::App> app = makeCommandLine("render", kDescription, kExamples);
  addAllOptions(*app, options);
  if (!parseCommandLine(*app, withStyle(arguments)))
    throw UsageError("--help: is no setting");  // it has been shown
  options.given = givenOptions(*app);
  for (const CLI::Option* option : app->get_options({}))
    if (isGiven(*option) && !isForThePicture(*option))
      options.ofTheRun.push_back(option->get_lnames().front());
  return options;
}

std::optional<RenderOptions> parseRenderOptions(const std::vector<std::string>& arguments) {
  RenderOptions options;
  const std::unique_ptr<CLI::App> app = makeCommandLine("render", kDescription, kExamples);
  addAllOptions(*app, options);
  if (!parseCommandLine(*app, withStyle(arguments))) return std::nullopt;
  options.given = givenOptions(*app);
  options.pictureOptions = pictureOptionsOf(options);
  requireConsistent(*app, options);
  return options;
}

}  // namespace meniscus
