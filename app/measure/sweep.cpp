#include "app/measure/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/generated_scenes.h"
#include "io/structure_reader.h"
#include "render/surface_method.h"

namespace meniscus::measure {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kMostRepetitions = 1000;
constexpr double kMostSeconds = 1e6;
constexpr std::size_t kMostBalls = 10'000'000;
constexpr std::size_t kMostValues = 1000;

std::string listed(std::span<const std::string_view> names) {
  std::string out;
  for (const std::string_view name : names) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

/// A value of the JSON and the way to it, for errors: "methods[1].values".
class Node {
 public:
  Node(const Json& json, std::string path, const std::string& where)
      : json_(&json), path_(std::move(path)), where_(&where) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("{}: {}{}", *where_, path_.empty() ? "" : path_ + ": ", why));
  }
  const std::string& path() const { return path_; }
  const Json& json() const { return *json_; }
  bool isObject() const { return json_->is_object(); }
  bool isString() const { return json_->is_string(); }
  bool isArray() const { return json_->is_array(); }

  /// An object that has no keys but these.
  void requireKeys(std::span<const std::string_view> allowed) const {
    if (!json_->is_object()) refuse("must be an object { ... }");
    for (const auto& item : json_->items())
      if (std::find(allowed.begin(), allowed.end(), item.key()) == allowed.end())
        throw InputError(fmt::format("{}: there is no key '{}{}{}'; there are {}", *where_, path_,
                                     path_.empty() ? "" : ".", item.key(), listed(allowed)));
  }
  std::optional<Node> find(const std::string& key) const {
    const auto found = json_->find(key);
    if (found == json_->end()) return std::nullopt;
    return Node(*found, path_.empty() ? key : path_ + "." + key, *where_);
  }
  std::vector<Node> elements() const {
    if (!json_->is_array()) refuse("must be a list [ ... ]");
    std::vector<Node> out;
    for (std::size_t i = 0; i < json_->size(); ++i)
      out.emplace_back((*json_)[i], fmt::format("{}[{}]", path_, i), *where_);
    return out;
  }
  double number(double least, double most) const {
    const double value = json_->is_number() ? json_->get<double>() : std::nan("");
    if (!(value >= least && value <= most))
      refuse(fmt::format("{} is not allowed; give a number from {} to {}", json_->dump(), least, most));
    return value;
  }
  std::int64_t whole(std::int64_t least, std::int64_t most) const {
    const bool allowed = json_->is_number_integer() && json_->get<double>() >= static_cast<double>(least) &&
                         json_->get<double>() <= static_cast<double>(most);
    if (!allowed)
      refuse(fmt::format("{} is not allowed; give a whole number from {} to {}", json_->dump(), least, most));
    return json_->get<std::int64_t>();
  }
  bool boolean() const {
    if (!json_->is_boolean()) refuse(fmt::format("{} is not allowed; give true or false", json_->dump()));
    return json_->get<bool>();
  }
  std::string text() const {
    if (!json_->is_string() || json_->get<std::string>().empty())
      refuse(fmt::format("{} is not allowed; give a text", json_->dump()));
    return json_->get<std::string>();
  }
  std::size_t oneOf(std::span<const std::string_view> words) const {
    const std::string value = json_->is_string() ? json_->get<std::string>() : "";
    const auto found = std::find(words.begin(), words.end(), value);
    if (found == words.end())
      refuse(fmt::format("{} is not allowed; give one of {}", json_->dump(), listed(words)));
    return static_cast<std::size_t>(found - words.begin());
  }

 private:
  const Json* json_;
  std::string path_;
  const std::string* where_;
};

ImageSize sizeOf(const Node& node) {
  const std::string text = node.isString() ? node.json().get<std::string>() : "";
  ImageSize size;
  char cross = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%d%c%d%c", &size.width, &cross, &size.height, &rest) != 3 || cross != 'x' ||
      std::min(size.width, size.height) < 1 || std::max(size.width, size.height) > 8192)
    node.refuse(
        fmt::format("{} is not allowed; give \"WIDTHxHEIGHT\", each from 1 to 8192", node.json().dump()));
  return size;
}

