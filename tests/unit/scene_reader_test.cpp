// What scenes become.

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "core/atom_colors.h"
#include "tests/unit/scene_files.h"

namespace meniscus::test {
namespace {

class SceneReader : public SceneFileTest {
 protected:
  /// How many atoms of a molecule a selector chooses.
  std::size_t count(const std::string& molecule, Json selector) {
    const Preparation made = read(structureScene(molecule, {shown("all"), shown(std::move(selector))}));
    const std::vector<SceneObject>& objects = made.pictures[0].scene.objects;
    if (objects.size() < 2) return 0;
    const SceneObject& object = objects[1];
    return object.atoms.empty() ? object.molecule->atomCount() : object.atoms.size();
  }
};

// Counted in the files with grep: 1CBS has 1091 protein atoms, a ligand of 22, and 100 waters.
TEST_F(SceneReader, wordsSelectKinds) {
  EXPECT_EQ(count("1cbs.cif.gz", "all"), 1213u);
  EXPECT_EQ(count("1cbs.cif.gz", "protein"), 1091u);
  EXPECT_EQ(count("1cbs.cif.gz", "polymer"), 1091u);
  EXPECT_EQ(count("1cbs.cif.gz", "ligand"), 22u);
  EXPECT_EQ(count("1cbs.cif.gz", "water"), 100u);
  EXPECT_EQ(count("1cbs.cif.gz", "nucleic"), 0u);
  EXPECT_EQ(count("1cbs.cif.gz", "ion"), 0u);
  EXPECT_GT(count("1lcd.cif.gz", "nucleic"), 400u);
  EXPECT_GT(count("7ddo.pdb.gz", "branched"), 0u);
}

TEST_F(SceneReader, expressionsMustMatchInAllFields) {
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_asym_id", "A"}}), 1091u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"auth_asym_id", "A"}}), 1213u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_entity_id", "2"}}), 22u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_comp_id", "REA"}, {"type_symbol", "O"}}), 2u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_atom_id", "CA"}}), 137u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_asym_id", "A"}, {"label_seq_id", 1}, {"auth_atom_id", "N"}}), 1u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"atom_id", 1}}), 1u);
  EXPECT_EQ(
      count("1cbs.cif.gz", {{"label_atom_id", "CA"}, {"beg_label_seq_id", 10}, {"end_label_seq_id", 20}}),
      11u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_atom_id", "CA"}, {"beg_auth_seq_id", 130}}), 8u);
  EXPECT_EQ(count("1cbs.cif.gz", {{"label_atom_id", "CA"}, {"auth_seq_id", 5}, {"end_auth_seq_id", 4}}), 0u);
  // A list: one must match.
  EXPECT_EQ(count("1cbs.cif.gz",
                  Json::array({{{"label_comp_id", "REA"}}, {{"label_seq_id", 1}, {"label_atom_id", "CA"}}})),
            23u);
  // Insertion codes, and a PDB file, whose label_ ids are its auth_ ids.
  EXPECT_GT(count("1a0q.pdb.gz", {{"label_asym_id", "H"}, {"auth_seq_id", 82}, {"pdbx_PDB_ins_code", "A"}}),
            0u);
  EXPECT_EQ(count("1a0q.pdb.gz", {{"label_asym_id", "H"}, {"auth_seq_id", 82}, {"pdbx_PDB_ins_code", "Z"}}),
            0u);
}

TEST_F(SceneReader, representationsAndSizes) {
  const auto object = [&](const char* type, Json params) {
    params["type"] = type;
    return sceneOf(structureScene("1ubq.pdb", {node("component", {{"selector", "protein"}},
                                                    {node("representation", params)})}))
        .objects.at(0);
  };
  const SceneObject plain;
  EXPECT_EQ(object("spacefill", {{"size_factor", 0.5}}).radiusScale, 0.5);
  EXPECT_EQ(object("ball_and_stick", {{"size_factor", 2}}).stickRadius, 2 * plain.stickRadius);
  EXPECT_EQ(object("ball_and_stick", {}).representation, Representation::ballAndStick);
  EXPECT_EQ(object("line", {}).representation, Representation::licorice);
  EXPECT_LT(object("line", {}).licoriceRadius, plain.licoriceRadius);
  EXPECT_EQ(object("surface", {{"surface_type", "gaussian"}}).representation, Representation::surface);
  EXPECT_EQ(object("cartoon", {{"size_factor", 3}}).ribbonScale, 3);
  EXPECT_EQ(object("backbone", {}).representation, Representation::backbone);
  EXPECT_EQ(object("putty", {}).representation, Representation::putty);
}

