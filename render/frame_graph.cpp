#include "render/frame_graph.h"

#include <glad/gl.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>

#include "core/error.h"

namespace meniscus {

namespace {

PassStats measured(const std::string& name, bool timed, const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  run();
  if (!timed) return {name, 1};
  glFinish();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  return {name, 1, spent.count(), 1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

}  // namespace

gl::Texture* TexturePool::acquire(const std::string& name, const gl::TextureDesc& desc) {
  for (Entry& entry : entries_) {
    if (!entry.used && entry.texture->desc == desc) {
      entry.used = true;
      entry.name = name;
      return entry.texture.get();
    }
  }
  entries_.push_back({std::make_unique<gl::Texture>(gl::Texture::make(desc)), name, true});
  return entries_.back().texture.get();
}

void ReturnToPool::operator()(gl::Texture* texture) const {
  pool->release(texture);
}

TextureLease TexturePool::lease(const std::string& name, const gl::TextureDesc& desc) {
  return TextureLease(acquire(name, desc), ReturnToPool{this});
}

void TexturePool::release(gl::Texture* texture) {
  for (Entry& entry : entries_) {
    if (entry.texture.get() == texture) entry.used = false;
  }
}

unsigned TexturePool::framebuffer(const std::vector<const gl::Texture*>& colors, const gl::Texture* depth) {
  std::vector<std::uint64_t> key;
  for (const gl::Texture* color : colors) key.push_back(color ? color->serial : 0);
  key.push_back(depth ? depth->serial : 0);
  if (const auto found = framebuffers_.find(key); found != framebuffers_.end()) return found->second.name();

  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  gl::Object object(gl::ObjectKind::framebuffer, name);
  std::vector<GLenum> drawBuffers;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const GLenum point = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    drawBuffers.push_back(colors[i] ? point : GLenum{GL_NONE});
    if (colors[i]) glNamedFramebufferTexture(name, point, colors[i]->object.name(), 0);
  }
  if (depth) glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth->object.name(), 0);
  glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(drawBuffers.size()), drawBuffers.data());
  const GLenum status = glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw GraphicsError("the driver refuses a framebuffer (status " + std::to_string(status) +
                        "); please report it with the output of 'meniscus doctor'");
  }
  framebuffers_.emplace(std::move(key), std::move(object));
  return name;
}

std::vector<ResourceStats> TexturePool::textures() const {
  std::vector<ResourceStats> out;
  for (const Entry& entry : entries_) out.push_back({entry.name, entry.texture->bytes()});
  return out;
}

void TexturePool::trim() {
  framebuffers_.clear();
  std::erase_if(entries_, [](const Entry& entry) { return !entry.used; });
}

const gl::Texture& PassContext::texture(TextureRef ref) const {
  return graph_.texture(ref);
}

bool PassContext::isLive(TextureRef ref) const {
  return ref.valid() && graph_.resources_[static_cast<std::size_t>(ref.index)].live;
}

bool PassContext::isInMemory(TextureRef ref) const {
  return graph_.resources_[static_cast<std::size_t>(ref.index)].inMemory;
}

TexturePool& PassContext::pool() const {
  return graph_.pool_;
}

void PassContext::bindTarget() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
}

void PassContext::part(const std::string& name, const std::function<void()>& run) const {
  graph_.parts_.push_back(measured(name, graph_.timed_, run));
}

FrameGraph::~FrameGraph() {
  for (Resource& resource : resources_) {
    if (resource.pooled) pool_.release(resource.pooled);
  }
}

TextureRef FrameGraph::create(std::string name, const gl::TextureDesc& desc, Clear clear) {
  resources_.push_back({.name = std::move(name), .desc = desc, .clear = clear});
  return {static_cast<int>(resources_.size()) - 1};
}

TextureRef FrameGraph::createInMemory(std::string name) {
  resources_.push_back({.name = std::move(name), .desc = {}, .inMemory = true});
  return {static_cast<int>(resources_.size()) - 1};
}

TextureRef FrameGraph::import(std::string name, const gl::Texture& texture, Clear clear) {
  resources_.push_back({.name = std::move(name), .desc = texture.desc, .clear = clear, .imported = &texture});
  return {static_cast<int>(resources_.size()) - 1};
}

void FrameGraph::addPass(std::string name, std::vector<TextureRef> reads, std::vector<Attachment> writes,
                         std::function<void(const PassContext&)> execute) {
  passes_.push_back({std::move(name), std::move(reads), std::move(writes), std::move(execute)});
}

void FrameGraph::want(TextureRef ref) {
  resources_[static_cast<std::size_t>(ref.index)].wanted = true;
}

const gl::Texture& FrameGraph::texture(TextureRef ref) const {
  MENISCUS_CHECK(ref.valid());
  const Resource& resource = resources_[static_cast<std::size_t>(ref.index)];
  MENISCUS_CHECK(resource.imported || resource.pooled);
  return resource.imported ? *resource.imported : *resource.pooled;
}

