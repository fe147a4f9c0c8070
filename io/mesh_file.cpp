#include "io/mesh_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <ostream>
#include <streambuf>
#include <string>

#include "core/error.h"
#include "core/srgb.h"
#include "core/text.h"
#include "io/output_file.h"

namespace meniscus {

namespace {

static_assert(std::endian::native == std::endian::little, "both formats are written as little endian");

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Larger coordinates have steps of more than 1e-3 Å in float32.
constexpr double kMostInFloat = 8192;

bool needsDouble(const std::vector<SurfaceMesh>& surfaces, const glm::dvec3& origin) {
  for (const SurfaceMesh& mesh : surfaces) {
    for (const MeshVertex& v : mesh.vertices) {
      const glm::dvec3 at = glm::abs(origin + glm::dvec3(v.position));
      if (std::max({at.x, at.y, at.z}) > kMostInFloat) return true;
    }
  }
  return false;
}

void writePly(OutputFile& file, const std::vector<SurfaceMesh>& surfaces, const glm::dvec3& origin) {
  constexpr std::size_t kBuffer = std::size_t{1} << 20;
  const bool wide = needsDouble(surfaces, origin);
  std::size_t vertices = 0, triangles = 0;
  for (const SurfaceMesh& mesh : surfaces) {
    vertices += mesh.vertices.size();
    triangles += mesh.triangles.size();
  }
  if (vertices > std::numeric_limits<std::int32_t>::max())
    throw InputError(
        fmt::format("cannot write '{}': {} vertices are more than a PLY file can number; give a "
                    "larger --mesh-spacing",
                    file.path().string(), vertices));
  const char* real = wide ? "double" : "float";
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment a molecular surface by Meniscus, in Angstrom\n"
      "element vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uint atom\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      vertices, real, real, real, triangles);
  const auto flush = [&](std::size_t limit) {
    if (bytes.size() < limit) return;
    file.write(bytes);
    bytes.clear();
  };
  for (const SurfaceMesh& mesh : surfaces) {
    for (const MeshVertex& v : mesh.vertices) {
      const glm::dvec3 at = origin + glm::dvec3(v.position);
      if (wide) {
        append(bytes, at);
      } else {
        append(bytes, glm::vec3(at));
      }
      append(bytes, v.normal);
      for (const int shift : {16, 8, 0}) append(bytes, static_cast<std::uint8_t>(v.color >> shift & 255u));
      append(bytes, v.id);
      flush(kBuffer);
    }
  }
  std::uint32_t before = 0;
  for (const SurfaceMesh& mesh : surfaces) {
    for (const glm::uvec3& t : mesh.triangles) {
      append(bytes, std::uint8_t{3});
      append(bytes, t + before);
      flush(kBuffer);
    }
    before += static_cast<std::uint32_t>(mesh.vertices.size());
  }
  flush(0);
}

std::uint16_t linear16(std::uint32_t byte) {
  return static_cast<std::uint16_t>(linearFromSrgb(byte / 255.0) * 65535 + 0.5);
}

// The binary part of a glTF file as it grows.
class GltfBuilder {
 public:
  void add(const SurfaceMesh& mesh, const glm::dvec3& origin);
  tinygltf::Model& finished();

 private:
  template <class T, class Value>
  int addAccessor(std::size_t count, int target, int componentType, int type, const Value& value);