glm::ivec3 copiesOf(const Node& node) {
  const std::vector<Node> parts = node.elements();
  if (parts.size() != 3) node.refuse("must be three whole numbers");
  return {static_cast<int>(parts[0].whole(1, 100)), static_cast<int>(parts[1].whole(1, 100)),
          static_cast<int>(parts[2].whole(1, 100))};
}

PapersSpec papersOf(const Node& node) {
  constexpr std::string_view kKeys[] = {"scale", "mostBalls"};
  node.requireKeys(kKeys);
  PapersSpec papers;
  if (const auto scale = node.find("scale")) papers.scale = scale->number(0.01, 1);
  if (const auto most = node.find("mostBalls"))
    papers.mostBalls = static_cast<std::size_t>(most->whole(1, kMostBalls));
  return papers;
}

class Parser {
 public:
  Parser(const std::string& where, fs::path folder) : where_(where), folder_(std::move(folder)) {}
  Sweep parse(const std::string& text);

 private:
  fs::path moleculeOf(const Node& node) const;
  SceneSpec sceneOf(const Node& node) const;
  SurfaceShape shapeOf(const Node& node) const;
  ViewSpec viewOf(const Node& node) const;
  std::vector<MethodLine> linesOf(const Node& node, int steps) const;
  std::vector<MethodLine> lineOf(const Node& node, int steps) const;
  std::vector<double> valuesOf(const Node& node, const SurfaceParameter& parameter) const;
  ShadowSpec shadowOf(const Node& node) const;
  StabilitySpec stabilityOf(const Node& node) const;

  const std::string& where_;
  fs::path folder_;
};

fs::path Parser::moleculeOf(const Node& node) const {
  const std::string name = node.text();
  std::error_code error;
  for (const fs::path& path : {folder_ / name, findMolecule(name)})
    if (!path.empty() && fs::is_regular_file(path, error)) return path;
  node.refuse(fmt::format("there is no file '{}' in '{}' nor among the molecules of this program", name,
                          folder_.empty() ? "." : folder_.string()));
}

SurfaceShape Parser::shapeOf(const Node& node) const {
  constexpr std::string_view kKernels[] = {"sextic", "quartic", "power"};
  SurfaceShape shape;
  if (const auto kernel = node.find("kernel"))
    shape.kernel.shape = static_cast<KernelShape>(kernel->oneOf(kKernels));
  if (const auto exponent = node.find("exponent")) {
    if (shape.kernel.shape != KernelShape::power) exponent->refuse("is for \"kernel\": \"power\" only");
    shape.kernel.exponent = static_cast<int>(exponent->whole(kLeastKernelExponent, kMostKernelExponent));
  }
  if (const auto blend = node.find("blend")) shape.blend = blend->number(1.001, 10);
  if (const auto level = node.find("level")) shape.level = level->number(1e-12, 1e6);
  return shape;
}

SceneSpec Parser::sceneOf(const Node& node) const {
  constexpr std::string_view kKeys[] = {"name",   "molecule", "balls",    "stability", "select",
                                        "copies", "kernel",   "exponent", "blend",     "level"};
  node.requireKeys(kKeys);
  SceneSpec scene;
  const auto molecule = node.find("molecule"), balls = node.find("balls"), recipe = node.find("stability");
  if (int(molecule.has_value()) + int(balls.has_value()) + int(recipe.has_value()) != 1)
    node.refuse("give one of molecule, balls and stability");
  if (!molecule)
    for (const char* key : {"select", "copies", "kernel", "exponent", "blend", "level"})
      if (const auto odd = node.find(key)) odd->refuse("is for molecules only");
  if (molecule) {
    scene.molecule = moleculeOf(*molecule);
    scene.name = molecule->text();
    scene.shape = shapeOf(node);
    if (const auto copies = node.find("copies")) scene.copies = copiesOf(*copies);
    if (const auto select = node.find("select")) {
      scene.select = select->text();
      try {
        selectAtoms(Molecule{}, scene.select);
      } catch (const UsageError& error) {
        select->refuse(error.what());
      }
    }
  } else if (balls) {
    scene.balls = static_cast<std::size_t>(balls->whole(1, kMostBalls));
    scene.name = fmt::format("{} packed balls", scene.balls);
  } else {
    std::vector<std::string_view> names;
    for (const StabilityRecipe& r : stabilityRecipes()) names.push_back(r.name);
    scene.stability = std::string(names[recipe->oneOf(names)]);
    scene.name = scene.stability;
  }
  if (const auto name = node.find("name")) scene.name = name->text();
  return scene;
}