TEST_F(SceneReader, hydrogensAreLeftOutOnDemand) {
  const Scene scene = sceneOf(structureScene(
      "1d3z.pdb.gz", {node("component", {{"selector", "all"}},
                           {node("representation", {{"type", "spacefill"}, {"ignore_hydrogens", true}})})}));
  const SceneObject& object = scene.objects.at(0);
  EXPECT_FALSE(object.atoms.empty());
  for (const std::uint32_t atom : object.atoms) EXPECT_NE(object.molecule->elements[atom], 1);
}

TEST_F(SceneReader, laterColorsWinAndTheDefaultIsWhite) {
  const Scene scene = sceneOf(structureScene(
      "1cbs.cif.gz",
      {shown("protein"),
       shown("protein", "spacefill",
             {node("color", {{"color", "green"}}),
              node("color", {{"color", "#68f"}, {"selector", {{"label_seq_id", 1}}}}),
              node("color",
                   {{"color", "Red"}, {"selector", {{"label_seq_id", 1}, {"label_atom_id", "CA"}}}})})}));
  EXPECT_EQ(scene.objects.at(0).coloring.scheme, ColorScheme::uniform);
  EXPECT_EQ(scene.objects.at(0).coloring.uniform, 0xFFFFFFu);
  const SceneObject& object = scene.objects.at(1);
  std::set<Rgb> first, rest;
  for (std::uint32_t atom = 0; atom < object.molecule->atomCount(); ++atom) {
    const Residue& residue = object.molecule->residues[object.molecule->residueOf[atom]];
    (residue.labelNumber == 1 ? first : rest).insert(object.colors[atom]);
  }
  EXPECT_EQ(first, (std::set<Rgb>{0x6688FF, 0xFF0000}));
  EXPECT_EQ(rest, (std::set<Rgb>{0x008000}));  // CSS's green, not X11's
}

TEST_F(SceneReader, ourOwnSettingsWinOverTheNodes) {
  Json representation =
      withCustom(node("representation", {{"type", "cartoon"}}),
                 {{"representation", "licorice"}, {"stick_radius", 0.4}, {"color", "chain"}});
  Json scene = structureScene("1ubq.pdb", {node("component", {{"selector", "protein"}}, {representation})});
  scene["root"] = withCustom(scene["root"], {{"size", "64x48"},
                                             {"samples", 4},
                                             {"level_of_detail", false},
                                             {"shadows", "soft"},
                                             {"occlusion", true},
                                             {"outlines", {"silhouettes", "chains"}},
                                             {"depth_unsharp", "halo"},
                                             {"surface_option", {{"iterations", 3}}},
                                             {"background", "transparent"}});
  scene["root"]["custom"]["meniscus"].erase("surface_option");
  const Picture picture = std::move(read(scene).pictures.at(0));
  EXPECT_EQ(picture.options.size, (ImageSize{64, 48}));
  EXPECT_EQ(picture.options.samples, 4);
  EXPECT_FALSE(picture.options.levelOfDetail);
  EXPECT_EQ(picture.options.shadows.mode, ShadowMode::soft);
  EXPECT_TRUE(picture.options.occlusion.on);
  EXPECT_TRUE(picture.options.lines.silhouettes);
  EXPECT_EQ(picture.options.lines.groups, LineGroups::chains);
  EXPECT_EQ(picture.options.depthUnsharp.mode, UnsharpMode::halo);
  EXPECT_TRUE(picture.scene.background.transparent);
  const SceneObject& object = picture.scene.objects.at(0);
  EXPECT_EQ(object.representation, Representation::licorice);
  EXPECT_EQ(object.licoriceRadius, 0.4);
  EXPECT_EQ(object.coloring.scheme, ColorScheme::chain);
}

TEST_F(SceneReader, optionsBesideASceneHaveTheirWay) {
  Json scene = structureScene("1ubq.pdb", {shown("all")}, {node("canvas", {{"background_color", "ivory"}})});
  EXPECT_EQ(read(scene).pictures[0].scene.background.color, 0xFFFFF0u);
  scene["root"] = withCustom(scene["root"], {{"samples", 4}, {"shadows", "soft"}});
  const RenderOptions given =
      parseRenderOptions({"--scene", "fig.mvsj", "-o", "out.png", "--samples", "2", "--background", "black"})
          .value();
  const Picture picture = std::move(read(scene, given).pictures.at(0));
  EXPECT_EQ(picture.options.samples, 2);
  EXPECT_EQ(picture.options.shadows.mode, ShadowMode::soft);
  EXPECT_EQ(picture.scene.background.color, 0x000000u);
}