  tinygltf::Model model_;
  tinygltf::Buffer buffer_;
};

// `value(i)` gives the i-th T.
template <class T, class Value>
int GltfBuilder::addAccessor(std::size_t count, int target, int componentType, int type, const Value& value) {
  static_assert(sizeof(T) % 4 == 0);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = buffer_.data.size();
  view.byteLength = count * sizeof(T);
  view.target = target;
  buffer_.data.resize(view.byteOffset + view.byteLength);
  for (std::size_t i = 0; i < count; ++i) {
    const T item = value(i);
    std::memcpy(buffer_.data.data() + view.byteOffset + i * sizeof(T), &item, sizeof(T));
  }
  model_.bufferViews.push_back(view);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
  accessor.componentType = componentType;
  accessor.type = type;
  accessor.count = type == TINYGLTF_TYPE_SCALAR ? count * sizeof(T) / 4 : count;
  model_.accessors.push_back(accessor);
  return static_cast<int>(model_.accessors.size()) - 1;
}

void GltfBuilder::add(const SurfaceMesh& mesh, const glm::dvec3& origin) {
  if (mesh.triangles.empty()) return;
  const std::size_t count = mesh.vertices.size();
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = 0;
  const int positions =
      addAccessor<glm::vec3>(count, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                             TINYGLTF_TYPE_VEC3, [&](std::size_t i) { return mesh.vertices[i].position; });
  glm::vec3 low(std::numeric_limits<float>::max()), high = -low;
  for (const MeshVertex& v : mesh.vertices) {
    low = glm::min(low, v.position);
    high = glm::max(high, v.position);
  }
  tinygltf::Accessor& bounds = model_.accessors[static_cast<std::size_t>(positions)];
  for (glm::length_t k = 0; k < 3; ++k) {
    bounds.minValues.push_back(static_cast<double>(low[k]));
    bounds.maxValues.push_back(static_cast<double>(high[k]));
  }
  primitive.attributes["POSITION"] = positions;
  primitive.attributes["NORMAL"] =
      addAccessor<glm::vec3>(count, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                             TINYGLTF_TYPE_VEC3, [&](std::size_t i) { return mesh.vertices[i].normal; });
  const int colors = addAccessor<std::array<std::uint16_t, 4>>(
      count, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4,
      [&](std::size_t i) {
        const std::uint32_t c = mesh.vertices[i].color;
        return std::array<std::uint16_t, 4>{linear16(c >> 16 & 255u), linear16(c >> 8 & 255u),
                                            linear16(c & 255u), 65535};
      });
  model_.accessors[static_cast<std::size_t>(colors)].normalized = true;
  primitive.attributes["COLOR_0"] = colors;
  primitive.indices = addAccessor<glm::uvec3>(mesh.triangles.size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                                              TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                              [&](std::size_t i) { return mesh.triangles[i]; });

  tinygltf::Mesh part;
  part.name = fmt::format("surface {}", model_.meshes.size() + 1);
  part.primitives.push_back(primitive);
  model_.meshes.push_back(part);
  tinygltf::Node node;
  node.name = part.name;
  node.mesh = static_cast<int>(model_.meshes.size()) - 1;
  node.translation = {origin.x, origin.y, origin.z};
  model_.nodes.push_back(node);
}

tinygltf::Model& GltfBuilder::finished() {
  model_.asset.version = "2.0";
  model_.asset.generator = "Meniscus";
  model_.asset.extras = tinygltf::Value(
      tinygltf::Value::Object{{"unit", tinygltf::Value(std::string("1 Angstrom, the structure's axes"))}});
  tinygltf::Material material;
  material.name = "atom colours";
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.6;
  model_.materials.push_back(material);
  tinygltf::Scene scene;
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) scene.nodes.push_back(static_cast<int>(i));
  model_.scenes.push_back(scene);
  model_.defaultScene = 0;
  if (!buffer_.data.empty()) model_.buffers.push_back(std::move(buffer_));
  return model_;
}

// What is written to it goes to an OutputFile.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(OutputFile& file) : file_(file) {}

 protected:
  std::streamsize xsputn(const char* data, std::streamsize count) override {
    file_.write({data, static_cast<std::size_t>(count)});
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    file_.write({&byte, 1});
    return c;
  }

 private:
  OutputFile& file_;
};

void writeGlb(OutputFile& file, const std::vector<SurfaceMesh>& surfaces, const glm::dvec3& origin) {
  std::uint64_t bytes = 1 << 20;  // of the rest
  for (const SurfaceMesh& mesh : surfaces) bytes += mesh.vertices.size() * 32 + mesh.triangles.size() * 12;
  if (bytes > std::numeric_limits<std::uint32_t>::max())
    throw InputError(
        fmt::format("cannot write '{}': a .glb file has at most 4 GiB, the surface takes {:.1f}; "
                    "give a larger --mesh-spacing or write .ply",
                    file.path().string(), static_cast<double>(bytes) / 0x1p30));
  GltfBuilder builder;
  for (const SurfaceMesh& mesh : surfaces) builder.add(mesh, origin);
  FileBuffer buffer(file);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit | std::ios::failbit);  // what the file throws comes through
  tinygltf::TinyGLTF writer;
  MENISCUS_CHECK(writer.WriteGltfSceneToStream(&builder.finished(), stream, false, true));
}

bool endsIn(const std::filesystem::path& path, const char* extension) {
  return lowerCase(path.extension().string()) == extension;
}

}  // namespace

void requireMeshName(const char* option, const std::filesystem::path& path) {
  if (endsIn(path, ".ply") || endsIn(path, ".glb")) return;
  throw UsageError(fmt::format("{}: '{}' is neither .ply nor .glb; let the name end in one of them", option,
                               path.string()));
}

void writeMeshFile(const std::filesystem::path& path, const std::vector<SurfaceMesh>& surfaces,
                   const glm::dvec3& origin) {
  OutputFile file(path);
  if (endsIn(path, ".glb")) {
    writeGlb(file, surfaces, origin);
  } else {
    writePly(file, surfaces, origin);
  }
  file.commit();
}

}  // namespace meniscus
