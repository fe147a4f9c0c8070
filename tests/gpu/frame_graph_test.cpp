// The frame graph: what runs, in which order, what is allocated, what it holds.

#include "render/frame_graph.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/gl_fixture.h"

namespace meniscus {
namespace {

using gl::TextureFormat;
using Names = std::vector<std::string>;

constexpr int kWidth = 5, kHeight = 3;
constexpr gl::TextureDesc kFloats{TextureFormat::r32f, kWidth, kHeight};
constexpr gl::TextureDesc kIds{TextureFormat::r32ui, kWidth, kHeight};
constexpr gl::TextureDesc kDepths{TextureFormat::depth32f, kWidth, kHeight};
constexpr gl::TextureDesc kColors{TextureFormat::rgba8, kWidth, kHeight};

template <typename T>
std::vector<T> contents(const gl::Texture& texture, std::size_t channels = 1) {
  std::vector<T> out(channels * kWidth * kHeight);
  texture.read(kWidth, kHeight, kWidth, out.data());
  return out;
}

template <typename T>
std::vector<T> filled(T value, std::size_t channels = 1) {
  return std::vector<T>(channels * kWidth * kHeight, value);
}

// Without a program: a pass that writes its first colour attachment does so by clearing it.
void paint(float value) {
  const float values[] = {value, value, value, value};
  glClearBufferfv(GL_COLOR, 0, values);
}

class FrameGraphTest : public test::GlTest {
 protected:
  // A pass that notes that it ran and fills its first colour attachment.
  void add(FrameGraph& graph, const std::string& name, const std::vector<TextureRef>& reads, TextureRef write,
           float value = 1) {
    graph.addPass(name, reads, {{write, 0}}, [this, name, value](const PassContext&) {
      order.push_back(name);
      paint(value);
    });
  }
  Names order;
  TexturePool pool;
  RenderStats stats;
};

bool omitted(const RenderStats& stats, const std::string& what) {
  return std::any_of(stats.omissions.begin(), stats.omissions.end(),
                     [&](const OmissionStats& o) { return o.what == what && !o.reason.empty(); });
}

int runsOf(const RenderStats& stats, const std::string& name) {
  for (const PassStats& pass : stats.passes) {
    if (pass.name == name) return pass.runs;
  }
  return 0;
}

TEST_F(FrameGraphTest, RunsWhatLeadsToTheWantedInTheOrderOfAdding) {
  FrameGraph graph(pool);
  const TextureRef a = graph.create("a", kFloats), b = graph.create("b", kFloats),
                   c = graph.create("c", kFloats), unused = graph.create("unused", kFloats);
  add(graph, "first", {}, a);
  add(graph, "side", {a}, unused);
  add(graph, "second", {a}, b);
  add(graph, "third", {a, b}, c);
  add(graph, "after", {c}, unused);
  graph.want(c);
  graph.execute(stats, false);
  EXPECT_EQ(order, (Names{"first", "second", "third"}));
  EXPECT_TRUE(omitted(stats, "pass side"));
  EXPECT_TRUE(omitted(stats, "pass after"));
  EXPECT_TRUE(omitted(stats, "channel unused"));
  EXPECT_FALSE(omitted(stats, "pass first"));
  EXPECT_FALSE(omitted(stats, "channel a"));
}

TEST_F(FrameGraphTest, NothingWantedRunsAndAllocatesNothing) {
  FrameGraph graph(pool);
  const TextureRef a = graph.create("a", kFloats);
  add(graph, "first", {}, a);
  graph.execute(stats, false);
  EXPECT_TRUE(order.empty());
  EXPECT_TRUE(pool.textures().empty());
  EXPECT_TRUE(stats.passes.empty());
}

// A pass that only overwrites what an earlier pass needed has no reason to run.
TEST_F(FrameGraphTest, AWriteAfterTheLastReadIsLeftOut) {
  FrameGraph graph(pool);
  const TextureRef a = graph.create("a", kFloats), result = graph.create("result", kFloats);
  add(graph, "make", {}, a);
  add(graph, "use", {a}, result);
  add(graph, "overwrite", {}, a);
  graph.want(result);
  graph.execute(stats, false);
  EXPECT_EQ(order, (Names{"make", "use"}));
}

TEST_F(FrameGraphTest, UnwantedChannelsOfALivePassAreNeverAllocated) {
  FrameGraph graph(pool);
  const TextureRef color = graph.create("color", kColors), id = graph.create("id", kIds),
                   depth = graph.create("depth", kDepths);
  graph.addPass("draw", {depth}, {{color, 0}, {id, 1}, {depth, FrameGraph::kDepth}},
                [&](const PassContext& context) {
                  EXPECT_FALSE(context.isLive(color));
                  EXPECT_TRUE(context.isLive(id));
                  EXPECT_TRUE(context.isLive(depth));
                  EXPECT_FALSE(context.isLive(TextureRef{}));
                  GLint first = -1, second = -1;
                  glGetIntegerv(GL_DRAW_BUFFER0, &first);
                  glGetIntegerv(GL_DRAW_BUFFER1, &second);
                  EXPECT_EQ(first, static_cast<GLint>(GL_NONE));
                  EXPECT_EQ(second, static_cast<GLint>(GL_COLOR_ATTACHMENT1))
                      << "locations stay where the shader expects them";
                });
  graph.want(id);
  graph.execute(stats, false);
  Names names;
  for (const ResourceStats& texture : pool.textures()) names.push_back(texture.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (Names{"depth", "id"}));
  EXPECT_TRUE(omitted(stats, "channel color"));
}

// Depth that is only tested is neither cleared nor a reason to run.
TEST_F(FrameGraphTest, TestedDepthIsAttachedAndNotWritten) {
  FrameGraph graph(pool);
  const TextureRef depth = graph.create("depth", kDepths), color = graph.create("color", kFloats),
                   unwanted = graph.create("unwanted", kFloats);
  graph.addPass("draw", {depth}, {{depth, FrameGraph::kDepth}}, [](const PassContext&) {
    const float half_ = 0.5f;
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    glClearNamedFramebufferfv(static_cast<GLuint>(bound), GL_DEPTH, 0, &half_);
  });
  graph.addPass("use", {depth}, {{color, 0}, {depth, FrameGraph::kTestedDepth}}, [](const PassContext&) {
    GLint type = 0;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
                                          GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
    EXPECT_EQ(type, GL_TEXTURE);
  });
  graph.addPass("look", {depth}, {{unwanted, 0}, {depth, FrameGraph::kTestedDepth}},
                [](const PassContext&) { ADD_FAILURE() << "nobody wants it"; });
  graph.want(color);
  graph.want(depth);
  graph.execute(stats, false);
  std::vector<float> values(static_cast<std::size_t>(kWidth * kHeight));
  graph.texture(depth).read(kWidth, kHeight, kWidth, values.data());
  for (const float value : values) EXPECT_EQ(value, 0.5f);
}

TEST_F(FrameGraphTest, APassFindsItsFramebufferAndViewportSet) {
  FrameGraph graph(pool);
  const TextureRef a = graph.create("a", kFloats);
  graph.addPass("draw", {}, {{a, 0}}, [](const PassContext&) {
    GLint viewport[4] = {0, 0, 0, 0}, framebuffer = 0;
    glGetIntegerv(GL_VIEWPORT, viewport);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    EXPECT_NE(framebuffer, 0);
    EXPECT_EQ(viewport[2], kWidth);
    EXPECT_EQ(viewport[3], kHeight);
  });
  graph.want(a);
  graph.execute(stats, false);
}

TEST_F(FrameGraphTest, TransientTexturesAreReusedWhenTheirLivesDoNotOverlap) {
  FrameGraph graph(pool);
  TextureRef last = graph.create("0", kFloats);
  add(graph, "pass 0", {}, last);
  for (int i = 1; i < 8; ++i) {
    const TextureRef next = graph.create(std::to_string(i), kFloats);
    add(graph, "pass " + std::to_string(i), {last}, next);
    last = next;
  }
  graph.want(last);
  graph.execute(stats, false);
  EXPECT_EQ(order.size(), 8u);
  EXPECT_EQ(pool.textures().size(), 2u) << "each pass reads one and writes another";
}

TEST_F(FrameGraphTest, TexturesThatLiveTogetherAreDifferent) {
  FrameGraph graph(pool);
  const TextureRef a = graph.create("a", kFloats), b = graph.create("b", kFloats),
                   c = graph.create("c", kFloats);
  add(graph, "a", {}, a, 1);
  add(graph, "b", {}, b, 2);
  graph.addPass("c", {a, b}, {{c, 0}}, [&](const PassContext& context) {
    EXPECT_EQ(contents<float>(context.texture(a)), filled(1.0f));
    EXPECT_EQ(contents<float>(context.texture(b)), filled(2.0f));
    paint(3);
  });
  graph.want(c);
  graph.execute(stats, false);
  EXPECT_EQ(contents<float>(graph.texture(c)), filled(3.0f));
}

TEST_F(FrameGraphTest, OnlyEqualDescriptionsShareATexture) {
  FrameGraph graph(pool);
  const TextureRef a = graph.create("a", kFloats),
                   b = graph.create("b", {TextureFormat::r32f, kWidth + 1, kHeight}),
                   c = graph.create("c", kColors);
  add(graph, "a", {}, a);
  add(graph, "b", {a}, b);
  add(graph, "c", {b}, c);
  graph.want(c);
  graph.execute(stats, false);
  EXPECT_EQ(pool.textures().size(), 3u);
}

TEST_F(FrameGraphTest, TheNextFrameAllocatesNothing) {
  for (int frame = 0; frame < 3; ++frame) {
    FrameGraph graph(pool);
    const TextureRef a = graph.create("a", kFloats), b = graph.create("b", kFloats);
    add(graph, "a", {}, a);
    add(graph, "b", {a}, b);
    graph.want(b);
    graph.execute(stats, false);
    EXPECT_EQ(pool.textures().size(), 2u);
  }
  EXPECT_EQ(runsOf(stats, "a"), 3);
  EXPECT_EQ(runsOf(stats, "b"), 3);
  EXPECT_EQ(stats.passes.size(), 2u) << "one entry per name";
  EXPECT_EQ(stats.passes[0].milliseconds, 0.0) << "not timed";
  pool.trim();
  EXPECT_TRUE(pool.textures().empty());
}

TEST_F(FrameGraphTest, WantedTexturesStayUntilTheGraphIsGone) {
  {
    FrameGraph graph(pool);
    const TextureRef a = graph.create("a", kFloats), b = graph.create("b", kFloats);
    add(graph, "a", {}, a, 7);
    add(graph, "b", {a}, b, 8);
    graph.want(a);
    graph.want(b);
    graph.execute(stats, false);
    FrameGraph other(pool);
    const TextureRef c = other.create("c", kFloats);
    add(other, "c", {}, c, 9);
    other.want(c);
    other.execute(stats, false);
    EXPECT_EQ(contents<float>(graph.texture(a)), filled(7.0f));
    EXPECT_EQ(contents<float>(graph.texture(b)), filled(8.0f));
    pool.trim();
    EXPECT_EQ(pool.textures().size(), 3u) << "trim leaves what is in use";
  }
  pool.trim();
  EXPECT_TRUE(pool.textures().empty());
}

TEST_F(FrameGraphTest, EveryFormatIsClearedBeforeItsFirstWriteEvenInAUsedTexture) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int frame = 0; frame < 2; ++frame) {
    FrameGraph graph(pool);
    const TextureRef color = graph.create("color", kColors), id = graph.create("id", kIds),
                     far = graph.create("far", kFloats, Clear::infinity),
                     near = graph.create("near", kFloats), depth = graph.create("depth", kDepths);
    graph.addPass("draw", {depth}, {{color, 0}, {id, 1}, {far, 2}, {near, 3}, {depth, FrameGraph::kDepth}},
                  [&](const PassContext& context) {
                    EXPECT_EQ(contents<std::uint8_t>(context.texture(color), 4), filled<std::uint8_t>(0, 4));
                    EXPECT_EQ(contents<std::uint32_t>(context.texture(id)), filled(0u));
                    EXPECT_EQ(contents<float>(context.texture(far)), filled(kInfinity));
                    EXPECT_EQ(contents<float>(context.texture(near)), filled(0.0f));
                    EXPECT_EQ(contents<float>(context.texture(depth)), filled(0.0f))
                        << "reversed z: 0 is far";
                    const float ones[] = {1, 1, 1, 1};
                    const GLuint sevens[] = {7, 7, 7, 7};
                    glClearBufferfv(GL_COLOR, 0, ones);
                    glClearBufferuiv(GL_COLOR, 1, sevens);
                    glClearBufferfv(GL_COLOR, 2, ones);
                    glClearBufferfv(GL_COLOR, 3, ones);
                    glClearBufferfv(GL_DEPTH, 0, ones);
                  });
    // The second pass finds what the first one wrote: only the first write of a texture clears.
    graph.addPass("more", {depth}, {{color, 0}, {id, 1}, {far, 2}, {near, 3}, {depth, FrameGraph::kDepth}},
                  [&](const PassContext& context) {
                    EXPECT_EQ(contents<std::uint32_t>(context.texture(id)), filled(7u));
                    EXPECT_EQ(contents<float>(context.texture(far)), filled(1.0f));
                    EXPECT_EQ(contents<float>(context.texture(depth)), filled(1.0f));
                  });
    for (const TextureRef ref : {color, id, far, near}) graph.want(ref);
    graph.execute(stats, false);
  }
  EXPECT_EQ(pool.textures().size(), 5u);
}