TEST_F(SceneReader, assembliesAndSymmetryPlaceCopies) {
  const auto placements = [&](const std::string& molecule, Json params) {
    return sceneOf(structureScene(molecule, {shown("all")}, {}, std::move(params))).objects.at(0).placements;
  };
  EXPECT_EQ(placements("1a8o.cif.gz", {{"type", "assembly"}}).size(), 2u);
  EXPECT_EQ(placements("1a8o.cif.gz", {{"type", "assembly"}, {"assembly_id", "1"}}).size(), 2u);
  // 1UBQ: P 21 21 21, four operators.
  EXPECT_EQ(
      placements("1ubq.pdb", {{"type", "symmetry"}, {"ijk_min", {0, 0, 0}}, {"ijk_max", {0, 0, 0}}}).size(),
      4u);
  EXPECT_EQ(placements("1ubq.pdb", {{"type", "symmetry"}}).size(), 4u * 27u);
  const std::vector<Placement> mates = placements("1ubq.pdb", {{"type", "symmetry_mates"}, {"radius", 5}});
  EXPECT_GT(mates.size(), 4u);  // a molecule in a crystal has neighbours on all sides
  EXPECT_LT(mates.size(), 40u);
  EXPECT_EQ(placements("1ubq.pdb", {{"type", "symmetry_mates"}, {"radius", 0}}).size(), 1u);
  std::size_t identities = 0;
  for (const Placement& mate : mates) identities += mate.transform == glm::dmat4(1.0) ? 1 : 0;
  EXPECT_EQ(identities, 1u);
  // Copies of a crystal do not overlap: no two atoms of different molecules are nearer than 1.5 Å.
  const auto molecule = sceneOf(structureScene("1ubq.pdb", {shown("protein")})).objects.at(0).molecule;
  for (const Placement& mate : mates) {
    if (mate.transform == glm::dmat4(1.0)) continue;
    for (std::size_t i = 0; i < 602; i += 7)
      for (std::size_t j = 0; j < 602; ++j)
        ASSERT_GT(glm::distance(molecule->positions[j],
                                glm::dvec3(mate.transform * glm::dvec4(molecule->positions[i], 1.0))),
                  1.5);
  }
}

TEST_F(SceneReader, transformsMoveAndInstancesRepeat) {
  const Json quarter = Json::array({0, 1, 0, -1, 0, 0, 0, 0, 1});  // columns: a quarter turn about z
  const Scene scene = sceneOf(structureScene(
      "1ubq.pdb",
      {shown("all"), node("transform", {{"rotation", quarter}, {"translation", {10, 0, 0}}}),
       node("instance", {{"translation", {0, 0, 0}}}), node("instance", {{"translation", {0, 100, 0}}})}));
  const std::vector<Placement>& placements = scene.objects.at(0).placements;
  ASSERT_EQ(placements.size(), 2u);
  const auto moved = [&](std::size_t i) {
    return glm::dvec3(placements[i].transform * glm::dvec4(1, 2, 3, 1));
  };
  EXPECT_LT(glm::distance(moved(0), glm::dvec3(8, 1, 3)), 1e-12);
  EXPECT_LT(glm::distance(moved(1), glm::dvec3(8, 101, 3)), 1e-12);
}

TEST_F(SceneReader, rotationsAboutACentreKeepIt) {
  const Json half = Json::array({-1, 0, 0, 0, -1, 0, 0, 0, 1});
  const Scene scene = sceneOf(structureScene(
      "1ubq.pdb", {shown("all"), node("transform", {{"rotation", half}, {"rotation_center", {5, 6, 7}}})}));
  const glm::dvec3 center(scene.objects.at(0).placements.at(0).transform * glm::dvec4(5, 6, 7, 1));
  EXPECT_LT(glm::distance(center, glm::dvec3(5, 6, 7)), 1e-12);
}

