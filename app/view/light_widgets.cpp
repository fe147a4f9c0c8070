#include "app/view/light_widgets.h"

#include <imgui.h>

#include "app/picture_drawer.h"
#include "app/view/option_widgets.h"

namespace meniscus {
namespace {

constexpr Rgb kClear = 0xFFFFFF;
// Sliders end here; the options take more.
constexpr int kMostRays = 256;
constexpr double kMostUsualIndex = 3, kLeastUsualWay = 0.5, kMostUsualWay = 200;

void traceWidgets(Document& document, const TraceSettings& trace) {
  optionSlider(document, "shadow rays", "trace-shadows", trace.shadows, 0, kMostRays);
  optionSlider(document, "occlusion rays", "trace-ao", trace.occlusion, 0, kMostRays);
  optionSlider(document, "mirrors", "reflect", trace.reflect, 0, kMaxBounces);
  optionSlider(document, "glass", "refract", trace.refract, 0, kMaxBounces);
  if (!trace.light()) return;
  optionSlider(document, "refractive index", "refractive-index", trace.index, 1, kMostUsualIndex, "%.2f");
  if (trace.refract > 0) {
    optionColor(document, "colour of the glass", "attenuation-color", trace.attenuationColor);
    if (trace.attenuationColor != kClear)
      optionSlider(document, "deep", "attenuation-distance", trace.attenuationDistance, kLeastUsualWay,
                   kMostUsualWay, "%.1f Å", true);
  }
  optionCheck(document, "show the background", "environment", trace.environment == Environment::background,
              "background", "sky");
}

}  // namespace

void lightWidgets(Document& document, const RenderOptions& o) {
  const Lighting light = lightOf(o);
  optionSlider(document, "key", "key-light", light.key.intensity, 0, 2, "%.2f");
  optionSlider(document, "fill", "fill-light", light.fill.intensity, 0, 2, "%.2f");
  optionSlider(document, "ambient", "ambient-light", light.ambient, 0, 2, "%.2f");
  optionSlider(document, "highlight", "highlight", light.specular, 0, 2, "%.2f");
  ImGui::TextDisabled("Ctrl drag turns the key light");
  if (document.has("light-direction") && ImGui::Button("Light from the upper left"))
    document.remove("light-direction");
  if (ImGui::TreeNodeEx("traced rays", ImGuiTreeNodeFlags_DefaultOpen)) {
    traceWidgets(document, o.trace);
    ImGui::TreePop();
  }
}

}  // namespace meniscus
