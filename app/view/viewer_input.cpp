// What mouse and keyboard do in the viewer (viewer.h).

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "app/panels.h"
#include "app/view/camera_moves.h"
#include "app/view/viewer.h"

namespace meniscus {
namespace {

// A click whose mouse moved no farther than this is none [window's units].
constexpr double kClick = 4;
// Of the distance, for a step of the wheel.
constexpr double kDolly = 0.88;
// Of the scene's diameter, for a step of the wheel.
constexpr double kClipStep = 0.01;
// What a double click shows around the atom [Å]: a binding site.
constexpr double kFocus = 8;
constexpr double kLightRadPerPixel = 0.006;
constexpr double kKeyTurnDeg = 10;
constexpr double kGrip = 6;  // of the divider, on each side [window's units]

// Down now, or until now: what the mouse did before it was let go belongs to its drag.
bool held(int button) {
  const ImGuiIO& io = ImGui::GetIO();
  return io.MouseDown[button] || io.MouseReleased[button];
}

glm::dvec2 of(const ImVec2& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

std::vector<PanelPlace> placesOf(const Document& document, ImageSize size) {
  const std::size_t panels = document.values("panel").size();
  if (panels < 2 || panels > kMostPanels) return {};
  const std::optional<std::string> divider = document.value("divider");
  return placePanels(panels, size,
                     divider ? std::optional(parseNumber("--divider", *divider, 0, 1)) : std::nullopt);
}

}  // namespace

glm::dvec2 Viewer::cursor() const {
  const glm::dvec2 mouse = of(ImGui::GetIO().MousePos);
  const double scale = window_.pixelsPerUnit();
  return {(mouse.x - area_.x) * scale, size_.height - (mouse.y - area_.y) * scale};
}

std::vector<Viewer::Part> Viewer::parts() const {
  std::vector<Part> parts;
  for (const PanelPlace& place : placesOf(*documents_[current_].document, size_))
    parts.push_back({place.picture, {place.pictureX, size_.height - place.pictureY - place.picture.height}});
  if (parts.empty()) parts.push_back({size_, {0, 0}});
  return parts;
}

Viewer::Part Viewer::partAt(glm::dvec2 pixel) const {
  const std::vector<PanelPlace> places = placesOf(*documents_[current_].document, size_);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].holds(pixel.x, size_.height - pixel.y)) return parts()[i];
  return parts().front();
}

// Where the divider is, if the cursor is on it.
std::optional<double> Viewer::dividerAt(glm::dvec2 pixel) const {
  const std::optional<std::string> divider = documents_[current_].document->value("divider");
  if (!divider) return std::nullopt;
  const double at = parseNumber("--divider", *divider, 0, 1) * size_.width;
  return std::abs(pixel.x - at) < kGrip * window_.pixelsPerUnit() ? std::optional(at) : std::nullopt;
}