TEST_F(FrameGraphTest, WhatIsReadButNeverWrittenHoldsItsClearValue) {
  {  // leaves other values in the pool's textures
    FrameGraph graph(pool);
    const TextureRef a = graph.create("a", kFloats), b = graph.create("b", kFloats);
    add(graph, "a", {}, a, 5);
    add(graph, "b", {}, b, 5);
    graph.want(a);
    graph.want(b);
    graph.execute(stats, false);
  }
  FrameGraph graph(pool);
  const TextureRef zero = graph.create("zero", kFloats), far = graph.create("far", kFloats, Clear::infinity),
                   id = graph.create("id", kIds), depth = graph.create("depth", kDepths),
                   out = graph.create("out", kFloats),
                   wanted = graph.create("wanted", kFloats, Clear::infinity);
  int checks = 0;
  graph.addPass("read", {zero, far, id, depth}, {{out, 0}}, [&](const PassContext& context) {
    EXPECT_EQ(contents<float>(context.texture(zero)), filled(0.0f));
    EXPECT_EQ(contents<float>(context.texture(far)), filled(std::numeric_limits<float>::infinity()));
    EXPECT_EQ(contents<std::uint32_t>(context.texture(id)), filled(0u));
    EXPECT_EQ(contents<float>(context.texture(depth)), filled(0.0f));
    ++checks;
  });
  graph.want(out);
  graph.want(wanted);
  graph.execute(stats, false);
  EXPECT_EQ(checks, 1);
  EXPECT_EQ(contents<float>(graph.texture(wanted)), filled(std::numeric_limits<float>::infinity()))
      << "wanted, though no pass writes it";
}

