#include "app/view/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>

#include "app/measurement.h"
#include "app/picture_drawer.h"
#include "app/style.h"
#include "app/view/light_widgets.h"
#include "app/view/option_widgets.h"
#include "app/view/viewer.h"
#include "render/surface_method.h"

namespace meniscus {
namespace {

void filesPanel(Viewer& viewer) {
  for (std::size_t i = 0; i < viewer.documentCount(); ++i) {
    const std::string name = std::filesystem::path(viewer.fileOf(i)).filename().string();
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(name.c_str(), i == viewer.current())) viewer.showDocument(i);
    ImGui::PopID();
  }
  const Preparation* made = viewer.preparation();
  if (!made) return;
  const std::size_t remarks = made->notes.size() + made->unsupported.size();
  if (remarks > 0 && ImGui::TreeNode("remarks", "remarks: %zu", remarks)) {
    for (const auto* lines : {&made->unsupported, &made->notes})
      for (const std::string& line : *lines) ImGui::TextWrapped("%s", line.c_str());
    ImGui::TreePop();
  }
}

void picturePanel(Viewer& viewer) {
  const ImageSize size = viewer.pictureSize();
  ImGui::Text("%d x %d pixels", size.width, size.height);
  if (ImGui::Button("Save")) viewer.save();
  ImGui::SameLine();
  if (ImGui::Button("Copy command")) viewer.copyCommand();
  ImGui::SameLine();
  if (ImGui::Button("Help")) viewer.helpShown = true;
  ImGui::SameLine();
  if (ImGui::Button("Times")) viewer.budgetShown = !viewer.budgetShown;
  Document& document = *viewer.document();
  ImGui::BeginDisabled(!document.canUndo());
  if (ImGui::Button("Undo")) document.undo();
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!document.canRedo());
  if (ImGui::Button("Redo")) document.redo();
  ImGui::EndDisabled();
}

// The options of a style in place of those that any style is made of.
void applyStyle(Document& document, const Style& style) {
  GivenOptions given = document.given();
  const auto optionsOf = [](const Style& s) {
    GivenOptions options;
    std::istringstream words{std::string(s.options)};
    for (std::string name, value; words >> name >> value;) options.emplace_back(name.substr(2), value);
    return options;
  };
  for (const Style& other : styles())
    for (const auto& [name, value] : optionsOf(other))
      std::erase_if(given,
                    [&](const auto& option) { return option.first == name || option.first == "style"; });
  for (auto& option : optionsOf(style)) given.push_back(std::move(option));
  document.replace(std::move(given));
}

void lookPanel(Viewer& viewer, const RenderOptions& o) {
  Document& document = *viewer.document();
  if (document.isScene()) {
    ImGui::TextWrapped("The scene says how its atoms are drawn.");
  } else {
    std::string word =
        document.value("representation").value_or(std::string(representationName(o.representation)));
    if (representationCombo("drawn as", word)) document.set("representation", word);
    std::string coloring = document.value("color").value_or(coloringName(o.coloring));
    if (coloringCombo("coloured by", coloring)) document.set("color", coloring, coloring.starts_with('#'));
    if (ImGui::IsItemDeactivatedAfterEdit()) document.endChange();
    optionCheck(document, "carbons by chain", "carbons", o.coloring.carbonsByChain, "chain", "element");
  }
  if (ImGui::BeginCombo("style", "choose")) {
    for (const Style& style : styles())
      if (ImGui::Selectable(std::string(style.name).c_str())) applyStyle(document, style);
    ImGui::EndCombo();
  }
}