// The reference camera of 60 degrees sees a sphere of half its distance, and so does ours.
TEST_F(SceneReader, camerasSeeWhatTheReferenceCameraSees) {
  const Json scene = structureScene(
      "1ubq.pdb", {shown("all")},
      {node("camera",
            {{"target", {10, 20, 30}}, {"position", {10, 20, 80}}, {"up", {1, 0, 0}}, {"near", 45}})});
  const Camera camera = sceneOf(scene).camera;
  EXPECT_EQ(camera.target, glm::dvec3(10, 20, 30));
  EXPECT_NEAR(camera.distance * std::sin(camera.fovY / 2), 25, 1e-12);
  EXPECT_NEAR(camera.distance - *camera.nearest, 50 - 45, 1e-12);
  const glm::dmat3 axes = glm::mat3_cast(camera.orientation);
  EXPECT_LT(glm::distance(axes * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::distance(axes * glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1)), 1e-12);
  const RenderOptions flat =
      parseRenderOptions({"--scene", "f.mvsj", "-o", "o.png", "--orthographic"}).value();
  const Camera parallel = read(scene, flat).pictures.at(0).scene.camera;
  EXPECT_NEAR(parallel.distance * std::tan(parallel.fovY / 2), 25, 1e-12);
}

TEST_F(SceneReader, focusFitsTheComponentsSphere) {
  const auto cameraOf = [&](Json params, const std::string& size) {
    Json scene =
        structureScene("1ubq.pdb", {shown("all"), node("component", {{"selector", {{"auth_seq_id", 48}}}},
                                                       {node("focus", std::move(params))})});
    scene["root"] = withCustom(scene["root"], {{"size", size}});
    return sceneOf(scene).camera;
  };
  const Camera wide = cameraOf({{"radius", 8}}, "400x200"), tall = cameraOf({{"radius", 8}}, "200x400");
  EXPECT_NEAR(wide.distance * std::sin(wide.fovY / 2), 8, 1e-12);
  EXPECT_NEAR(tall.distance * std::sin(tall.fovY / 2), 16, 1e-12);
  const Camera along = cameraOf({{"direction", {1, 0, 0}}, {"up", {0, 0, 1}}, {"radius", 8}}, "200x200");
  EXPECT_LT(glm::distance(glm::mat3_cast(along.orientation) * glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1)),
            1e-12);
  EXPECT_GT(cameraOf({{"radius_factor", 4}}, "200x200").distance,
            cameraOf({{"radius_factor", 2}}, "200x200").distance);
}

TEST_F(SceneReader, clipsCutAwayAtomsByTheirCentres) {
  const auto kept = [&](Json clip) {
    return sceneOf(
               structureScene("1ubq.pdb", {shown("protein", "spacefill", {node("clip", std::move(clip))})}))
        .objects.at(0);
  };
  const Json plane{{"type", "plane"}, {"normal", {0, 0, 2}}, {"point", {0, 0, 15}}, {"variant", "object"}};
  Json inverted = plane;
  inverted["invert"] = true;
  const SceneObject below = kept(plane), above = kept(inverted);
  EXPECT_EQ(below.atoms.size() + above.atoms.size(), 602u);
  for (const std::uint32_t atom : below.atoms) EXPECT_LE(below.molecule->positions[atom].z, 15);
  const SceneObject hollow = kept({{"type", "sphere"}, {"center", {30, 29, 16}}, {"radius", 8}});
  for (const std::uint32_t atom : hollow.atoms)
    EXPECT_GE(glm::distance(hollow.molecule->positions[atom], glm::dvec3(30, 29, 16)), 8);
  EXPECT_LT(hollow.atoms.size(), 602u);
  const SceneObject box =
      kept({{"type", "box"}, {"center", {30, 29, 16}}, {"size", {6, 8, 10}}, {"invert", true}});
  EXPECT_GT(box.atoms.size(), 0u);
  for (const std::uint32_t atom : box.atoms) EXPECT_LE(std::abs(box.molecule->positions[atom].x - 30), 3);
}

TEST_F(SceneReader, surfacesAreAsOpaqueAsTheirNodeSays) {
  const auto made = [&](std::vector<Json> components, Json meniscus = Json::object()) {
    Json scene = structureScene("1ubq.pdb", std::move(components));
    scene["root"] = withCustom(scene["root"], std::move(meniscus));
    return read(scene);
  };
  const Json half = node("opacity", {{"opacity", 0.5}});
  EXPECT_EQ(made({shown("protein", "surface", {half})}).pictures[0].options.surface.opacity, 0.5);
  EXPECT_EQ(
      made({shown("protein", "surface", {half})}, {{"opacity", 0.2}}).pictures[0].options.surface.opacity,
      0.2);
  EXPECT_EQ(made({shown("protein", "surface")}).pictures[0].options.surface.opacity, 1);
  EXPECT_TRUE(made({shown("protein", "surface", {half}), shown("protein", "cartoon")}).unsupported.empty());
  EXPECT_EQ(made({shown("protein", "surface", {half}), shown("water", "surface")}).unsupported.size(), 1u);
}

