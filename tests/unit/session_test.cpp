// What the viewer holds and does, without a window.

#include "app/view/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "app/render_options.h"
#include "app/view/camera_moves.h"
#include "app/view/latency.h"
#include "app/view/moving_quality.h"
#include "core/error.h"
#include "io/structure_reader.h"
#include "tests/support/paths.h"
#include "tests/support/random.h"

namespace meniscus {
namespace {

TEST(Document, UndoesAndRedoesEveryChange) {
  Document document("a.pdb", {{"color", "chain"}});
  const GivenOptions first = document.given();
  document.set("representation", "surface");
  document.setAll("hide", {"//A", "//B"});
  document.remove("color");
  const GivenOptions last = document.given();
  EXPECT_EQ(document.values("hide"), (std::vector<std::string>{"//A", "//B"}));
  EXPECT_FALSE(document.has("color"));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(document.undo());
  EXPECT_FALSE(document.undo());
  EXPECT_EQ(document.given(), first);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(document.redo());
  EXPECT_FALSE(document.redo());
  EXPECT_EQ(document.given(), last);
  document.undo();
  document.set("fog", "0.5");
  EXPECT_FALSE(document.canRedo());
}

TEST(Document, ADraggedSliderIsOneChange) {
  Document document("a.pdb", {});
  for (const char* value : {"0.1", "0.2", "0.3"}) document.set("fog", value, true);
  document.endChange();
  document.set("fog", "0.9", true);
  EXPECT_TRUE(document.undo());
  EXPECT_EQ(document.value("fog"), "0.3");
  EXPECT_TRUE(document.undo());
  EXPECT_FALSE(document.has("fog"));
  EXPECT_FALSE(document.canUndo());
}

TEST(Document, AColourThatIsBeingChosenIsOneChange) {
  Document document("a.pdb", {{"show", "//A=cartoon:chain"}});
  for (const char* color : {"#000001", "#000002"})
    document.setAll("show", {std::string("//A=cartoon:") + color}, true);
  document.endChange();
  document.setAll("show", {"//A=cartoon:#000003"}, true);
  EXPECT_TRUE(document.undo());
  EXPECT_EQ(document.value("show"), "//A=cartoon:#000002");
  EXPECT_TRUE(document.undo());
  EXPECT_EQ(document.value("show"), "//A=cartoon:chain");
}

TEST(Document, IsASceneByItsNameOrWhereItIsSaid) {
  EXPECT_TRUE(Document("a.mvsx", {}).isScene());
  EXPECT_FALSE(Document("a.json", {}).isScene());
  const Document said("a.json", {}, true);
  EXPECT_TRUE(said.isScene());
  EXPECT_EQ(commandLine(renderArguments(said, {}, {8, 8}, "o.png")),
            "meniscus render --scene a.json -o o.png --size=8x8");
}

TEST(Document, NothingChangedIsNoStep) {
  Document document("a.pdb", {{"fog", "0.5"}});
  const std::uint64_t revision = document.revision();
  document.set("fog", "0.5");
  document.setAll("fog", {"0.5"});
  document.remove("hide");
  document.replace(document.given());
  EXPECT_FALSE(document.canUndo());
  EXPECT_EQ(document.revision(), revision);
}

TEST(Document, PicksOfTwoToFourMeasure) {
  Document document("a.pdb", {});
  const auto pick = [](int i) {
    return Pick{"//A/" + std::to_string(i) + "/CA", std::to_string(i), glm::dvec3(i, 0, 0)};
  };
  document.pick(pick(1));
  EXPECT_FALSE(document.measureOption());
  document.pick(pick(2));
  EXPECT_EQ(document.measureOption(), "//A/1/CA;//A/2/CA");
  document.pick(pick(1));  // lets go
  EXPECT_EQ(document.picks.size(), 1u);
  for (int i = 3; i <= 5; ++i) document.pick(pick(i));
  EXPECT_EQ(document.measureOption(), "//A/2/CA;//A/3/CA;//A/4/CA;//A/5/CA");
  document.pick(pick(6));  // a fifth begins anew
  EXPECT_EQ(document.picks.size(), 1u);
  Pick copy = pick(7);
  copy.copy = true;
  document.pick(copy);
  EXPECT_FALSE(document.measureOption());
  document.picks.pop_back();
  document.pick(pick(8));
  EXPECT_TRUE(document.measureOption());
  document.picks.back().molecule = 1;  // --measure is about the first
  EXPECT_FALSE(document.measureOption());
}

SceneObject objectOf(std::shared_ptr<const Molecule> molecule, glm::dvec3 by) {
  SceneObject object;
  object.placements = placeOnce(*molecule);
  object.placements.front().transform = glm::translate(glm::dmat4(1), by);
  object.molecule = std::move(molecule);
  return object;
}

TEST(UpdatePicks, FollowsEachAtomInItsOwnMolecule) {
  Logger logger;
  const auto read = [&](const char* name) {
    return std::make_shared<const Molecule>(std::move(
        readStructure(test::projectFile(std::string("molecules/") + name), {}, logger).models.front()));
  };
  const auto dna = read("133d.pdb"), ubiquitin = read("1ubq.pdb");
  Scene scene;
  scene.objects = {objectOf(dna, {}), objectOf(dna, {7, 7, 7}), objectOf(ubiquitin, {1, 2, 3})};
  ASSERT_EQ(objectsByMolecule(scene).size(), 2u);
  EXPECT_EQ(objectsByMolecule(scene)[1]->molecule, ubiquitin);
  const std::string ofDna = cidOf(*dna, 5), ofUbiquitin = cidOf(*ubiquitin, 40);
  ASSERT_EQ(selectAtoms(*dna, ofUbiquitin).size(), 0u);
  const glm::dvec3 far(1e3);
  std::vector<Pick> picks{{ofDna, "a", far, false, 0},
                          {ofUbiquitin, "b", far, false, 1},
                          {ofUbiquitin, "copy", far, true, 1},
                          {ofUbiquitin, "of a molecule that is gone", far, false, 2},
                          {ofUbiquitin, "of an atom that is gone", far, false, 0},
                          {"", "without a name", far, false, 0}};
  updatePicks(picks, scene);
  ASSERT_EQ(picks.size(), 3u);
  EXPECT_EQ(picks[0].position, dna->positions[5]);
  EXPECT_EQ(picks[1].position, ubiquitin->positions[40] + glm::dvec3(1, 2, 3));
  EXPECT_EQ(picks[2].position, far);
  scene.objects.pop_back();
  updatePicks(picks, scene);
  ASSERT_EQ(picks.size(), 1u);
  EXPECT_EQ(picks[0].name, "a");
}

TEST(RepresentationsOffered, AreAllAndHaveNamesThatAreRead) {
  for (const Representation offered : kRepresentationsOffered) {
    EXPECT_EQ(parseRepresentation("--representation", representationName(offered)), offered);
    EXPECT_EQ(std::count(kRepresentationsOffered.begin(), kRepresentationsOffered.end(), offered), 1);
  }
}

TEST(RenderArguments, AreReadBackToTheLastDigit) {
  test::Random random(5);
  for (int i = 0; i < 200; ++i) {
    Document document("-odd name.pdb",
                      {{"representation", "licorice"}, {"rotate", "1,2,3"}, {"orthographic", ""}});
    Camera camera;
    camera.orientation = glm::normalize(glm::dquat(random.uniform(-1, 1), random.uniform(-1, 1),
                                                   random.uniform(-1, 1), random.uniform(0.1, 1)));
    camera.target =
        glm::dvec3(random.logUniform(1e-6, 1e6), random.uniform(-9, 9), random.uniform(-1e4, 1e4));
    camera.distance = random.logUniform(0.1, 1e5);
    camera.nearest = random.logUniform(0.01, 1e3);
    camera.farthest = random.logUniform(1e3, 1e5);
    const auto options =
        parseRenderOptions(renderArguments(document, camera, {640, 480}, "out.png", 3)).value();
    EXPECT_EQ(options.files, std::vector<std::string>{"./-odd name.pdb"});
    EXPECT_EQ(options.output, "out.png");
    EXPECT_EQ(options.size, (ImageSize{640, 480}));
    EXPECT_EQ(options.target, camera.target);
    EXPECT_EQ(options.distance, camera.distance);
    EXPECT_EQ(options.nearest, camera.nearest);
    EXPECT_EQ(options.farthest, camera.farthest);
    EXPECT_EQ(options.structure.model, 3);
    EXPECT_TRUE(options.orthographic);
    EXPECT_EQ(options.rotationDeg, glm::dvec3(0.0));  // the camera has it
    EXPECT_LT(glm::length(options.orientation.quaternion - camera.orientation), 1e-15);
  }
}

TEST(RenderArguments, TakeAwayThePlanesOfAScenesOwnCamera) {
  Camera own, seen;
  own.nearest = 60;
  seen.farthest = 90;
  const BoundingSphere bounds{{0, 0, 0}, 50};
  EXPECT_EQ(makeView(inPlaceOf(own, seen), {8, 8}, bounds), makeView(seen, {8, 8}, bounds));
  const Document scene("a.mvsj", {});
  const RenderOptions options =
      parseRenderOptions(renderArguments(scene, inPlaceOf(own, seen), {8, 8}, "o.png")).value();
  EXPECT_EQ(options.nearest, 0.0);
  EXPECT_EQ(options.farthest, 90.0);
  own.farthest = 95;
  seen.farthest.reset();
  EXPECT_EQ(makeView(inPlaceOf(own, seen), {8, 8}, bounds), makeView(seen, {8, 8}, bounds));
  seen.nearest = 55;
  EXPECT_EQ(inPlaceOf(own, seen).nearest, 55.0);
}

TEST(RenderArguments, AreQuotedForAShell) {
  Document document("my file.pdb", {{"show", "(HEM)=licorice"}});
  EXPECT_EQ(commandLine(renderArguments(document, {}, {8, 8}, "o.png")),
            "meniscus render 'my file.pdb' -o o.png '--show=(HEM)=licorice' --size=8x8");
  Document scene("a.mvsj", {});
  EXPECT_EQ(commandLine(renderArguments(scene, {}, {8, 8}, "o.png")),
            "meniscus render --scene a.mvsj -o o.png --size=8x8");
}

TEST(CidOf, SelectsEveryAtomAlone) {
  Logger logger;
  for (const char* file :
       {"molecules/3al1.pdb.gz", "molecules/133d.pdb", "tests/data/structures/altlocs.pdb"}) {
    const Molecule molecule = std::move(readStructure(test::projectFile(file), {}, logger).models.front());
    std::size_t named = 0;
    for (std::uint32_t atom = 0; atom < molecule.atomCount(); ++atom) {
      const std::string cid = cidOf(molecule, atom);
      if (cid.empty()) continue;
      ++named;
      EXPECT_EQ(selectAtoms(molecule, cid), std::vector<std::uint32_t>{atom}) << cid;
    }
    EXPECT_EQ(named, molecule.atomCount()) << file;
  }
}

constexpr ImageSize kSize{640, 480};

Camera someCamera(test::Random& random) {
  Camera camera;
  camera.projection = random.uniform(0, 1) < 0.5 ? Projection::perspective : Projection::orthographic;
  camera.orientation = glm::normalize(glm::dquat(random.uniform(-1, 1), random.uniform(-1, 1),
                                                 random.uniform(-1, 1), random.uniform(0.1, 1)));
  camera.target = {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
  camera.distance = random.logUniform(1, 1000);
  camera.zoom = random.logUniform(0.5, 2);
  return camera;
}

glm::dvec2 somePixel(test::Random& random) {
  return {random.uniform(0, kSize.width), random.uniform(0, kSize.height)};
}

TEST(CameraMoves, TurningBackUndoesTurning) {
  test::Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Camera camera = someCamera(random);
    const glm::dvec2 a = somePixel(random), b = somePixel(random);
    const Camera back = turned(turned(camera, kSize, a, b), kSize, b, a);
    EXPECT_LT(glm::length(back.orientation - camera.orientation), 1e-12);
    EXPECT_EQ(turned(camera, kSize, a, a).orientation, camera.orientation);
  }
}

TEST(CameraMoves, DraggingTheFrontTurnsItThatWay) {
  Camera camera;
  const Camera right = turned(camera, kSize, {320, 240}, {360, 240});
  // A point that faces the viewer moves to the right.
  EXPECT_GT((right.orientation * glm::dvec3(0, 0, 1)).x, 0.1);
  EXPECT_NEAR((right.orientation * glm::dvec3(0, 0, 1)).y, 0, 1e-12);
}

TEST(CameraMoves, WhatIsUnderTheCursorStaysThere) {
  test::Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Camera camera = someCamera(random);
    const glm::dvec2 from = somePixel(random), to = somePixel(random);
    // A point of the target's plane under `from`.
    const glm::dvec2 offset = (from - glm::dvec2(320, 240)) * pixelAtTarget(camera, kSize);
    const glm::dvec3 point = camera.target + glm::conjugate(camera.orientation) * glm::dvec3(offset, 0);
    EXPECT_LT(glm::length(*pixelOf(camera, kSize, point) - from), 1e-6);
    EXPECT_LT(glm::length(*pixelOf(panned(camera, kSize, from, to), kSize, point) - to), 1e-6);
    EXPECT_LT(glm::length(*pixelOf(dollied(camera, kSize, from, 0.7), kSize, point) - from), 1e-6);
  }
}

TEST(CameraMoves, AFocusFillsThePicture) {
  test::Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Camera camera = someCamera(random);
    const BoundingSphere sphere{{1, 2, 3}, random.logUniform(0.5, 100)};
    const Camera focused = focusedOn(camera, kSize, sphere);
    EXPECT_LT(glm::length(*pixelOf(focused, kSize, sphere.center) - glm::dvec2(320, 240)), 1e-6);
    const glm::dvec3 top =
        sphere.center + glm::conjugate(focused.orientation) * glm::dvec3(0, sphere.radius, 0);
    // The outline of a sphere reaches a little beyond that.
    EXPECT_NEAR(pixelOf(focused, kSize, top)->y, 480, 40) << camera.zoom;
  }
}