void selectionsPanel(Viewer& viewer, const RenderOptions& o) {
  Document& document = *viewer.document();
  std::vector<std::string> shown = document.values("show");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const ShownApart apart = parseShown("--show", shown[i]);
    ImGui::TextUnformatted(apart.cid.c_str());
    ImGui::SameLine();
    const bool removed = ImGui::SmallButton("remove");
    std::string representation(representationName(apart.representation));
    std::string coloring = coloringName(apart.coloring.value_or(o.coloring));
    bool changed = representationCombo("drawn as", representation);
    const bool recolored = coloringCombo("coloured by", coloring);
    if (ImGui::IsItemDeactivatedAfterEdit()) document.endChange();
    changed = recolored || changed;
    ImGui::PopID();
    if (!removed && !changed) continue;
    if (removed) {
      shown.erase(shown.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      shown[i] = fmt::format("{}={}:{}", apart.cid, representation, coloring);
    }
    document.setAll("show", shown, recolored && coloring.starts_with('#'));
    return;
  }
  const bool entered = ImGui::InputTextWithHint("##cid", "//A/10-20 or (HEM)", &viewer.newSelection,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  std::vector<std::string> added;
  if ((ImGui::Button("Add") || entered) && !viewer.newSelection.empty()) added.push_back(viewer.newSelection);
  if (!document.picks.empty() && ImGui::Button("Add the residues of the picks")) {
    for (const Pick& pick : document.picks) {
      const std::string residue = pick.cid.substr(0, pick.cid.rfind('/'));
      if (!residue.empty() && std::find(added.begin(), added.end(), residue) == added.end())
        added.push_back(residue);
    }
  }
  if (added.empty()) return;
  for (const std::string& cid : added) shown.push_back(cid + "=ball_and_stick:element");
  viewer.newSelection.clear();
  document.setAll("show", shown);
}

void moleculePanel(Viewer& viewer, const RenderOptions& o) {
  Document& document = *viewer.document();
  const Molecule* molecule = viewer.molecule();
  if (!molecule) return;
  ImGui::Text("%zu atoms, %zu residues", molecule->atomCount(), molecule->residues.size());
  if (document.isScene()) return;
  if (ImGui::TreeNodeEx("chains", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const Chain& chain : molecule->chains) {
      if (chain.name.empty()) continue;
      optionMember(document, fmt::format("{} ({} residues)", chain.name, chain.residues.count).c_str(),
                   "hide", "//" + chain.name, true);
    }
    ImGui::TreePop();
  }
  std::map<std::string, int> ligands;
  for (const Residue& residue : molecule->residues)
    if (residue.kind == ResidueKind::ligand || residue.kind == ResidueKind::ion ||
        residue.kind == ResidueKind::saccharide)
      ++ligands[residue.name];
  if (!ligands.empty() && ImGui::TreeNodeEx("ligands", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const auto& [name, count] : ligands)
      optionMember(document, fmt::format("{} ({})", name, count).c_str(), "hide", fmt::format("({})", name),
                   true);
    ImGui::TreePop();
  }
  optionCheck(document, "waters", "waters", o.structure.waters == Waters::on, "on", "off");
  optionCheck(document, "hydrogens", "hydrogens", o.structure.hydrogens, "on", "off");
}

void outlineChecks(Document& document, const RenderOptions& o) {
  bool silhouettes = o.lines.silhouettes, creases = o.lines.creases,
       chains = o.lines.groups == LineGroups::chains;
  bool changed = ImGui::Checkbox("silhouettes", &silhouettes);
  ImGui::SameLine();
  changed = ImGui::Checkbox("creases", &creases) || changed;
  ImGui::SameLine();
  changed = ImGui::Checkbox("chains##lines", &chains) || changed;
  if (!changed) return;
  std::string list;
  const auto add = [&](bool wanted, const char* word) {
    if (wanted) list += (list.empty() ? "" : ",") + std::string(word);
  };
  add(silhouettes, "silhouettes");
  add(creases, "creases");
  add(chains, "chains");
  document.set("outlines", list.empty() ? "off" : list);
}

void effectsPanel(Viewer& viewer, const RenderOptions& o) {
  Document& document = *viewer.document();
  const RenderSettings drawn = renderSettingsOf(o);  // what is traced is on
  static constexpr const char* kShadows[] = {"off", "hard", "soft"};
  optionCombo(document, "shadows", "shadows", kShadows,
              kShadows[static_cast<std::size_t>(drawn.shadows.mode)]);
  if (drawn.shadows.mode == ShadowMode::soft)
    optionSlider(document, "penumbra", "penumbra", o.shadows.penumbra, 0.1, 30, "%.1f Å", true);
  optionCheck(document, "ambient occlusion", "occlusion", drawn.occlusion.on, "on", "off");
  if (drawn.occlusion.on) {
    optionSlider(document, "reach", "occlusion-radius", o.occlusion.radius, 1, 200, "%.0f Å", true);
    optionSlider(document, "strength##ao", "occlusion-strength", o.occlusion.strength, 0, 1, "%.2f");
  }
  outlineChecks(document, o);
  if (o.lines.any())
    optionSlider(document, "line width", "line-width", o.lines.width, 0.5, kMaxLineWidth, "%.1f pixels");
  static constexpr const char* kUnsharp[] = {"off", "both", "halo"};
  optionCombo(document, "depth unsharp", "depth-unsharp", kUnsharp,
              kUnsharp[static_cast<std::size_t>(o.depthUnsharp.mode)]);
  optionSlider(document, "fog", "fog", o.fog.strength, 0, 1, "%.2f");
  optionSlider(document, "rays a pixel", "samples", o.samples, 1, 64);
  optionCheck(document, "level of detail", "level-of-detail", o.levelOfDetail, "on", "off");
  std::string background = document.value("background").value_or("white");
  if (ImGui::BeginCombo("background", background.c_str())) {
    for (const char* word : {"white", "black", "transparent"})
      if (ImGui::Selectable(word)) document.set("background", word);
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  optionColor(document, "##background", "background", o.background.color);
}

void surfaceStats(const Viewer& viewer) {
  const ViewFrame* frame = viewer.fullFrame();
  if (!frame) return;
  for (const SurfaceStats& stats : frame->stats.surfaces) {
    ImGui::Text("%s", stats.method.c_str());
    const auto line = [](const char* name, std::uint64_t count) {
      ImGui::BulletText("%s: %llu", name, static_cast<unsigned long long>(count));
    };
    line("rays", stats.pixels);
    line("pieces", stats.pieces);
    line("iterations", stats.iterations);
    line("most of one ray", stats.mostIterations);
    line("done again", stats.overflow);
    line("grazing", stats.grazing);
    line("not converged", stats.notConverged);
    for (const auto& [name, value] : stats.details) ImGui::BulletText("%s: %g", name.c_str(), value);
  }
}

void surfacePanel(Viewer& viewer, const RenderOptions& o) {
  Document& document = *viewer.document();
  std::vector<const char*> methods{"auto"};
  for (const SurfaceMethodInfo& method : surfaceMethods()) methods.push_back(method.name.data());
  optionCombo(document, "method", "surface-method", methods, o.surface.method);
  optionSlider(document, "opacity", "opacity", o.surface.opacity, 0, 1, "%.2f");
  if (!document.isScene()) {
    optionSlider(document, "blend", "blend", o.surfaceShape.blend, 1.05, 10, "%.2f", true);
  }
  surfaceStats(viewer);
}

void cameraPanel(Viewer& viewer, const RenderOptions& o) {
  Document& document = *viewer.document();
  if (ImGui::Button("Reset")) viewer.resetCamera();
  ImGui::SameLine();
  if (ImGui::Button("Flattest")) viewer.lookAlong(-1);
  for (int axis = 0; axis < 3; ++axis) {
    ImGui::SameLine();
    if (ImGui::Button(std::string(1, static_cast<char>('x' + axis)).c_str())) viewer.lookAlong(axis);
  }
  optionFlag(document, "orthographic", "orthographic");
  optionSlider(document, "field of view", "fov", o.fovYDeg, 5, 120, "%.0f°");
  std::optional<Camera> camera = viewer.camera();
  if (!camera) return;
  const auto plane = [&](const char* text, std::optional<double>& at) {
    if (!at) return;
    ImGui::Text(text, *at);
    ImGui::SameLine();
    ImGui::PushID(text);
    if (ImGui::SmallButton("nothing")) {
      at.reset();
      viewer.moveCamera(*camera);
    }
    ImGui::PopID();
  };
  plane("cut off before %.1f Å", camera->nearest);
  plane("cut off behind %.1f Å", camera->farthest);
}

void comparePanel(Viewer& viewer) {
  Document& document = *viewer.document();
  std::vector<std::string> panels = document.values("panel");
  bool changed = false;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    changed = ImGui::InputText("##panel", &panels[i], ImGuiInputTextFlags_EnterReturnsTrue) || changed;
    ImGui::PopID();
  }
  if (panels.size() < 2) {
    if (ImGui::Button("Beside each other")) {
      panels = {"ball_and_stick", "surface"};
      changed = true;
    }
  } else {
    if (ImGui::Button("One fewer")) {
      panels.pop_back();
      if (panels.size() == 1) panels.clear();
      changed = true;
    }
    ImGui::SameLine();
    if (!panels.empty() && panels.size() < kMostPanels && ImGui::Button("One more")) {
      panels.emplace_back("cartoon");
      changed = true;
    }
  }
  if (panels.size() == 2 && !changed) {
    bool divided = document.has("divider");
    if (ImGui::Checkbox("one picture with a divider to drag", &divided)) {
      if (divided) {
        document.set("divider", "0.5");
      } else {
        document.remove("divider");
      }
    }
  }
  if (!changed) return;
  GivenOptions given = document.given();
  std::erase_if(given, [&](const auto& option) {
    return option.first == "panel" || (option.first == "divider" && panels.size() != 2);
  });
  for (const std::string& panel : panels) given.emplace_back("panel", panel);
  document.replace(std::move(given));
}

void modelsPanel(Viewer& viewer) {
  Document& document = *viewer.document();
  const Preparation* made = viewer.preparation();
  if (!made) return;
  if (!document.isScene()) {
    ImGui::Text("%d models in the file", made->modelCount);
    if (ImGui::Checkbox("one by one", &document.oneByOne)) viewer.playing = false;
    if (!document.oneByOne) {
      bool all = document.value("model").value_or("") == "all";
      if (ImGui::Checkbox("all together", &all)) {
        if (all)
          document.set("model", "all");
        else
          document.remove("model");
      }
    }
  }
  if (made->pictures.size() < 2) return;
  int shown = static_cast<int>(std::min(document.shown, made->pictures.size() - 1));
  const OutputPlace& place = made->pictures[static_cast<std::size_t>(shown)].place;
  const std::string name = document.isScene() ? place.state : fmt::format("model {}", place.model);
  if (ImGui::SliderInt("##shown", &shown, 0, static_cast<int>(made->pictures.size()) - 1, name.c_str()))
    viewer.showModel(static_cast<std::size_t>(shown));
  if (ImGui::Button(viewer.playing ? "Stop" : "Play")) viewer.playing = !viewer.playing;
  ImGui::SameLine();
  auto speed = static_cast<float>(viewer.modelsPerSecond);
  if (ImGui::SliderFloat("speed", &speed, 0.5f, 30, "%.1f a second", ImGuiSliderFlags_Logarithmic))
    viewer.modelsPerSecond = static_cast<double>(speed);
}

void measuresPanel(Viewer& viewer) {
  Document& document = *viewer.document();
  std::vector<glm::dvec3> points;
  for (const Pick& pick : document.picks) {
    ImGui::BulletText("%s", pick.name.c_str());
    points.push_back(pick.position);
  }
  if (points.empty()) ImGui::TextDisabled("Click atoms: two, three, four measure.");
  if (points.size() >= 2) {
    ImGui::TextUnformatted(measureText(points).c_str());
    if (ImGui::Button("Keep in the picture")) viewer.keepMeasure();
    ImGui::SameLine();
    if (ImGui::Button("Copy")) viewer.copyMeasures();
  }
  std::vector<std::string> kept = document.values("measure");
  for (std::size_t i = 0; i < kept.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const bool removed = ImGui::SmallButton("remove");
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::TextWrapped("%s", kept[i].c_str());
    if (!removed) continue;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
    document.setAll("measure", kept);
    return;
  }
}

}  // namespace

