#pragma once
// Passes with declared reads and writes. Callers say what they want; what does not lead there is left out,
// and textures live from their first use to their last. The graph knows no effect and never reorders.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/gl/objects.h"
#include "render/render_stats.h"

namespace meniscus {

class TexturePool;

/// Gives a texture back to its pool.
struct ReturnToPool {
  TexturePool* pool = nullptr;
  void operator()(gl::Texture* texture) const;
};
using TextureLease = std::unique_ptr<gl::Texture, ReturnToPool>;

/// Textures and framebuffers that outlive a frame, so that the next one allocates nothing.
class TexturePool {
 public:
  /// A texture of exactly this description that is not in use. The name is for the statistics.
  gl::Texture* acquire(const std::string& name, const gl::TextureDesc& desc);
  void release(gl::Texture* texture);
  /// The same, given back when the lease ends, however that comes about. The pool must outlive it.
  TextureLease lease(const std::string& name, const gl::TextureDesc& desc);
  /// Framebuffer with these colour attachments (index = location, nullptr = none) and depth (or nullptr).
  unsigned framebuffer(const std::vector<const gl::Texture*>& colors, const gl::Texture* depth);
  std::vector<ResourceStats> textures() const;
  /// Deletes what is not in use.
  void trim();

 private:
  struct Entry {
    std::unique_ptr<gl::Texture> texture;
    std::string name;
    bool used = false;
  };
  std::vector<Entry> entries_;
  std::map<std::vector<std::uint64_t>, gl::Object> framebuffers_;  // by the textures' serial numbers
};

/// Handle of a texture in one graph.
struct TextureRef {
  int index = -1;
  bool valid() const { return index >= 0; }
};

/// Initial contents of a texture, where a graph's first pass writes to it.
enum class Clear : std::uint8_t { zero, infinity, none };

class FrameGraph;

/// What a pass sees while it runs: its framebuffer, if it draws into textures, is bound, its viewport set.
class PassContext {
 public:
  const gl::Texture& texture(TextureRef ref) const;
  /// Whether anybody wants this texture; if not it does not exist.
  bool isLive(TextureRef ref) const;
  /// Whether it has no texture.
  bool isInMemory(TextureRef ref) const;
  /// For textures and framebuffers that a pass needs within itself.
  TexturePool& pool() const;
  /// Binds the pass's framebuffer and viewport again, after others were bound.
  void bindTarget() const;
  /// Runs a part of the pass that has a line of its own in the statistics; the pass's own is what remains.
  void part(const std::string& name, const std::function<void()>& run) const;

 private:
  friend class FrameGraph;
  PassContext(const FrameGraph& graph, unsigned framebuffer, int width, int height)
      : graph_(graph), framebuffer_(framebuffer), width_(width), height_(height) {}
  const FrameGraph& graph_;
  unsigned framebuffer_;
  int width_, height_;
};

class FrameGraph {
 public:
  static constexpr int kDepth = -1;
  static constexpr int kTestedDepth = -2;  ///< depth that is only tested: attached, but not written
  static constexpr int kInMemory = -3;     ///< of createInMemory(): not attached
  struct Attachment {
    TextureRef texture;
    int location;  ///< fragment output location, kDepth or kTestedDepth
  };

  explicit FrameGraph(TexturePool& pool) : pool_(pool) {}

  TextureRef create(std::string name, const gl::TextureDesc& desc, Clear clear = Clear::zero);
  /// Something that passes keep in main memory themselves: the graph knows who needs it, and has no texture.
  TextureRef createInMemory(std::string name);
  /// A texture of somebody else's; it must outlive execute().
  TextureRef import(std::string name, const gl::Texture& texture, Clear clear);
  /// All attachments of a pass have the same size. A pass that tests depth names it among its reads, too.
  void addPass(std::string name, std::vector<TextureRef> reads, std::vector<Attachment> writes,
               std::function<void(const PassContext&)> execute);
  /// Notes for --explain that something was not even added.
  void leaveOut(std::string what, std::string reason) {
    omissions_.push_back({std::move(what), std::move(reason)});
  }

  void want(TextureRef ref);
  /// Runs what leads to the wanted textures. Wanted textures that the graph created stay readable through
  /// texture() until the graph is destroyed. Adds to stats.passes (times if `timed`) and stats.omissions.
  void execute(RenderStats& stats, bool timed);
  const gl::Texture& texture(TextureRef ref) const;
  ~FrameGraph();
  FrameGraph(const FrameGraph&) = delete;
  FrameGraph& operator=(const FrameGraph&) = delete;

 private:
  friend class PassContext;
  struct Resource {
    std::string name;
    gl::TextureDesc desc;
    Clear clear = Clear::zero;
    const gl::Texture* imported = nullptr;
    gl::Texture* pooled = nullptr;
    bool inMemory = false;
    bool wanted = false, live = false, written = false;
    int lastUse = -1;
  };
  struct Pass {
    std::string name;
    std::vector<TextureRef> reads;
    std::vector<Attachment> writes;
    std::function<void(const PassContext&)> execute;
    bool live = false;
  };
  void cull();
  void run(Pass& pass);
  void materialize(Resource& resource);
  void clearAttachment(unsigned framebuffer, Resource& resource, int location);

  TexturePool& pool_;
  std::vector<Resource> resources_;
  std::vector<Pass> passes_;
  std::vector<OmissionStats> omissions_;
  bool timed_ = false;
  mutable std::vector<PassStats> parts_;  // of the pass that runs
};

}  // namespace meniscus