ViewSpec Parser::viewOf(const Node& node) const {
  constexpr std::string_view kKeys[] = {"name", "rotate", "fov", "zoom", "orthographic"};
  node.requireKeys(kKeys);
  ViewSpec view;
  if (const auto name = node.find("name")) view.name = name->text();
  if (const auto rotate = node.find("rotate")) {
    const std::vector<Node> angles = rotate->elements();
    if (angles.size() != 3) rotate->refuse("must be three angles in degrees");
    for (int i = 0; i < 3; ++i) view.rotateDeg[i] = angles[static_cast<std::size_t>(i)].number(-360, 360);
  }
  if (const auto fov = node.find("fov")) view.fovDeg = fov->number(0.001, 175);
  if (const auto zoom = node.find("zoom")) view.zoom = zoom->number(1e-3, 1e6);
  if (const auto orthographic = node.find("orthographic")) view.orthographic = orthographic->boolean();
  return view;
}

// `count` values over all that is allowed, evenly in powers where that spans more than a factor of ten. The
// last does the most work if small values do: methods put what they trade work by first, widths and
// tolerances above all.
std::vector<double> spread(double from, double to, int count, bool logarithmic, bool whole) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 0.5;
    double value = logarithmic ? from * std::pow(to / from, share) : from + share * (to - from);
    if (count > 1 && i == count - 1) value = to;
    if (i == 0 && count > 1) value = from;
    if (whole) value = std::round(value);
    // 1e-05 rather than 9.999999999999997e-06.
    if (!whole && i > 0 && i < count - 1) value = std::stod(fmt::format("{:.3g}", value));
    if (values.empty() || values.back() != value) values.push_back(value);
  }
  return values;
}

const SurfaceMethodInfo* methodNamed(std::string_view name) {
  for (const SurfaceMethodInfo& method : surfaceMethods())
    if (method.name == name) return &method;
  return nullptr;
}

std::vector<double> Parser::valuesOf(const Node& node, const SurfaceParameter& parameter) const {
  std::vector<double> values;
  if (node.isObject()) {
    constexpr std::string_view kKeys[] = {"from", "to", "steps", "scale"};
    constexpr std::string_view kScales[] = {"linear", "log"};
    node.requireKeys(kKeys);
    const auto from = node.find("from"), to = node.find("to"), steps = node.find("steps"),
               scale = node.find("scale");
    if (!from || !to || !steps) node.refuse("needs from, to and steps");
    const double first = from->number(parameter.least, parameter.most),
                 last = to->number(parameter.least, parameter.most);
    if (!(first < last)) node.refuse(fmt::format("from {} to {} is no range", first, last));
    const bool logarithmic = scale && scale->oneOf(kScales) == 1;
    if (logarithmic && !(first > 0)) from->refuse("must be positive on a logarithmic scale");
    return spread(first, last, static_cast<int>(steps->whole(2, kMostValues)), logarithmic, parameter.whole);
  }
  for (const Node& value : node.elements()) {
    values.push_back(value.number(parameter.least, parameter.most));
    if (parameter.whole && values.back() != std::floor(values.back()))
      value.refuse(fmt::format("{} takes whole numbers", parameter.name));
    if (std::count(values.begin(), values.end(), values.back()) > 1) value.refuse("is there twice");
  }
  if (values.empty()) node.refuse("is empty");
  return values;
}