std::uint32_t Viewer::idAt(glm::dvec2 pixel) const {
  if (!hits_ || !(pixel.x >= 0 && pixel.y >= 0)) return 0;
  const auto x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
  const ImageSize size = hits_->image.size;
  if (x >= size.width || y >= size.height) return 0;
  return hits_->image
      .id[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
}

const Scene& Viewer::sceneAt(glm::dvec2 pixel) const {
  const Picture& picture = hits_->preparation->pictures[hits_->shown];
  for (std::size_t i = 0; i < hits_->places.size(); ++i)
    if (hits_->places[i].holds(pixel.x, hits_->image.size.height - pixel.y)) return picture.panels[i].scene;
  return picture.scene;
}

std::optional<PlacedAtom> Viewer::atomAt(glm::dvec2 pixel) const {
  const std::uint32_t id = idAt(pixel);
  return id == 0 ? std::nullopt : atomOfId(sceneAt(pixel), id);
}

void Viewer::handleMouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::dvec2 now = cursor();
  const glm::dvec2 before = std::exchange(lastCursor_, now);
  if (!document()) return;
  const bool free = !io.WantCaptureMouse;
  const bool anyDown = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
  if (free && io.MouseWheel != 0) handleWheel(static_cast<double>(io.MouseWheel));
  if (free && io.MouseDoubleClicked[0]) {
    // The first of the two clicks has picked the atom.
    if (wantedPick_)
      wantedPick_.reset();
    else if (const auto atom = atomAt(now);
             atom && !document()->picks.empty() && document()->picks.back().position == atom->position)
      document()->picks.pop_back();
    wantedPick_ = WantedPick{now, true};
    pressed_ = false;
    resolvePick();
    return;
  }
  if (free && anyDown && !dragging_ && !pressed_) {
    pressed_ = true;
    pressedAt_ = now;
    onDivider_ = io.MouseDown[0] && dividerAt(now).has_value();
  }
  const double scale = window_.pixelsPerUnit();
  if (pressed_ && glm::length(now - pressedAt_) > kClick * scale) {
    dragging_ = true;
    pressed_ = false;
  }
  if (free && (onDivider_ || (!anyDown && dividerAt(now)))) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  const bool anyHeld = held(0) || held(1) || held(2);
  if (dragging_ && anyHeld && onDivider_) {
    document()->set("divider", fmt::format("{:.4f}", std::clamp(now.x / size_.width, 0.0, 1.0)), true);
    moving_ = true;
  } else if (dragging_ && anyHeld && now != before) {
    if (const auto from = camera()) handleDrag(*from, before, now);
  }
  if (pressed_ && !anyDown) {
    wantedPick_ = WantedPick{pressedAt_, false};
    resolvePick();
  }
  if (!anyDown) {
    if (dragging_) document()->endChange();
    dragging_ = pressed_ = onDivider_ = false;
  }
  hover_.clear();
  if (free && !anyDown && finished())
    if (const auto atom = atomAt(now)) hover_ = nameOf(*atom->molecule, atom->atom);
}

void Viewer::handleDrag(const Camera& from, glm::dvec2 before, glm::dvec2 now) {
  const ImGuiIO& io = ImGui::GetIO();
  const Part part = partAt(pressedAt_);
  before -= part.corner;
  now -= part.corner;
  if (held(0) && io.KeyCtrl) {
    dragLight(now - before);
  } else if (held(0) && !io.KeyShift) {
    moveCamera(turned(from, part.size, before, now));
  } else {
    moveCamera(panned(from, part.size, before, now));
  }
}

void Viewer::dragLight(glm::dvec2 by) {
  const RenderOptions* shown = options();
  if (!shown) return;
  glm::dvec3 direction = shown->keyDirection.value_or(Lighting{}.key.direction);
  if (const auto given = document()->value("light-direction"))
    direction = parseDirection("--light-direction", *given);
  const glm::dvec2 angles = by * kLightRadPerPixel / window_.pixelsPerUnit();
  const glm::dquat turn =
      glm::angleAxis(angles.x, glm::dvec3(0, 1, 0)) * glm::angleAxis(-angles.y, glm::dvec3(1, 0, 0));
  direction = glm::normalize(turn * direction);
  document()->set("light-direction",
                  fmt::format("{:.3f},{:.3f},{:.3f}", direction.x, direction.y, direction.z), true);
  moving_ = true;
}

void Viewer::handleWheel(double steps) {
  const std::optional<Camera> from = camera();
  if (!from || !frame_) return;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl) {
    const double share = kClipStep * steps;
    moveCamera(io.KeyShift ? clippedBehindBy(*from, frame_->bounds, share)
                           : clippedBy(*from, frame_->bounds, share));
  } else {
    const Part part = partAt(cursor());
    moveCamera(dollied(*from, part.size, cursor() - part.corner, std::pow(kDolly, steps)));
  }
}

