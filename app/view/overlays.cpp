#include "app/view/overlays.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "app/measurement.h"
#include "app/view/camera_moves.h"
#include "app/view/viewer.h"

namespace meniscus {
namespace {

constexpr ImU32 kMark = IM_COL32(255, 176, 0, 255), kShade = IM_COL32(0, 0, 0, 170),
                kText = IM_COL32(255, 255, 255, 255), kError = IM_COL32(255, 150, 130, 255);

ImVec2 vec(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

void textOnShade(ImDrawList& list, ImVec2 at, ImU32 color, const std::string& text, float wrap = 0) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, kShade, 3);
  list.AddText(nullptr, 0, at, color, text.c_str(), nullptr, wrap);
}

constexpr std::array<std::pair<const char*, const char*>, 29> kKeys{{
    {"drag", "turn"},
    {"Shift drag, right drag", "move"},
    {"wheel", "nearer, farther, to what is under the cursor"},
    {"Ctrl wheel", "cut away what is near"},
    {"Ctrl Shift wheel", "cut away what is far"},
    {"Ctrl drag", "move the light"},
    {"click", "pick an atom; two, three, four of them measure"},
    {"double click", "look at what is there"},
    {"Esc", "let go of what is picked"},
    {"M", "keep the measure in the picture"},
    {"Ctrl Shift C", "copy the measure"},
    {"R", "reset the camera"},
    {"P, X, Y, Z", "the flattest side to you; down an axis"},
    {"arrows", "turn by 10 degrees"},
    {"O", "perspective or orthographic"},
    {"1, 2, 3", "space-filling, ball and stick, licorice"},
    {"4, 5", "cartoon, surface"},
    {"6, 7, 8", "backbone, putty, ellipsoids"},
    {"Ctrl Z, Ctrl Y", "undo, redo"},
    {"Ctrl S", "save the picture"},
    {"Ctrl C", "copy the command that draws it"},
    {"Space", "play the models, or stop"},
    {"Page Up, Page Down", "the other files"},
    {"F5", "read the file again"},
    {"Tab", "panels"},
    {"B", "what the picture cost"},
    {"H, F1", "this"},
    {"Ctrl Q", "quit"},
    {"drop a file", "open it"},
}};

}  // namespace

void drawPicks(const std::vector<Pick>& picks, const Camera& camera, ImageSize size,
               const PicturePlace& place, double contentScale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto scale = static_cast<float>(contentScale);
  std::vector<glm::dvec3> points;
  std::optional<ImVec2> last;
  for (const Pick& pick : picks) {
    points.push_back(pick.position);
    const std::optional<glm::dvec2> pixel = pixelOf(camera, size, pick.position);
    if (!pixel) {
      last.reset();
      continue;
    }
    const ImVec2 at = vec(place.x + pixel->x / place.pixelsPerUnit,
                          place.y + place.height - pixel->y / place.pixelsPerUnit);
    if (last) list.AddLine(*last, at, kMark, 1.5f * scale);
    list.AddCircle(at, 7 * scale, IM_COL32(0, 0, 0, 255), 0, 4 * scale);
    list.AddCircle(at, 7 * scale, kMark, 0, 2 * scale);
    textOnShade(list, {at.x + 11 * scale, at.y - 8 * scale}, kText, pick.name);
    last = at;
  }
  if (points.size() >= 2 && last)
    textOnShade(list, {last->x + 11 * scale, last->y + 12 * scale}, kMark, measureText(points));
}

void drawStatus(const std::string& hover, const std::string& message, bool isError,
                const PicturePlace& place) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const double line = static_cast<double>(ImGui::GetTextLineHeight()) + 8;
  const double x = place.x + 10;
  double y = place.y + place.height - line;
  if (!message.empty()) {
    const float wrap = std::max(50.0f, ImGui::GetIO().DisplaySize.x - static_cast<float>(x) - 20);
    const double height = static_cast<double>(ImGui::CalcTextSize(message.c_str(), nullptr, false, wrap).y);
    y = place.y + place.height - height - 8;
    textOnShade(list, vec(x, y), isError ? kError : kText, message, wrap);
    y -= line;
  }
  if (!hover.empty()) textOnShade(list, vec(x, y), kText, hover);
}

void drawInvitation(const PicturePlace& place) {
  const char* text = "Drop a structure file or a scene here.   H: help";
  ImGui::GetBackgroundDrawList()->AddText(vec(place.x + 40, place.y + 0.5 * place.height), kText, text);
}

void drawHelp(bool& shown) {
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x * 0.5f, ImGui::GetIO().DisplaySize.y * 0.5f},
                          ImGuiCond_Always, {0.5f, 0.5f});
  if (ImGui::Begin("Help", &shown, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse) &&
      ImGui::BeginTable("keys", 2)) {
    for (const auto& [keys, what] : kKeys) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored({1, 0.7f, 0.2f, 1}, "%s", keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void drawBudget(const Viewer& viewer, bool& shown) {
  const ViewFrame* frame = viewer.frame();
  ImGui::SetNextWindowBgAlpha(0.85f);
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - 10, 10}, ImGuiCond_Appearing, {1, 0});
  if (ImGui::Begin("What the picture cost", &shown,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing) &&
      frame) {
    const char* stage = frame->stage == FrameStage::moving     ? "moving"
                        : frame->stage == FrameStage::refining ? "refining"
                                                               : "full";
    ImGui::Text("%s: %d x %d, %d rays a pixel, %.1f ms", stage, frame->size.width, frame->size.height,
                frame->samples, frame->milliseconds);
    ImGui::Text("input to picture %.0f ms, to full quality %.0f ms", viewer.latency().lastMovingMs(),
                viewer.latency().lastFullMs());
    ImGui::Text("window by %s", viewer.windowApi().c_str());
    if (ImGui::BeginTable("passes", 3)) {
      for (const PassStats& pass : frame->stats.passes) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(pass.name.c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.2f ms", pass.milliseconds);
        ImGui::TableNextColumn();
        ImGui::Text("%dx", pass.runs);
      }
      ImGui::EndTable();
    }
    ImGui::Separator();
    ImGui::TextUnformatted("Left out for the time:");
    if (frame->stage == FrameStage::moving) {
      ImGui::BulletText("all rays of a pixel but one");
      if (frame->size != frame->pictureSize)
        ImGui::BulletText("%.0f %% of the pixels", 100 - 100.0 * frame->size.width * frame->size.height /
                                                             frame->pictureSize.width /
                                                             frame->pictureSize.height);
      for (const std::string& cut : frame->leftOut) ImGui::BulletText("%s", cut.c_str());
    } else if (frame->stage == FrameStage::refining) {
      ImGui::BulletText("rays that are still to come");
    } else {
      ImGui::BulletText("nothing");
    }
    if (ImGui::CollapsingHeader("Left out because nobody needs it"))
      for (const OmissionStats& omission : frame->stats.omissions)
        ImGui::BulletText("%s: %s", omission.what.c_str(), omission.reason.c_str());
  }
  ImGui::End();
}

}  // namespace meniscus