// What a method trades work for precision by: its first parameter, unless that is a switch.
MethodLine automaticLine(const SurfaceMethodInfo& method, int steps) {
  MethodLine line;
  line.method = std::string(method.name);
  if (method.parameters.empty() || steps < 2) return line;
  const SurfaceParameter& parameter = method.parameters.front();
  if (parameter.whole && parameter.most - parameter.least <= 1) return line;
  line.parameter = std::string(parameter.name);
  const bool logarithmic = parameter.least > 0 && parameter.most / parameter.least > 10;
  line.values = spread(parameter.least, parameter.most, steps, logarithmic, parameter.whole);
  return line;
}

std::vector<MethodLine> Parser::lineOf(const Node& node, int steps) const {
  constexpr std::string_view kKeys[] = {"method", "parameter", "values", "options"};
  node.requireKeys(kKeys);
  const auto method = node.find("method");
  if (!method) node.refuse("needs the key method");
  std::vector<std::string_view> names;
  for (const SurfaceMethodInfo& info : surfaceMethods()) names.push_back(info.name);
  const SurfaceMethodInfo& info = *methodNamed(names[method->oneOf(names)]);
  const auto parameterNamed = [&](const Node& at, const std::string& name) -> const SurfaceParameter& {
    std::vector<std::string_view> all;
    for (const SurfaceParameter& p : info.parameters) all.push_back(p.name);
    for (const SurfaceParameter& p : info.parameters)
      if (p.name == name) return p;
    at.refuse(fmt::format("the method {} has no parameter '{}'; it has {}", info.name, name,
                          all.empty() ? "none" : listed(all)));
  };
  MethodLine line;
  line.method = std::string(info.name);
  const auto parameter = node.find("parameter"), values = node.find("values"), options = node.find("options");
  if (parameter.has_value() != values.has_value()) node.refuse("parameter and values go together");
  if (parameter) {
    const SurfaceParameter& known = parameterNamed(*parameter, parameter->text());
    line.parameter = std::string(known.name);
    line.values = valuesOf(*values, known);
  } else {
    line = automaticLine(info, steps);
  }
  if (options) {
    if (!options->isObject()) options->refuse("must be an object { \"name\": number }");
    for (const auto& item : options->json().items()) {
      const Node value = *options->find(item.key());
      const SurfaceParameter& known = parameterNamed(value, item.key());
      if (known.name == line.parameter) value.refuse("is what varies already");
      line.options[item.key()] = value.number(known.least, known.most);
      if (known.whole && line.options[item.key()] != std::floor(line.options[item.key()]))
        value.refuse("must be a whole number");
    }
  }
  return {line};
}

std::vector<MethodLine> Parser::linesOf(const Node& node, int steps) const {
  if (surfaceMethods().empty()) node.refuse("this program has no surface method");
  std::vector<MethodLine> lines;
  if (node.isString()) {
    constexpr std::string_view kAll[] = {"all"};
    node.oneOf(kAll);
    for (const SurfaceMethodInfo& method : surfaceMethods()) lines.push_back(automaticLine(method, steps));
    return lines;
  }
  std::set<std::string> seen;
  for (const Node& element : node.elements()) {
    for (MethodLine& line : lineOf(element, steps)) {
      if (!seen.insert(line.label() + " " + line.parameter).second)
        element.refuse("the same method and options are there already");
      lines.push_back(std::move(line));
    }
  }
  if (lines.empty()) node.refuse("is empty");
  return lines;
}