TEST_F(FrameGraphTest, ImportedTexturesKeepTheirContentsUnlessClearedAndAreNotPooled) {
  const gl::Texture mine = gl::Texture::make(kFloats);
  for (const auto& [clear, expected] : {std::pair{Clear::zero, 0.0f}, std::pair{Clear::none, 4.0f}}) {
    FrameGraph graph(pool);
    const TextureRef target = graph.import("mine", mine, clear);
    graph.addPass("look", {}, {{target, 0}}, [&, value = expected](const PassContext& context) {
      EXPECT_EQ(&context.texture(target), &mine);
      EXPECT_EQ(contents<float>(context.texture(target)), filled(value));
      paint(4);
    });
    graph.want(target);
    graph.execute(stats, false);
  }
  EXPECT_EQ(contents<float>(mine), filled(4.0f));
  EXPECT_TRUE(pool.textures().empty());
}

// Drivers use names again: a framebuffer remembered by name must not belong to a texture of the past.
TEST_F(FrameGraphTest, AnImportedTextureMayDieBetweenFrames) {
  for (int frame = 1; frame <= 3; ++frame) {
    const gl::Texture mine = gl::Texture::make(kFloats);
    FrameGraph graph(pool);
    const TextureRef target = graph.import("mine", mine, Clear::zero);
    add(graph, "paint", {}, target, static_cast<float>(frame));
    graph.want(target);
    graph.execute(stats, false);
    EXPECT_EQ(contents<float>(mine), filled(static_cast<float>(frame))) << "frame " << frame;
  }
}