TEST(CameraMoves, ClippingStaysInTheSceneAndEndsBeforeIt) {
  Camera camera;
  camera.distance = 100;
  const BoundingSphere scene{{0, 0, 0}, 20};
  const Camera clipped = clippedBy(camera, scene, 0.25);
  EXPECT_DOUBLE_EQ(clipped.nearest.value(), 90);
  EXPECT_DOUBLE_EQ(dollied(clipped, kSize, {320, 240}, 0.5).nearest.value(), 40);
  EXPECT_FALSE(clippedBy(clipped, scene, -0.25).nearest);
  EXPECT_DOUBLE_EQ(clippedBy(camera, scene, 7).nearest.value(), 120);
}

TEST(CameraMoves, ClippingFromBehindLeavesASlab) {
  Camera camera;
  camera.distance = 100;
  const BoundingSphere scene{{0, 0, 0}, 20};
  const Camera clipped = clippedBehindBy(camera, scene, 0.25);
  EXPECT_DOUBLE_EQ(clipped.farthest.value(), 110);
  EXPECT_DOUBLE_EQ(dollied(clipped, kSize, {320, 240}, 0.5).farthest.value(), 60);
  EXPECT_FALSE(clippedBehindBy(clipped, scene, -0.25).farthest);
  EXPECT_FALSE(focusedOn(clipped, kSize, {{}, 5}).farthest);
  const Camera slab = clippedBehindBy(clippedBy(camera, scene, 0.5), scene, 7);
  EXPECT_DOUBLE_EQ(slab.nearest.value(), 100);
  EXPECT_GT(*slab.farthest, *slab.nearest);
  EXPECT_LT(*slab.farthest, 101);
  const Camera thin = clippedBy(clipped, scene, 7);
  EXPECT_LT(*thin.nearest, *thin.farthest);
  EXPECT_GT(clippedBehindBy(camera, {{0, 0, 99}, 20}, 7).farthest.value(), 0);  // the eye is inside
}

