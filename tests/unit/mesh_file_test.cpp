// Meshes as files, read back by Assimp, which shares nothing with what wrote them.

#include "io/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace meniscus {
namespace {

namespace fs = std::filesystem;

class MeshFile : public testing::Test {
 protected:
  MeshFile() : folder_(fs::path(testing::TempDir()) / ("mesh_file_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    MetaballField field;
    field.balls = {{{1, 2, 3}, 4, 1, 0xFF8000, 1}, {{3, 2, 3}, 3.5f, 1, 0x2040C0, 70000}};
    surfaces_.push_back(meshSurface(field, {.spacing = 0.6}));
    field.balls = {{{-6, 0, 0}, 4, 1, 0x00FF00, 3}};
    surfaces_.push_back(meshSurface(field, {.spacing = 0.9}));
  }
  ~MeshFile() override { fs::remove_all(folder_); }

  const aiScene* read(const fs::path& path) {
    const aiScene* scene = importer_.ReadFile(path.string(), 0);
    EXPECT_NE(scene, nullptr) << importer_.GetErrorString();
    return scene;
  }
  // `mesh` from `first` on holds `expected`, moved by `shift`.
  static void expectSame(const aiMesh& mesh, std::size_t firstVertex, std::size_t firstTriangle,
                         const SurfaceMesh& expected, const glm::dvec3& shift, double tolerance,
                         bool linear) {
    for (std::size_t i = 0; i < expected.vertices.size(); ++i) {
      const MeshVertex& v = expected.vertices[i];
      const aiVector3D p = mesh.mVertices[firstVertex + i], n = mesh.mNormals[firstVertex + i];
      const glm::dvec3 at = shift + glm::dvec3(v.position);
      ASSERT_NEAR(static_cast<double>(p.x), at.x, tolerance);
      ASSERT_NEAR(static_cast<double>(p.y), at.y, tolerance);
      ASSERT_NEAR(static_cast<double>(p.z), at.z, tolerance);
      ASSERT_EQ(n.x, v.normal.x);
      ASSERT_EQ(n.z, v.normal.z);
      const aiColor4D c = mesh.mColors[0][firstVertex + i];
      const auto stored = [&](float value) {
        if (!linear) return static_cast<double>(value);
        const double l = static_cast<double>(value);
        return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
      };
      ASSERT_NEAR(stored(c.r) * 255, v.color >> 16 & 255u, 0.02);
      ASSERT_NEAR(stored(c.g) * 255, v.color >> 8 & 255u, 0.02);
      ASSERT_NEAR(stored(c.b) * 255, v.color & 255u, 0.02);
    }
    for (std::size_t i = 0; i < expected.triangles.size(); ++i) {
      const aiFace& face = mesh.mFaces[firstTriangle + i];
      ASSERT_EQ(face.mNumIndices, 3u);
      for (unsigned k = 0; k < 3; ++k)
        ASSERT_EQ(face.mIndices[k], expected.triangles[i][static_cast<glm::length_t>(k)] + firstVertex);
    }
  }

  fs::path folder_;
  std::vector<SurfaceMesh> surfaces_;
  Assimp::Importer importer_;
};

TEST_F(MeshFile, PlyHoldsAllSurfaces) {
  const glm::dvec3 origin(10.5, -20.25, 3);
  writeMeshFile(folder_ / "a.ply", surfaces_, origin);
  const aiScene* scene = read(folder_ / "a.ply");
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& mesh = *scene->mMeshes[0];
  ASSERT_EQ(mesh.mNumVertices, surfaces_[0].vertices.size() + surfaces_[1].vertices.size());
  ASSERT_EQ(mesh.mNumFaces, surfaces_[0].triangles.size() + surfaces_[1].triangles.size());
  ASSERT_TRUE(mesh.HasVertexColors(0));
  expectSame(mesh, 0, 0, surfaces_[0], origin, 2e-6, false);
  expectSame(mesh, surfaces_[0].vertices.size(), surfaces_[0].triangles.size(), surfaces_[1], origin, 2e-6,
             false);
}

// What Assimp does not look at: the atoms' numbers.
TEST_F(MeshFile, PlyNamesAtoms) {
  writeMeshFile(folder_ / "a.ply", surfaces_, glm::dvec3(0));
  std::ifstream file(folder_ / "a.ply", std::ios::binary);
  std::stringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  const std::size_t start = text.find("end_header\n") + 11;
  constexpr std::size_t kStride = 12 + 12 + 3 + 4;
  for (std::size_t i = 0; i < surfaces_[0].vertices.size(); ++i) {
    std::uint32_t id = 0;
    std::memcpy(&id, text.data() + start + i * kStride + 27, 4);
    ASSERT_EQ(id, surfaces_[0].vertices[i].id);
  }
}

TEST_F(MeshFile, PlyOfFarAwayAtomsIsInDouble) {
  const glm::dvec3 origin(1e6, -1e6, 123456.789);
  writeMeshFile(folder_ / "far.ply", surfaces_, origin);
  std::ifstream file(folder_ / "far.ply", std::ios::binary);
  std::stringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  EXPECT_NE(text.find("property double x"), std::string::npos);
  double x = 0;
  std::memcpy(&x, text.data() + text.find("end_header\n") + 11, 8);
  EXPECT_EQ(x, origin.x + static_cast<double>(surfaces_[0].vertices[0].position.x));
  ASSERT_EQ(read(folder_ / "far.ply")->mMeshes[0]->mNumVertices,
            surfaces_[0].vertices.size() + surfaces_[1].vertices.size());
}

TEST_F(MeshFile, GlbHoldsANodeForEachSurface) {
  const glm::dvec3 origin(1e6, -20.25, 3);
  writeMeshFile(folder_ / "a.GLB", surfaces_, origin);
  const aiScene* scene = read(folder_ / "a.GLB");
  ASSERT_EQ(scene->mNumMeshes, 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const aiMesh& mesh = *scene->mMeshes[i];
    ASSERT_EQ(mesh.mNumVertices, surfaces_[i].vertices.size());
    ASSERT_EQ(mesh.mNumFaces, surfaces_[i].triangles.size());
    expectSame(mesh, 0, 0, surfaces_[i], glm::dvec3(0), 0, true);
  }
  ASSERT_EQ(scene->mRootNode->mNumChildren, 2u);
  EXPECT_EQ(scene->mRootNode->mChildren[0]->mTransformation.a4, 1e6f);
  EXPECT_EQ(scene->mRootNode->mChildren[1]->mTransformation.b4, -20.25f);
}

TEST_F(MeshFile, OtherNamesAndFoldersAreRefused) {
  EXPECT_THROW(requireMeshName("--export", "surface.obj"), UsageError);
  EXPECT_THROW(requireMeshName("--export", "surface"), UsageError);
  requireMeshName("--export", "folder/surface.ply");
  EXPECT_THROW(writeMeshFile(folder_ / "none" / "a.ply", surfaces_, glm::dvec3(0)), InputError);
  EXPECT_THROW(writeMeshFile(folder_, surfaces_, glm::dvec3(0)), InputError);
  EXPECT_THROW(writeMeshFile("/dev/full", surfaces_, glm::dvec3(0)), InputError);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace meniscus