TEST_F(FrameGraphTest, OmissionsAreSaidOnceAndTimesOnlyWhenAsked) {
  for (int frame = 0; frame < 2; ++frame) {
    FrameGraph graph(pool);
    const TextureRef a = graph.create("a", kFloats);
    add(graph, "a", {}, a);
    graph.leaveOut("pass shadow", "no light casts one");
    graph.want(a);
    graph.execute(stats, true);
  }
  const auto said = std::count_if(stats.omissions.begin(), stats.omissions.end(),
                                  [](const OmissionStats& o) { return o.what == "pass shadow"; });
  EXPECT_EQ(said, 1);
  ASSERT_EQ(stats.passes.size(), 1u);
  EXPECT_GT(stats.passes[0].milliseconds, 0.0);
}

TEST_F(FrameGraphTest, ThePoolIsFreeAgainAfterAPassFails) {
  const auto fail = [&] {
    FrameGraph graph(pool);
    const TextureRef a = graph.create("a", kFloats), b = graph.create("b", kFloats);
    add(graph, "a", {}, a);
    graph.addPass("b", {a}, {{b, 0}}, [](const PassContext&) { throw InputError("a broken shader"); });
    graph.want(b);
    graph.execute(stats, false);
  };
  for (int i = 0; i < 3; ++i) EXPECT_THROW(fail(), InputError);
  EXPECT_EQ(pool.textures().size(), 2u);
  pool.trim();
  EXPECT_TRUE(pool.textures().empty());
}

}  // namespace
}  // namespace meniscus