RenderOptions withEffects() {
  return parseSettings({"--style", "full"});
}

TEST(MovingQuality, CutsTheDearestFirstAndKeepsTheLight) {
  const RenderOptions options = withEffects();
  const std::vector<std::string> cuts = possibleCuts(options);
  ASSERT_GE(cuts.size(), 4u);
  EXPECT_EQ(cuts.front(), "ambient occlusion");
  const RenderOptions one = reduced(options, {0.5, 1});
  EXPECT_FALSE(one.occlusion.on);
  EXPECT_EQ(one.ambientLight, ambientLighting().ambient);
  EXPECT_EQ(one.size, (ImageSize{512, 384}));
  EXPECT_EQ(one.samples, 1);
  const RenderOptions all = reduced(options, {0.001, static_cast<int>(cuts.size())});
  EXPECT_TRUE(possibleCuts(all).empty());
  EXPECT_EQ(all.size, (ImageSize{1, 1}));
  EXPECT_TRUE(possibleCuts(RenderOptions{}).empty());
  EXPECT_EQ(possibleCuts(options, 2), (std::vector<std::string>{cuts[0], cuts[1]}));
}

TEST(MovingQuality, LeavesOutRaysBeforeTheMapsThatTakeTheirPlace) {
  const RenderOptions options =
      parseSettings({"--trace-shadows", "64", "--trace-ao", "256", "--reflect", "3"});
  const std::vector<std::string> cuts = possibleCuts(options);
  EXPECT_EQ(cuts, (std::vector<std::string>{"mirrors and glass", "all traced rays of a pixel but one",
                                            "traced rays", "ambient occlusion", "soft edges of shadows",
                                            "shadows"}));
  EXPECT_EQ(reduced(options, {0.5, 0}).trace.shadows, 64);
  const RenderOptions one = reduced(options, {0.5, 2});
  EXPECT_FALSE(one.trace.light());
  EXPECT_EQ(one.trace.shadows, 1);
  EXPECT_EQ(one.trace.occlusion, 1);
  const RenderOptions maps = reduced(options, {0.5, 3});
  EXPECT_FALSE(maps.trace.any());
  EXPECT_EQ(maps.shadows.mode, ShadowMode::soft);
  EXPECT_TRUE(maps.occlusion.on);
  const RenderOptions none = reduced(options, {0.5, 4});
  EXPECT_FALSE(none.occlusion.on);
  EXPECT_EQ(none.ambientLight, ambientLighting().ambient);  // as the picture that stands
  // What is traced by one ray has fewer steps to take.
  EXPECT_EQ(possibleCuts(parseSettings({"--trace-shadows", "1", "--shadows", "hard"})),
            (std::vector<std::string>{"traced rays", "shadows"}));
}

