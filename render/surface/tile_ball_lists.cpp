#include "render/surface/tile_ball_lists.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace meniscus {

namespace {

constexpr std::uint32_t kLastOfTile = 0x80000000u;  // shaders/include/lists_nodes.glsl

// The balls that any block lists, by index.
std::vector<std::uint32_t> membersOf(const std::vector<const tiles::TileBlock*>& blocks) {
  std::vector<std::uint32_t> members;
  for (const tiles::TileBlock* block : blocks)
    members.insert(members.end(), block->members.begin(), block->members.end());
  tbb::parallel_sort(members);
  members.erase(std::unique(members.begin(), members.end()), members.end());
  return members;
}

// Of each tile the ranks of its balls in ascending order.
TileBlockEntries entriesOf(const tiles::TileBlock& block, const std::vector<std::uint32_t>& rankOfMember) {
  TileBlockEntries out;
  for (int t = 0; t < tiles::kTilesPerBlock; ++t) {
    const std::size_t first = out.entries.size();
    for (const std::uint32_t member : block.list(t)) out.entries.push_back(rankOfMember[member]);
    const auto begin = out.entries.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, out.entries.end());  // nearly in order: buckets of depth are
    out.counts[static_cast<std::size_t>(t)] = static_cast<std::uint32_t>(out.entries.size() - first);
    if (out.entries.size() > first) out.entries.back() |= kLastOfTile;
  }
  return out;
}

}  // namespace

void TileBallLists::setField(const MetaballField* field, const std::vector<float>* coreShares,
                             std::shared_ptr<const tiles::Clusters> clusters) {
  field_ = field;
  coreShares_ = coreShares;
  clusters_ = std::move(clusters);
  const FieldBox box = supportBox(*field);
  bounds_ = {0.5 * (box.low + box.high), 0.5 * glm::distance(box.low, box.high)};
  valid_ = false;
}

void TileBallLists::update(const tiles::TileTarget& target) {
  if (valid_ && tiles::sameLists(target_, target)) return;
  valid_ = false;
  const tiles::MetaballSource source(*field_, target);
  const bool cut = source.coresHide();
  cut_.build(source, *clusters_, target, cut);
  occupied_ = cut_.occupied(target.area);
  std::vector<const tiles::TileBlock*> blocks;
  bool wholeMade = false;
  for (int b = 0; b < cut_.grid().blocks(); ++b) {
    blocks.push_back(&cut_.block(b));
    // Where a ray may begin inside the surface it sees the far wall, which a front does not hide.
    const bool atNear =
        cut &&
        std::any_of(blocks.back()->members.begin(), blocks.back()->members.end(), [&](std::uint32_t ball) {
          const float front = source.place(ball).front;
          return front + cut_.slack() > static_cast<float>(target.view.nearZ);
        });
    if (!atNear) continue;
    if (!std::exchange(wholeMade, true)) whole_.build(source, *clusters_, target, false);
    blocks.back() = &whole_.block(b);
  }
  upload(target, blocks);
  target_ = target;
  valid_ = true;
}

void TileBallLists::upload(const tiles::TileTarget& target,
                           const std::vector<const tiles::TileBlock*>& blocks) {
  const std::vector<std::uint32_t> members = membersOf(blocks);
  MetaballField some{{}, field_->kernel, field_->level};
  std::vector<float> shares;
  for (const std::uint32_t ball : members) {
    some.balls.push_back(field_->balls[ball]);
    shares.push_back((*coreShares_)[ball]);
  }
  const Tile tile{target.area.x, target.area.y, target.area.width, target.area.height};
  // Of the whole field, so that a part of a picture has the bytes that it has in the whole.
  const View& view = target.view;
  const double middle = (view.rotation * ((target.origin - view.pivot) + bounds_.center)).z;
  const double plane = std::clamp(0.0, middle - bounds_.radius, middle + bounds_.radius);
  const ProjectedField projected =
      projectField(some, shares, view, target.origin, tile, target.sampleShift, BallOrder::distance, plane);
  balls_.upload(projected, target.view, tile);
  listed_ = projected.balls.size();
  std::vector<std::uint32_t> rankOf(members.size());
  for (std::size_t rank = 0; rank < projected.indices.size(); ++rank)
    rankOf[projected.indices[rank]] = static_cast<std::uint32_t>(rank);

  std::vector<TileBlockEntries> lists(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    std::vector<std::uint32_t> rankOfMember;
    for (const std::uint32_t ball : blocks[b]->members) {
      const auto at = std::lower_bound(members.begin(), members.end(), ball) - members.begin();
      rankOfMember.push_back(rankOf[static_cast<std::size_t>(at)]);
    }
    lists[b] = entriesOf(*blocks[b], rankOfMember);
  });

  lists_.upload(cut_.grid(), target.area, lists, "--surface-method tiles");
}

void TileBallLists::bind() const {
  balls_.bind();
  lists_.bind();
}

std::uint64_t TileBallLists::bytes() const {
  return balls_.bytes() + lists_.bytes() + cut_.bytes() + whole_.bytes();
}

}  // namespace meniscus
