#include "render/surface/mesh.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/mesh/surface_mesh.h"

namespace meniscus {

namespace {

constexpr SurfaceParameter kMeshParameters[] = {
    {"spacing", "side of the grid's cubes in Angstrom; what is smaller may be lost", 0.5, 0.1, 4, false},
};

// Of memory while it is made: what is drawn is made again in every process. An export may take more.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

// Of the textures that shaders/surface/mesh.* read; the same there.
constexpr int kVerticesPerRow = 2048, kTrianglesPerRow = 1365;
constexpr int kRowsPerChunk = 4096;

// Triangles that are drawn with one call.
struct Chunk {
  gl::Buffer elements;
  gl::Texture corners;  // the same numbers
  int count = 0;
  gl::Object vertexArray;
};

class Mesh : public SurfaceMethod {
 public:
  explicit Mesh(const SurfaceParameters& values) : spacing_(values.at("spacing")) {}

  void prepare(const MetaballField& field) override;
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override;
  std::vector<ResourceStats> buffers() const override;
  std::uint64_t bytesOfBalls() const override;

 private:
  void upload(const SurfaceMesh& mesh);
  void draw(const PassContext& context, ShaderLibrary& shaders, const GBufferRefs& g, bool fromOutside) const;
  bool isSeenFromOutside(const View& view, const glm::dvec3& origin);

