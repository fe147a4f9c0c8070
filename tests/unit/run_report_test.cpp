#include "app/run_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace meniscus {
namespace {

RunReport exampleReport() {
  RunReport report;
  report.backend = "EGL device 0";
  report.renderer = "llvmpipe";
  report.size = {640, 480};
  report.samples = 4;
  report.pictures = {
      {.input = "a.pdb", .output = "a.png", .atoms = 327, .spheres = 327, .size = {640, 480}, .samples = 4}};
  report.failures = {"'b\xFF.pdb': no atoms"};
  report.parseSeconds = 0.5;
  report.totalSeconds = 2;
  report.render.passes = {{"spheres", 4, 12.5}};
  report.render.omissions = {{"pass cylinders", "no bonds in this scene"}};
  report.render.programs = {"sphere"};
  report.render.buffers = {{"spheres", 9156}};
  report.render.drawMs = 350;
  report.render.compileMs = 100;  // which the clock for drawing includes
  return report;
}

TEST(StatsAsJson, saysWhatWasDoneAndWhatItCost) {
  const nlohmann::json json = nlohmann::json::parse(statsAsJson(exampleReport()));
  EXPECT_EQ(json["backend"], "EGL device 0");
  EXPECT_EQ(json["pictures"][0]["spheres"], 327);
  EXPECT_EQ(json["failures"].size(), 1u);
  EXPECT_EQ(json["seconds"]["parse"], 0.5);
  EXPECT_EQ(json["seconds"]["draw"], 0.25);
  EXPECT_EQ(json["seconds"]["compile"], 0.1);
  EXPECT_EQ(json["seconds"]["total"], 2);
  EXPECT_EQ(json["passes"][0]["runs"], 4);
  EXPECT_EQ(json["omissions"][0]["reason"], "no bonds in this scene");
  EXPECT_EQ(json["buffers"][0]["bytes"], 9156);
  EXPECT_EQ(json["textures"].size(), 0u);
}

TEST(ExplanationOf, namesWhatRanAndWhatWasLeftOut) {
  const std::string text = explanationOf(exampleReport());
  for (const char* part : {"a.pdb -> a.png: 327 atoms", "640x480", "llvmpipe", "spheres", "12.50 ms", "4x",
                           "pass cylinders", "no bonds in this scene", "9156 B", "total"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in:\n" << text;
}

TEST(AddProcessUsage, readsTheProcessesOwnCost) {
  RunReport report;
  addProcessUsage(report);
  EXPECT_GT(report.totalSeconds, 0);
  EXPECT_GT(report.cpuSeconds, 0);
  EXPECT_GT(report.peakMemoryBytes, 1'000'000u);
}

}  // namespace
}  // namespace meniscus