// When the picture is finished: before, nobody knows what was clicked.
void Viewer::resolvePick() {
  if (!wantedPick_ || !finished() || !document()) return;
  const WantedPick wanted = *std::exchange(wantedPick_, std::nullopt);
  const std::optional<PlacedAtom> atom = atomAt(wanted.pixel);
  if (!atom) {
    if (!wanted.focus) document()->picks.clear();
    return;
  }
  if (wanted.focus) {
    document()->camera = focusedOn(*camera(), parts().front().size, {atom->position, kFocus});
    return;
  }
  const Molecule& shown = *atom->molecule;
  const std::vector<const SceneObject*> objects = objectsByMolecule(sceneAt(wanted.pixel));
  const auto object = std::find_if(objects.begin(), objects.end(),
                                   [&](const SceneObject* o) { return o->molecule == atom->molecule; });
  const bool first = atom->position == glm::dvec3((*object)->placements.front().transform *
                                                  glm::dvec4(shown.positions[atom->atom], 1.0));
  document()->pick({cidOf(shown, atom->atom), nameOf(shown, atom->atom), atom->position, !first,
                    static_cast<std::size_t>(object - objects.begin())});
}

// Models that lie over each other come one by one then.
void Viewer::play() {
  const Preparation* made = preparation();
  const bool several = made && (made->modelCount > 1 || made->pictures.size() > 1);
  playing = several;
  if (several && !document()->isScene()) document()->oneByOne = true;
  if (!several) say("there is only one model to be shown");
}

void Viewer::handleKey(int key, bool control, bool shift) {
  const auto turn = [&](double right, double up) {
    if (const auto now = camera()) {
      Camera turned = *now;
      turned.orientation = rotatedBy(turned.orientation, glm::dvec3(-up, right, 0) * kKeyTurnDeg);
      moveCamera(turned);
    }
  };
  Document* shown = document();
  if (control) {
    switch (key) {
      case GLFW_KEY_Q:
        window_.close();
        return;
      case GLFW_KEY_S:
        save();
        return;
      case GLFW_KEY_C:
        shift ? copyMeasures() : copyCommand();
        return;
      case GLFW_KEY_Z:
        if (shown && !(shift ? shown->redo() : shown->undo())) say("there is nothing to undo");
        return;
      case GLFW_KEY_Y:
        if (shown && !shown->redo()) say("there is nothing to redo");
        return;
      default:
        return;
    }
  }
  if (shown && key >= GLFW_KEY_1 && key <= GLFW_KEY_8) {
    if (shown->isScene())
      say("a scene says itself how its atoms are drawn");
    else
      shown->set("representation", std::string(representationName(
                                       kRepresentationsOffered[static_cast<std::size_t>(key - GLFW_KEY_1)])));
    return;
  }
  switch (key) {
    case GLFW_KEY_F1:
    case GLFW_KEY_H:
      helpShown = !helpShown;
      return;
    case GLFW_KEY_TAB:
      panelsShown = !panelsShown;
      return;
    case GLFW_KEY_B:
      budgetShown = !budgetShown;
      return;
    case GLFW_KEY_R:
      resetCamera();
      return;
    case GLFW_KEY_P:
      lookAlong(-1);
      return;
    case GLFW_KEY_X:
      lookAlong(0);
      return;
    case GLFW_KEY_Y:
      lookAlong(1);
      return;
    case GLFW_KEY_Z:
      lookAlong(2);
      return;
    case GLFW_KEY_O:
      toggleOrthographic();
      return;
    case GLFW_KEY_M:
      keepMeasure();
      return;
    case GLFW_KEY_F5:
      reread();
      return;
    case GLFW_KEY_SPACE:
      playing = !playing;
      if (playing) play();
      return;
    case GLFW_KEY_LEFT:
      turn(-1, 0);
      return;
    case GLFW_KEY_RIGHT:
      turn(1, 0);
      return;
    case GLFW_KEY_UP:
      turn(0, 1);
      return;
    case GLFW_KEY_DOWN:
      turn(0, -1);
      return;
    case GLFW_KEY_PAGE_DOWN:
      showDocument(current_ + 1);
      return;
    case GLFW_KEY_PAGE_UP:
      showDocument(current_ - 1);
      return;
    case GLFW_KEY_ESCAPE:
      helpShown = false;
      message_.clear();
      if (shown) shown->picks.clear();
      return;
    default:
      return;
  }
}

}  // namespace meniscus