  double spacing_;
  const MetaballField* field_ = nullptr;
  gl::Texture vertices_;
  std::vector<Chunk> chunks_;
  SurfaceStats stats_;
  // What isSeenFromOutside() found last: the samples and tiles of a picture ask alike.
  struct Seen {
    View view;
    glm::dvec3 origin;
    bool fromOutside;
  };
  std::optional<Seen> seen_;
};

void Mesh::prepare(const MetaballField& field) {
  field_ = &field;
  const auto start = std::chrono::steady_clock::now();
  const SurfaceMesh mesh = meshSurface(field, {.spacing = spacing_, .mostBytes = kMostBytes});
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  upload(mesh);
  stats_.details = {{"vertices", static_cast<double>(mesh.vertices.size())},
                    {"triangles", static_cast<double>(mesh.triangles.size())},
                    {"ms to make the mesh", spent.count()},
                    {"most bytes per pixel", 0}};  // triangles go straight into the G-buffer
}

void Mesh::upload(const SurfaceMesh& mesh) {
  if (mesh.triangles.empty()) return;
  const auto rowsOf = [](std::size_t count, int perRow) {
    return static_cast<int>((count + static_cast<std::size_t>(perRow) - 1) /
                            static_cast<std::size_t>(perRow));
  };
  // Whole rows at once, then what is left.
  const auto fill = [](const gl::Texture& texture, const std::byte* data, std::size_t count, int perRow,
                       int texelsEach, std::size_t bytesEach) {
    const int whole = static_cast<int>(count / static_cast<std::size_t>(perRow));
    const int rest = static_cast<int>(count % static_cast<std::size_t>(perRow));
    if (whole > 0) texture.write(perRow * texelsEach, whole, data, 0, 0);
    if (rest > 0)
      texture.write(rest * texelsEach, 1,
                    data + static_cast<std::size_t>(whole) * static_cast<std::size_t>(perRow) * bytesEach, 0,
                    whole);
  };
  const int rows = rowsOf(mesh.vertices.size(), kVerticesPerRow);
  if (rows > gl::queryLimits().textureSize)
    throw InputError(
        fmt::format("--mesh-spacing: with {:g} A the mesh has {} vertices, more than the driver's textures "
                    "hold; give a larger spacing",
                    spacing_, mesh.vertices.size()));
  vertices_ = gl::Texture::make({gl::TextureFormat::rgba32ui, 2 * kVerticesPerRow, rows});
  fill(vertices_, reinterpret_cast<const std::byte*>(mesh.vertices.data()), mesh.vertices.size(),
       kVerticesPerRow, 2, sizeof(MeshVertex));
  constexpr std::size_t kPerChunk = std::size_t{kTrianglesPerRow} * kRowsPerChunk;
  for (std::size_t first = 0; first < mesh.triangles.size(); first += kPerChunk) {
    const std::size_t count = std::min(kPerChunk, mesh.triangles.size() - first);
    const glm::uvec3* data = mesh.triangles.data() + first;
    Chunk chunk;
    chunk.count = static_cast<int>(count);
    chunk.elements = gl::Buffer::fromData(data, count * sizeof(glm::uvec3));
    chunk.corners =
        gl::Texture::make({gl::TextureFormat::r32ui, 3 * kTrianglesPerRow, rowsOf(count, kTrianglesPerRow)});
    fill(chunk.corners, reinterpret_cast<const std::byte*>(data), count, kTrianglesPerRow, 3,
         sizeof(glm::uvec3));
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    chunk.vertexArray = gl::Object(gl::ObjectKind::vertexArray, name);
    glVertexArrayElementBuffer(name, chunk.elements.object.name());
    chunks_.push_back(std::move(chunk));
  }
}

void Mesh::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  const GBufferRefs g = target.gbuffer;
  graph.addPass(target.prefix + "surface", {g.depth}, attachmentsOf(g),
                [this, &shaders, g, fromOutside = isSeenFromOutside(target.view, target.origin)](
                    const PassContext& context) { draw(context, shaders, g, fromOutside); });
}

// Whether no ray begins in a ball: then it meets the front of a triangle first.
bool Mesh::isSeenFromOutside(const View& view, const glm::dvec3& origin) {
  if (seen_ && seen_->view == view && seen_->origin == origin) return seen_->fromOutside;
  const bool fromOutside =
      std::none_of(field_->balls.begin(), field_->balls.end(), [&](const Metaball& ball) {
        const glm::dvec3 center = view.rotation * ((origin - view.pivot) + glm::dvec3(ball.center));
        return center.z + static_cast<double>(ball.support) >= view.nearZ;
      });
  seen_ = Seen{view, origin, fromOutside};
  return fromOutside;
}

void Mesh::draw(const PassContext& context, ShaderLibrary& shaders, const GBufferRefs& g,
                bool fromOutside) const {
  glUseProgram(shaders.program("surface/mesh.vert", "surface/mesh.frag", channelFlags(context, g)));
  glBindTextureUnit(0, vertices_.object.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  // Corners are snapped to the driver's grid of pixels: a triangle's own depth must stay behind what it is
  // drawn with (include/gbuffer.glsl). Reversed z: towards the viewer is up.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1, 8);
  if (fromOutside) glEnable(GL_CULL_FACE);
  for (const Chunk& chunk : chunks_) {
    glBindTextureUnit(1, chunk.corners.object.name());
    glBindVertexArray(chunk.vertexArray.name());
    glDrawElements(GL_TRIANGLES, 3 * chunk.count, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_CULL_FACE);
  glPolygonOffset(0, 0);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);
}

SurfaceStats Mesh::takeStats() {
  SurfaceStats stats = std::exchange(stats_, {});
  stats.method = "mesh";
  return stats;
}

std::uint64_t Mesh::bytesOfBalls() const {
  std::uint64_t bytes = 0;
  for (const ResourceStats& buffer : buffers()) bytes += buffer.bytes;
  return bytes;
}

std::vector<ResourceStats> Mesh::buffers() const {
  if (chunks_.empty()) return {};
  std::uint64_t triangles = 0;
  for (const Chunk& chunk : chunks_) triangles += chunk.elements.bytes + chunk.corners.bytes();
  return {{"surface: mesh vertices", vertices_.bytes()}, {"surface: mesh triangles", triangles}};
}

}  // namespace

std::span<const SurfaceParameter> meshParameters() {
  return kMeshParameters;
}

std::unique_ptr<SurfaceMethod> makeMesh(const SurfaceParameters& values) {
  return std::make_unique<Mesh>(values);
}

}  // namespace meniscus
