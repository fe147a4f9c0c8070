// The widgets about light as the mouse moves them, without a window.

#include "app/view/light_widgets.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <map>
#include <string>

namespace meniscus {
namespace {

constexpr float kHeight = 600;

class LightWidgets : public testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.DisplaySize = {400, kHeight};
    io.DeltaTime = 0.02f;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  /// One picture of the widgets, of the options that the document has now.
  void frame() {
    if (document.revision() != revision_) options_ = parseSettings(asArguments(document.given()));
    revision_ = document.revision();
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({400, kHeight});
    ImGui::Begin("w", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove);
    ImGui::PushItemWidth(200);
    lightWidgets(document, options_);
    ImGui::PopItemWidth();
    tree_ = ImGui::GetID("traced rays");
    ImGui::End();
    ImGui::EndFrame();
  }
  /// Puts the mouse on one of the tree's widgets, `x` from the left; whether it is there.
  bool pointAt(const char* label, float x) {
    const ImGuiID id = ImHashStr(label, 0, tree_);
    for (float y = 2; y < kHeight; y += 4) {
      ImGui::GetIO().MousePos = {x, y};
      frame();
      frame();
      if (ImGui::GetHoveredID() == id) return true;
    }
    return false;
  }
  /// Drags the widget's slider from its left end to there.
  void slide(const char* label, float to) {
    ImGuiIO& io = ImGui::GetIO();
    frame();
    ASSERT_TRUE(pointAt(label, 40)) << label;
    io.MouseDown[0] = true;
    for (float x = 40; x <= to; x += 10) {
      io.MousePos.x = x;
      frame();
    }
    io.MouseDown[0] = false;
    for (int i = 0; i < 3; ++i) frame();
  }
  void click(const char* label) {
    frame();
    ASSERT_TRUE(pointAt(label, 40)) << label;
    for (const bool down : {true, false, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      frame();
    }
  }
  bool has(const char* label) {
    frame();
    return pointAt(label, 40);
  }

  Document document{"a.pdb", {}};
  RenderOptions options_;
  std::uint64_t revision_ = 0;
  ImGuiID tree_ = 0;
};

TEST_F(LightWidgets, RaysAreOptionsAndOneStepEach) {
  const std::map<const char*, std::string> sliders{{"shadow rays", "trace-shadows"},
                                                   {"occlusion rays", "trace-ao"},
                                                   {"mirrors", "reflect"},
                                                   {"glass", "refract"}};
  for (const auto& [label, option] : sliders) {
    const GivenOptions before = document.given();
    slide(label, 120);
    ASSERT_TRUE(document.has(option)) << label;
    const std::string value = *document.value(option);
    EXPECT_GT(std::stoi(value), 2) << option;
    EXPECT_NE(commandLine(renderArguments(document, {}, {8, 8}, "o.png")).find("--" + option + "=" + value),
              std::string::npos);
    EXPECT_TRUE(document.undo());
    EXPECT_EQ(document.given(), before) << "the whole drag is one step";
    EXPECT_TRUE(document.redo());
    EXPECT_EQ(document.value(option), value);
  }
}

TEST_F(LightWidgets, GlassHasAColourAndADepthOfIt) {
  document.set("reflect", "2");
  EXPECT_FALSE(has("deep"));
  document.set("refract", "4");
  EXPECT_FALSE(has("deep")) << "clear glass has none";
  document.set("attenuation-color", "#80C0FF");
  slide("deep", 120);
  ASSERT_TRUE(document.has("attenuation-distance"));
  EXPECT_GT(std::stod(*document.value("attenuation-distance")), 1);
  EXPECT_LT(std::stod(*document.value("attenuation-distance")), 200);
}

TEST_F(LightWidgets, WhatOnlyMirrorsNeedIsShownWithThem) {
  EXPECT_FALSE(has("refractive index"));
  EXPECT_FALSE(has("show the background"));
  document.set("reflect", "2");
  slide("refractive index", 180);
  ASSERT_TRUE(document.has("refractive-index"));
  EXPECT_GT(std::stod(*document.value("refractive-index")), 1.5);
  click("show the background");
  EXPECT_EQ(document.value("environment"), "background");
  click("show the background");
  EXPECT_EQ(document.value("environment"), "sky");
  EXPECT_TRUE(document.undo());
  EXPECT_EQ(document.value("environment"), "background");
}

}  // namespace
}  // namespace meniscus
