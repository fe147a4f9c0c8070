#pragma once
// A GL context for a test. A machine where none can be made fails the test; it is never skipped.

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "core/error.h"
#include "render/gl/context.h"
#include "render/gl/debug.h"
#include "render/renderer.h"

namespace meniscus::test {

class GlTest : public testing::Test {
 protected:
  void SetUp() override {
    setenv("MENISCUS_GL_DEBUG", "1", 1);
    try {
      context_ = Context::create(Backend::automatic);
    } catch (const Error& error) {
      FAIL() << error.what();
    }
  }
  void TearDown() override {
    if (context_) {
      for (const std::string& message : gl::takeDebugMessages()) ADD_FAILURE() << "driver: " << message;
    }
  }

 private:
  std::unique_ptr<Context> context_;
};

/// Whether the processor computes what it can of a picture beside casting, or shaders do, on any machine.
inline RendererOptions effectsBy(bool processor, int maxTileSize = 0) {
  RendererOptions options;
  options.effectsOnProcessor = processor;
  options.maxTileSize = maxTileSize;
  return options;
}

}  // namespace meniscus::test
