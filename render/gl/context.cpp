#include "render/gl/context.h"

#include <glad/gl.h>

#include "core/error.h"
#include "render/gl/context_backends.h"
#include "render/gl/debug.h"

namespace meniscus {

namespace gl {

namespace {

std::string text(GLenum what) {
  const GLubyte* value = glGetString(what);
  return value ? reinterpret_cast<const char*>(value) : "";
}

}  // namespace

void describeCurrent(BackendReport& report) {
  report.works = true;
  report.vendor = text(GL_VENDOR);
  report.renderer = text(GL_RENDERER);
  report.glVersion = text(GL_VERSION);
  report.glslVersion = text(GL_SHADING_LANGUAGE_VERSION);
  const auto limit = [&](const char* name, GLenum what) {
    GLint64 values[2] = {0, 0};  // GL_MAX_VIEWPORT_DIMS are two
    glGetInteger64v(what, values);
    report.limits.emplace_back(name, values[0]);
  };
  limit("TEXTURE_SIZE", GL_MAX_TEXTURE_SIZE);
  limit("VIEWPORT_DIMS", GL_MAX_VIEWPORT_DIMS);
  limit("SHADER_STORAGE_BLOCK_SIZE", GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  limit("SHADER_STORAGE_BUFFER_BINDINGS", GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  limit("TEXTURE_BUFFER_SIZE", GL_MAX_TEXTURE_BUFFER_SIZE);
  limit("TEXTURE_IMAGE_UNITS", GL_MAX_TEXTURE_IMAGE_UNITS);
  limit("DRAW_BUFFERS", GL_MAX_DRAW_BUFFERS);
  limit("COMPUTE_WORK_GROUP_INVOCATIONS", GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
}

std::string loadFunctions(ProcAddress getProcAddress) {
  const int version = gladLoadGL(reinterpret_cast<GLADloadfunc>(getProcAddress));
  if (version == 0) return "its OpenGL functions cannot be loaded";
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    return "it offers OpenGL " + std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
           std::to_string(GLAD_VERSION_MINOR(version)) + ", 4.5 is needed";
  }
  installDebugOutput();
  return {};
}

}  // namespace gl

void requireContextAlive() {
  // OSMesa may lack the function: there is no driver to be reset.
  if (glGetGraphicsResetStatus == nullptr || glGetGraphicsResetStatus() == GL_NO_ERROR) return;
  throw GraphicsError(
      "the graphics driver was reset while it drew; run it again, and if that happens again, with "
      "--backend osmesa or a smaller --size");
}

namespace {

// What `backend` stands for, in order of preference.
std::vector<std::unique_ptr<gl::ContextMaker>> makersFor(Backend backend) {
  std::vector<std::unique_ptr<gl::ContextMaker>> makers;
  if (backend != Backend::osmesa) makers = gl::eglMakers();
  if (backend != Backend::egl) makers.push_back(gl::osmesaMaker());
  return makers;
}

}  // namespace

std::unique_ptr<Context> Context::create(Backend backend) {
  std::string failures, remedy;
  for (const auto& maker : makersFor(backend)) {
    BackendReport report;
    if (std::unique_ptr<Context> context = maker->make(report)) {
      gl::describeCurrent(report);
      context->name_ = report.name;
      context->renderer_ = report.renderer;
      context->version_ = report.glVersion;
      return context;
    }
    failures += (failures.empty() ? "" : "; ") + report.name + ": " + report.reason;
    if (remedy.empty()) remedy = report.remedy;
  }
  throw GraphicsError("no OpenGL 4.5 context (" + failures + "); " + remedy +
                      "; 'meniscus doctor' shows every way in detail");
}

std::vector<BackendReport> diagnoseBackends() {
  std::vector<BackendReport> reports;
  for (const auto& maker : makersFor(Backend::automatic)) {
    BackendReport report;
    if (const std::unique_ptr<Context> context = maker->make(report)) gl::describeCurrent(report);
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace meniscus