ShadowSpec Parser::shadowOf(const Node& node) const {
  constexpr std::string_view kKeys[] = {"name",   "molecule", "representation",
                                        "copies", "penumbra", "settings"};
  constexpr std::string_view kRepresentations[] = {"spacefill", "ball_and_stick", "licorice"};
  node.requireKeys(kKeys);
  ShadowSpec shadow;
  const auto molecule = node.find("molecule");
  if (!molecule) node.refuse("needs the key molecule");
  shadow.molecule = moleculeOf(*molecule);
  shadow.name = molecule->text();
  if (const auto name = node.find("name")) shadow.name = name->text();
  if (const auto representation = node.find("representation"))
    shadow.representation = static_cast<Representation>(representation->oneOf(kRepresentations));
  if (const auto copies = node.find("copies")) shadow.copies = copiesOf(*copies);
  if (const auto penumbra = node.find("penumbra")) shadow.penumbra = penumbra->number(0, 100);
  shadow.settings = {{1, 0}, {4, 0}, {8, 0}, {16, 0}, {64, 0}, {64, 8}, {64, 16}, {256, 0}};
  if (const auto settings = node.find("settings")) {
    shadow.settings.clear();
    for (const Node& pair : settings->elements()) {
      const std::vector<Node> parts = pair.elements();
      if (parts.size() != 2) pair.refuse("must be [samples, probes]");
      const auto samples = static_cast<int>(parts[0].whole(1, kMaxShadowSamples));
      shadow.settings.emplace_back(samples, static_cast<int>(parts[1].whole(0, samples - 1)));
    }
    if (shadow.settings.empty()) settings->refuse("is empty");
  }
  return shadow;
}

StabilitySpec Parser::stabilityOf(const Node& node) const {
  constexpr std::string_view kKeys[] = {"size", "timeLimit", "scenes"};
  node.requireKeys(kKeys);
  StabilitySpec out;
  std::vector<std::string_view> names;
  for (const StabilityRecipe& recipe : stabilityRecipes()) names.push_back(recipe.name);
  if (const auto size = node.find("size")) out.size = sizeOf(*size);
  if (const auto limit = node.find("timeLimit")) out.timeLimit = limit->number(0.01, kMostSeconds);
  if (const auto scenes = node.find("scenes"))
    for (const Node& scene : scenes->elements()) out.scenes.emplace_back(names[scene.oneOf(names)]);
  if (out.scenes.empty()) out.scenes.assign(names.begin(), names.end());
  return out;
}