// A machine that takes so long for an effect and for a million pixels.
double cost(const MovingQuality& quality, int effects, double perEffect, double perPicture) {
  return quality.scale * quality.scale * perPicture + (effects - quality.cuts) * perEffect;
}

TEST(QualityGovernor, SettlesWithinTheBudgetAndUsesIt) {
  constexpr double kBudget = 35;
  for (const double perPicture : {1.0, 20.0, 60.0, 200.0, 1000.0}) {
    for (const double perEffect : {0.0, 5.0, 30.0, 300.0}) {
      QualityGovernor governor;
      governor.reset(3);
      int late = 0;
      for (int frame = 0; frame < 300; ++frame) {
        const double ms = cost(governor.quality(), 3, perEffect, perPicture);
        if (frame > 100 && ms > 1.05 * kBudget) ++late;
        governor.measured(ms, kBudget);
      }
      EXPECT_LE(late, 6) << perPicture << " " << perEffect;
      if (perPicture < 20 && perEffect == 0) {
        EXPECT_EQ(governor.quality().scale, 1);
        EXPECT_EQ(governor.quality().cuts, 0);
      }
      if (perEffect == 300) {
        EXPECT_EQ(governor.quality().cuts, 3);
      }
    }
  }
}

TEST(Latency, OvertakenRequestsCountFromTheFirst) {
  using namespace std::chrono_literals;
  Latency latency;
  const Latency::Clock::time_point start = Latency::Clock::now();
  latency.asked(1, true, start);
  latency.asked(2, true, start + 10ms);
  latency.shown(2, false, start + 30ms);
  latency.asked(3, true, start + 40ms);
  latency.shown(2, false, start + 45ms);  // says nothing of 3
  latency.shown(3, false, start + 50ms);
  latency.asked(4, false, start + 160ms);
  latency.shown(4, true, start + 540ms);
  EXPECT_EQ(latency.moving().count, 2u);
  EXPECT_DOUBLE_EQ(latency.moving().most, 30);
  EXPECT_DOUBLE_EQ(latency.lastMovingMs(), 10);
  EXPECT_DOUBLE_EQ(latency.lastFullMs(), 500);
}

TEST(Latency, AStillRequestThatOvertakesAStillOneCountsFromItself) {
  using namespace std::chrono_literals;
  Latency latency;
  const Latency::Clock::time_point start = Latency::Clock::now();
  latency.asked(1, false, start);
  latency.asked(2, false, start + 1000ms);
  latency.shown(2, true, start + 1200ms);
  EXPECT_DOUBLE_EQ(latency.lastFullMs(), 200);
  latency.asked(3, false, start + 2000ms);
  latency.asked(4, true, start + 2100ms);
  latency.asked(5, false, start + 2300ms);
  latency.shown(5, true, start + 2400ms);
  EXPECT_DOUBLE_EQ(latency.lastFullMs(), 300);
}

}  // namespace
}  // namespace meniscus
