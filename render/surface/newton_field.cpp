#include "render/surface/newton_field.h"

#include <glad/gl.h>

#include <algorithm>
#include <bit>
#include <glm/vec4.hpp>

#include "core/ambient_field.h"
#include "render/surface/ball_texture.h"
#include "render/surface/item_rows.h"

namespace meniscus {

namespace {

constexpr int kOthersPerRow = 4096;  // as in shaders/include/newton_balls.glsl

}  // namespace

void NewtonField::prepare(const MetaballField& field, int terms, int ambientCells, bool activeSmaller) {
  const std::size_t most =
      static_cast<std::size_t>(kOthersPerRow) * static_cast<std::size_t>(gl::queryLimits().textureSize);
  overlaps = findOverlaps(field, most, "--surface-method newton");
  rankOf.resize(overlaps.order.size());
  for (std::uint32_t rank = 0; rank < overlaps.order.size(); ++rank) rankOf[overlaps.order[rank]] = rank;
  for (std::uint32_t rank = 0; rank < overlaps.order.size(); ++rank) {
    const Metaball& ball = field.balls[overlaps.order[rank]];
    const double share = field.level / static_cast<double>(overlaps.of(rank).size() + 1);
    const double radius = static_cast<double>(ball.support) *
                          coreShare(field.kernel, share, static_cast<double>(ball.coefficient));
    hulls.push_back(static_cast<float>(radius * radius));
  }
  uploadBalls(field);
  uploadLists(activeSmaller);
  ambient = terms > 0 && ambientCells > 0;
  if (ambient) uploadAmbient(field, terms, ambientCells);
}

void NewtonField::uploadBalls(const MetaballField& field) {
  struct Texels {
    glm::vec3 center;
    float inverseR2, coefficient;
    std::uint32_t color, id, unused;
  };
  static_assert(sizeof(Texels) == 32);
  std::vector<Texels> texels;
  for (const std::uint32_t i : overlaps.order) {
    const Metaball& ball = field.balls[i];
    const double support = static_cast<double>(ball.support);
    texels.push_back(
        {ball.center, static_cast<float>(1 / (support * support)), ball.coefficient, ball.color, ball.id, 0});
  }
  balls_ = rowsOf(gl::TextureFormat::rgba32ui, texels, kBallsPerRow, 2);
}

void NewtonField::uploadLists(bool activeSmaller) {
  std::vector<std::uint32_t> others = overlaps.others;
  others_ = rowsOf(gl::TextureFormat::r32ui, others, kOthersPerRow, 1);
  std::vector<glm::uvec4> lists;
  for (std::uint32_t rank = 0; rank < overlaps.order.size(); ++rank)
    lists.emplace_back(overlaps.first[rank], overlaps.smaller[rank], overlaps.of(rank).size(),
                       activeSmaller ? 0 : overlaps.smaller[rank]);
  lists_ = rowsOf(gl::TextureFormat::rgba32ui, lists, kBallsPerRow, 1);
}

void NewtonField::uploadAmbient(const MetaballField& field, int terms, int cells) {
  const AmbientField grid = makeAmbientField(field, terms, cells);
  ambientBase = grid.base;
  ambientSpacing = grid.spacing;
  ambientNodes = grid.size;
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  ambient_ = gl::Object(gl::ObjectKind::texture, name);
  glTextureStorage3D(name, 1, GL_R32F, grid.size.x, grid.size.y, grid.size.z);
  glTextureSubImage3D(name, 0, 0, 0, 0, grid.size.x, grid.size.y, grid.size.z, GL_RED, GL_FLOAT,
                      grid.values.data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void NewtonField::uploadProjected(const ProjectedField& projected) {
  byRank_.assign(overlaps.order.size(), ProjectedBall{});
  for (std::size_t i = 0; i < projected.balls.size(); ++i)
    byRank_[rankOf[projected.indices[i]]] = projected.balls[i];
  if (!projected_.object) {
    projected_ = rowsOf(gl::TextureFormat::rgba32f, byRank_, kBallsPerRow, 4);
    return;
  }
  byRank_.resize(static_cast<std::size_t>(projected_.desc.height) * kBallsPerRow);
  projected_.write(projected_.desc.width, projected_.desc.height, byRank_.data(), 0, 0);
}

void NewtonField::bind() const {
  glBindTextureUnit(0, balls_.object.name());
  glBindTextureUnit(1, others_.object.name());
  glBindTextureUnit(2, ambient_.name());
  glBindTextureUnit(3, projected_.object.name());
  glBindTextureUnit(9, lists_.object.name());
}

std::uint64_t NewtonField::bytes() const {
  std::uint64_t sum = 0;
  for (const gl::Texture* texture : {&balls_, &others_, &lists_, &projected_})
    if (texture->object) sum += texture->bytes();
  return sum + 4 * static_cast<std::uint64_t>(ambientNodes.x) * static_cast<std::uint64_t>(ambientNodes.y) *
                   static_cast<std::uint64_t>(ambientNodes.z);
}

}  // namespace meniscus