double panelWidth(const Viewer& viewer) {
  return kPanelWidth * viewer.contentScale();
}

void drawPanels(Viewer& viewer, double height) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({static_cast<float>(panelWidth(viewer)), static_cast<float>(height)});
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("panels", nullptr, kFixed)) {
    ImGui::PushItemWidth(static_cast<float>(0.5 * panelWidth(viewer)));
    constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
    if (viewer.documentCount() > 0 && ImGui::CollapsingHeader("Files", kOpen)) filesPanel(viewer);
    if (const RenderOptions* options = viewer.options(); options && viewer.document()) {
      const bool structure = !viewer.document()->isScene();
      if (ImGui::CollapsingHeader("Picture", kOpen)) picturePanel(viewer);
      if (ImGui::CollapsingHeader("Look", kOpen)) lookPanel(viewer, *options);
      if (structure && ImGui::CollapsingHeader("Selections")) selectionsPanel(viewer, *options);
      if (ImGui::CollapsingHeader("Molecule")) moleculePanel(viewer, *options);
      if (ImGui::CollapsingHeader("Effects")) effectsPanel(viewer, *options);
      if (ImGui::CollapsingHeader("Light")) lightWidgets(*viewer.document(), *options);
      if (ImGui::CollapsingHeader("Surface")) surfacePanel(viewer, *options);
      if (ImGui::CollapsingHeader("Camera")) cameraPanel(viewer, *options);
      if (structure && ImGui::CollapsingHeader("Compare")) comparePanel(viewer);
      if ((viewer.preparation()->modelCount > 1 || viewer.preparation()->pictures.size() > 1) &&
          ImGui::CollapsingHeader("Models", kOpen))
        modelsPanel(viewer);
      if (ImGui::CollapsingHeader("Measures", kOpen)) measuresPanel(viewer);
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
}

}  // namespace meniscus