TEST_F(SceneReader, labelsStandAtTheirComponents) {
  const Scene scene = sceneOf(structureScene(
      "1ubq.pdb",
      {shown("all"), node("component", {{"selector", {{"auth_seq_id", 1}, {"auth_atom_id", "CA"}}}},
                          {node("label", {{"text", "first"}})})}));
  ASSERT_EQ(scene.labels.size(), 1u);
  EXPECT_EQ(scene.labels[0].text, "first");
  EXPECT_LT(glm::distance(scene.labels[0].center, glm::dvec3(26.266, 25.413, 2.842)), 1e-6);  // ATOM 2
}

TEST_F(SceneReader, whatIsNotSupportedIsListedWithItsPlaceAndReason) {
  const Preparation made = read(structureScene(
      "1ubq.pdb",
      {shown("all", "spacefill", {node("opacity", {{"opacity", 0.5}})}), shown("all", "carbohydrate"),
       node("component", {{"selector", {{"atom_index", 3}}}}, {node("tooltip", {{"text", "x"}})}),
       node("label_from_uri", {{"uri", "x"}})},
      {node("primitives", Json::object(), {node("primitive", {{"kind", "line"}})}), node("transition")}));
  const std::string structure = "fig.mvsj: root.children[0].children[0].children[0]";
  const auto listed = [&](const std::string& start) {
    for (const std::string& line : made.unsupported)
      if (line.find(start) != std::string::npos && line.find(": ", start.size()) != std::string::npos)
        return true;
    return false;
  };
  EXPECT_TRUE(
      listed("root.children[0].children[0].children[0].children[0].children[0].children[0]: only surfaces"));
  EXPECT_TRUE(listed("children[1].children[0]: the representation 'carbohydrate'"));
  EXPECT_TRUE(listed("params.selector.atom_index"));
  EXPECT_TRUE(listed("children[3]: nodes of kind 'label_from_uri'"));
  EXPECT_TRUE(listed("root.children[1]: nodes of kind 'primitives'"));
  EXPECT_TRUE(listed("root.children[2]: has no meaning"));
}

// What a manifest knows of a scene's content needs nothing that is not drawn.
TEST_F(SceneReader, onlyWhatIsReadIsFetched) {
  const auto download = [](const char* format, Json child) {
    return node("download", {{"url", "https://example.org/x"}},
                {node("parse", {{"format", format}}, {std::move(child)})});
  };
  const auto contentOf = [&](std::vector<Json> more) {
    writeFile(folder_ / "fig.mvsj", structureScene("1ubq.pdb", {shown("all")}, std::move(more)).dump());
    return MvsFile(folder_ / "fig.mvsj", {true, folder_ / "cache"}).contentName();
  };
  const std::string map = contentOf({download("map", node("volume"))});
  EXPECT_NE(map, contentOf({download("mmcif", node("volume"))}));
  EXPECT_THROW(contentOf({download("mmcif", node("structure", {{"type", "model"}}))}), InputError);
}

TEST_F(SceneReader, severalStatesBecomePicturesByKey) {
  Json scene = structureScene("1ubq.pdb", {shown("all")});
  Json second = structureScene("1ubq.pdb", {shown("water")});
  const Json file{{"kind", "multiple"},
                  {"metadata", {{"version", "1.4"}}},
                  {"snapshots",
                   {{{"root", scene["root"]}, {"metadata", {{"key", "whole"}}}},
                    {{"root", second["root"]}, {"metadata", {{"linger_duration_ms", 5}}}}}}};
  const Preparation made = read(file, options("{stem}-{state}.png"));
  ASSERT_EQ(made.pictures.size(), 2u);
  EXPECT_EQ(made.pictures[0].output, "fig-whole.png");
  EXPECT_EQ(made.pictures[1].output, "fig-2.png");
  // The file is read once.
  EXPECT_EQ(made.pictures[0].scene.objects[0].molecule, made.pictures[1].scene.objects[0].molecule);
  EXPECT_NE(errorOf(file).find("{state}"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