// Backwards from what is wanted: a pass lives if it writes something live, and makes what it reads live.
void FrameGraph::cull() {
  for (Resource& resource : resources_) resource.live = resource.wanted;
  for (std::size_t p = passes_.size(); p-- > 0;) {
    Pass& pass = passes_[p];
    pass.live = std::any_of(pass.writes.begin(), pass.writes.end(), [&](const Attachment& a) {
      return a.location != kTestedDepth && resources_[static_cast<std::size_t>(a.texture.index)].live;
    });
    if (!pass.live) continue;
    for (const TextureRef ref : pass.reads) resources_[static_cast<std::size_t>(ref.index)].live = true;
  }
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    if (!passes_[p].live) continue;
    for (const TextureRef ref : passes_[p].reads) {
      resources_[static_cast<std::size_t>(ref.index)].lastUse = static_cast<int>(p);
    }
    for (const Attachment& a : passes_[p].writes) {
      resources_[static_cast<std::size_t>(a.texture.index)].lastUse = static_cast<int>(p);
    }
  }
}

void FrameGraph::clearAttachment(unsigned framebuffer, Resource& resource, int location) {
  if (resource.written || resource.clear == Clear::none) return;
  const float value = resource.clear == Clear::infinity ? std::numeric_limits<float>::infinity() : 0.0f;
  const float floats[4] = {value, value, value, value};
  const GLuint zeros[4] = {0, 0, 0, 0};
  if (location == kDepth) {
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, floats);
  } else if (resource.desc.format == gl::TextureFormat::r32ui ||
             resource.desc.format == gl::TextureFormat::rgba32ui) {
    glClearNamedFramebufferuiv(framebuffer, GL_COLOR, location, zeros);
  } else {
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, location, floats);
  }
}

// Gives a texture that is read but was never written its initial contents.
void FrameGraph::materialize(Resource& resource) {
  if (resource.written || resource.imported || resource.inMemory) return;
  resource.pooled = pool_.acquire(resource.name, resource.desc);
  const bool depth = resource.desc.format == gl::TextureFormat::depth32f;
  const unsigned framebuffer =
      depth ? pool_.framebuffer({}, resource.pooled) : pool_.framebuffer({resource.pooled}, nullptr);
  clearAttachment(framebuffer, resource, depth ? kDepth : 0);
  resource.written = true;
}

void FrameGraph::run(Pass& pass) {
  for (const TextureRef ref : pass.reads) {
    const bool alsoWritten = std::any_of(pass.writes.begin(), pass.writes.end(), [&](const Attachment& a) {
      return a.texture.index == ref.index && a.location != kTestedDepth;
    });
    if (!alsoWritten) materialize(resources_[static_cast<std::size_t>(ref.index)]);
  }
  std::vector<const gl::Texture*> colors;
  const gl::Texture* depth = nullptr;
  gl::TextureDesc size;
  for (const Attachment& a : pass.writes) {
    Resource& resource = resources_[static_cast<std::size_t>(a.texture.index)];
    if (!resource.live || resource.inMemory) continue;
    if (!resource.imported && !resource.pooled) resource.pooled = pool_.acquire(resource.name, resource.desc);
    const gl::Texture* texture = resource.imported ? resource.imported : resource.pooled;
    size = texture->desc;
    if (a.location == kDepth || a.location == kTestedDepth) {
      depth = texture;
    } else {
      const auto location = static_cast<std::size_t>(a.location);
      if (colors.size() <= location) colors.resize(location + 1, nullptr);
      colors[location] = texture;
    }
  }
  const bool draws = !colors.empty() || depth != nullptr;
  const unsigned framebuffer = draws ? pool_.framebuffer(colors, depth) : 0;
  const PassContext context(*this, framebuffer, size.width, size.height);
  if (draws) context.bindTarget();
  for (const Attachment& a : pass.writes) {
    Resource& resource = resources_[static_cast<std::size_t>(a.texture.index)];
    if (!resource.live || resource.inMemory || a.location == kTestedDepth) continue;
    clearAttachment(framebuffer, resource, a.location);
    resource.written = true;
  }
  pass.execute(context);
}

void FrameGraph::execute(RenderStats& stats, bool timed) {
  timed_ = timed;
  const auto addPassStats = [&](const PassStats& pass) {
    auto entry = std::find_if(stats.passes.begin(), stats.passes.end(),
                              [&](const PassStats& s) { return s.name == pass.name; });
    if (entry == stats.passes.end()) entry = stats.passes.insert(entry, {pass.name});
    entry->runs += pass.runs;
    entry->milliseconds += pass.milliseconds;
    entry->processorMs += pass.processorMs;
  };
  cull();
  const auto addOmission = [&](const std::string& what, const std::string& reason) {
    const auto same = [&](const OmissionStats& o) { return o.what == what; };
    if (std::none_of(stats.omissions.begin(), stats.omissions.end(), same))
      stats.omissions.push_back({what, reason});
  };
  for (const OmissionStats& o : omissions_) addOmission(o.what, o.reason);
  for (const Resource& r : resources_) {
    if (!r.live) addOmission("channel " + r.name, "nobody reads it");
  }
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    Pass& pass = passes_[p];
    if (!pass.live) {
      addOmission("pass " + pass.name, "nothing it writes is wanted");
      continue;
    }
    PassStats spent = measured(pass.name, timed, [&] { run(pass); });
    for (const PassStats& part : parts_) {
      addPassStats(part);
      spent.milliseconds -= part.milliseconds;
      spent.processorMs -= part.processorMs;
    }
    parts_.clear();
    addPassStats(spent);
    for (Resource& resource : resources_) {
      if (resource.pooled && !resource.wanted && resource.lastUse == static_cast<int>(p)) {
        pool_.release(resource.pooled);
        resource.pooled = nullptr;
      }
    }
  }
  for (Resource& resource : resources_) {
    if (resource.wanted) materialize(resource);
  }
}

}  // namespace meniscus