Sweep Parser::parse(const std::string& text) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InputError(fmt::format("{}: line {} is not valid JSON", where_, line));
  }
  const Node root(json, "", where_);
  constexpr std::string_view kKeys[] = {
      "seed",  "repetitions", "warmUp", "budget",  "images",  "layers",    "scenes",     "views",
      "sizes", "methods",     "steps",  "scaling", "shadows", "stability", "leavingOut", "papers"};
  root.requireKeys(kKeys);
  Sweep sweep;
  sweep.text = json.dump();
  if (const auto seed = root.find("seed"))
    sweep.seed = static_cast<std::uint64_t>(seed->whole(0, std::int64_t{1} << 53));
  if (const auto repetitions = root.find("repetitions"))
    sweep.repetitions = static_cast<int>(repetitions->whole(1, kMostRepetitions));
  if (const auto warmUp = root.find("warmUp"))
    sweep.warmUp = static_cast<int>(warmUp->whole(0, kMostRepetitions));
  if (const auto budget = root.find("budget")) sweep.budget = budget->number(0, kMostSeconds);
  if (const auto images = root.find("images")) sweep.images = images->boolean();
  if (const auto layers = root.find("layers")) sweep.layers = layers->boolean();
  std::set<std::string> names;
  const auto addScene = [&](const Node& at, SceneSpec scene, std::vector<SceneSpec>& to) {
    if (!names.insert(scene.name).second) at.refuse("another scene has the same name; give it a name");
    to.push_back(std::move(scene));
  };
  if (const auto scenes = root.find("scenes"))
    for (const Node& scene : scenes->elements()) addScene(scene, sceneOf(scene), sweep.scenes);
  if (const auto scaling = root.find("scaling")) {
    if (surfaceMethods().empty()) scaling->refuse("this program has no surface method");
    for (const Node& count : scaling->elements()) {
      SceneSpec scene;
      scene.balls = static_cast<std::size_t>(count.whole(1, kMostBalls));
      scene.name = fmt::format("{} packed balls", scene.balls);
      addScene(count, scene, sweep.scaling);
    }
  }
  std::set<std::string> viewNames;
  if (const auto views = root.find("views")) {
    for (const Node& view : views->elements()) {
      sweep.views.push_back(viewOf(view));
      if (!viewNames.insert(sweep.views.back().name).second)
        view.refuse("another view has the same name; give it a name");
    }
  }
  if (sweep.views.empty()) sweep.views.emplace_back();
  if (const auto sizes = root.find("sizes"))
    for (const Node& size : sizes->elements()) {
      const ImageSize parsed = sizeOf(size);
      if (std::find(sweep.sizes.begin(), sweep.sizes.end(), parsed) != sweep.sizes.end())
        size.refuse("is there twice");
      sweep.sizes.push_back(parsed);
    }
  if (sweep.sizes.empty()) sweep.sizes.push_back({640, 480});
  int steps = 5;
  if (const auto given = root.find("steps")) steps = static_cast<int>(given->whole(1, 100));
  if (const auto methods = root.find("methods")) {
    sweep.lines = linesOf(*methods, steps);
    if (sweep.scenes.empty()) methods->refuse("there are no scenes to draw");
  } else if (!sweep.scenes.empty()) {
    root.find("scenes")->refuse("there are no methods to draw them");
  }
  if (const auto shadows = root.find("shadows"))
    for (const Node& shadow : shadows->elements()) sweep.shadows.push_back(shadowOf(shadow));
  if (const auto stability = root.find("stability")) sweep.stability = stabilityOf(*stability);
  if (const auto leavingOut = root.find("leavingOut")) {
    SceneSpec scene;
    scene.molecule = moleculeOf(*leavingOut);
    scene.name = leavingOut->text();
    sweep.leavingOut = scene;
  }
  if (const auto papers = root.find("papers")) sweep.papers = papersOf(*papers);
  if (sweep.lines.empty() && sweep.scaling.empty() && sweep.shadows.empty() && !sweep.stability &&
      !sweep.leavingOut && !sweep.papers)
    root.refuse(
        "there is nothing to measure; give scenes and methods, or one of scaling, shadows, stability, "
        "leavingOut, papers");
  return sweep;
}

}  // namespace

std::string MethodLine::label() const {
  std::string text = method;
  for (const auto& [name, value] : options) text += fmt::format(" {}={}", name, value);
  return text;
}

Sweep parseSweep(const std::string& text, const std::string& where, const fs::path& folder) {
  return Parser(where, folder).parse(text);
}

Sweep loadSweep(const std::string& name) {
  std::string names;
  for (const BuiltInSweep& builtIn : builtInSweeps()) {
    names += (names.empty() ? "" : ", ") + std::string(builtIn.name);
    if (builtIn.name != name) continue;
    Sweep sweep = parseSweep(std::string(builtIn.json), "sweep " + name, {});
    sweep.name = name;
    return sweep;
  }
  std::ifstream file(name, std::ios::binary);
  std::error_code error;
  if (!file || fs::is_directory(name, error)) {
    if (name.find('.') == std::string::npos && name.find('/') == std::string::npos)
      throw UsageError(fmt::format("there is no sweep '{}'; there are {}, or give a JSON file", name, names));
    throw InputError(fmt::format("cannot read '{}'; give a JSON file or one of {}", name, names));
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Sweep sweep = parseSweep(text, "'" + name + "'", fs::path(name).parent_path());
  sweep.name = fs::path(name).stem().string();
  return sweep;
}

fs::path findMolecule(const std::string& name) {
  std::error_code error;
  fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    for (const char* place : {"share/meniscus/molecules", "molecules"}) {
      const fs::path path = folder / place / name;
      if (fs::is_regular_file(path, error)) return path;
    }
  }
  return {};
}

}  // namespace meniscus::measure
