#include "app/view/window_drawing.h"

#include <backends/imgui_impl_opengl3_loader.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>

#include "core/error.h"

namespace meniscus {
namespace {

// Of the OpenGL registry, where Dear ImGui's loader has no use for them.
constexpr GLint kClampToEdge = 0x812F, kRgba8 = 0x8058;
constexpr GLenum kWrapS = 0x2802, kWrapT = 0x2803, kUnpackAlignment = 0x0CF5;

constexpr const char* kVertexShader = R"(#version 330
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 inTexture;
layout(location = 2) in vec4 color;
uniform mat4 projection;
out vec2 vTexture;
out vec4 vColor;
void main() {
  vTexture = inTexture;
  vColor = color;
  gl_Position = projection * vec4(position, 0.0, 1.0);
}
)";
constexpr const char* kFragmentShader = R"(#version 330
in vec2 vTexture;
in vec4 vColor;
uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() {
  color = vColor * texture(picture, vTexture);
}
)";

std::string logOf(GLuint name, PFNGLGETSHADERIVPROC lengthOf, PFNGLGETSHADERINFOLOGPROC textOf) {
  GLint length = 0;
  lengthOf(name, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  textOf(name, static_cast<GLsizei>(log.size()), nullptr, log.data());
  log.resize(std::min(log.find_first_of(std::string("\n\0", 2)), log.size()));  // its first line
  return log;
}

GLuint compiled(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good != GL_TRUE)
    throw GraphicsError(fmt::format("the window's shader does not compile: {}",
                                    logOf(shader, glGetShaderiv, glGetShaderInfoLog)));
  return shader;
}

GLuint linked() {
  const GLuint program = glCreateProgram();
  const GLuint vertex = compiled(GL_VERTEX_SHADER, kVertexShader);
  const GLuint fragment = compiled(GL_FRAGMENT_SHADER, kFragmentShader);
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint good = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good != GL_TRUE)
    throw GraphicsError(fmt::format("the window's shaders do not link: {}",
                                    logOf(program, glGetProgramiv, glGetProgramInfoLog)));
  return program;
}

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

}  // namespace

void loadWindowFunctions(void (*(*getProcAddress)(const char*))()) {
  const bool found = imgl3wInit2(getProcAddress) == GL3W_OK && imgl3wIsSupported(3, 3) != 0;
  if (!found || std::count(std::begin(imgl3wProcs.ptr), std::end(imgl3wProcs.ptr), nullptr) > 0)
    throw GraphicsError("its OpenGL is older than 3.3");
}

WindowTexture::~WindowTexture() {
  if (name_ != 0) glDeleteTextures(1, &name_);
}

void WindowTexture::set(ImageSize size, std::span<const std::byte> pixels) {
  if (name_ == 0) glGenTextures(1, &name_);
  glBindTexture(GL_TEXTURE_2D, name_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, kWrapS, kClampToEdge);
  glTexParameteri(GL_TEXTURE_2D, kWrapT, kClampToEdge);
  glPixelStorei(kUnpackAlignment, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, kRgba8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               pixels.data());
}

GuiPainter::GuiPainter() : program_(linked()) {
  projection_ = glGetUniformLocation(program_, "projection");
  glUseProgram(program_);
  glUniform1i(glGetUniformLocation(program_, "picture"), 0);

  glGenVertexArrays(1, &vertexArray_);
  glGenBuffers(1, &vertices_);
  glGenBuffers(1, &indices_);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  for (GLuint attribute = 0; attribute < 3; ++attribute) glEnableVertexAttribArray(attribute);
  constexpr GLsizei kStride = sizeof(ImDrawVert);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, offset(offsetof(ImDrawVert, pos)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, offset(offsetof(ImDrawVert, uv)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, offset(offsetof(ImDrawVert, col)));

  ImGuiIO& io = ImGui::GetIO();
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // lists of more than 65,536 vertices
  unsigned char* pixels = nullptr;
  ImageSize size;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &size.width, &size.height);
  letters_.set(size, std::as_bytes(std::span(pixels, std::size_t{4} * static_cast<std::size_t>(size.width) *
                                                         static_cast<std::size_t>(size.height))));
  io.Fonts->SetTexID(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(letters_.name())));
}

GuiPainter::~GuiPainter() {
  glDeleteProgram(program_);
  glDeleteVertexArrays(1, &vertexArray_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &indices_);
}

void GuiPainter::paint(ImageSize frame, const ImDrawData& data) {
  if (data.DisplaySize.x <= 0 || data.DisplaySize.y <= 0) return;
  glViewport(0, 0, frame.width, frame.height);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.16f, 0.17f, 0.19f, 1);
  glClear(GL_COLOR_BUFFER_BIT);

  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  // From Dear ImGui's units, y downwards, to the window.
  const float x = 2 / data.DisplaySize.x, y = -2 / data.DisplaySize.y;
  const float columns[4][4] = {{x, 0, 0, 0},
                               {0, y, 0, 0},
                               {0, 0, 1, 0},
                               {-1 - x * data.DisplayPos.x, 1 - y * data.DisplayPos.y, 0, 1}};
  glUniformMatrix4fv(projection_, 1, GL_FALSE, columns[0]);
  for (int i = 0; i < data.CmdListsCount; ++i) paintList(frame, data, *data.CmdLists[i]);
}

void GuiPainter::paintList(ImageSize frame, const ImDrawData& data, const ImDrawList& list) const {
  glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
  const ImVec2 scale = data.FramebufferScale, origin = data.DisplayPos;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    MENISCUS_CHECK(!command.UserCallback);  // nobody here asks for one
    const auto clipped = [](float value, int most) {
      return static_cast<int>(std::clamp(value, 0.0f, static_cast<float>(most)));
    };
    const int left = clipped((command.ClipRect.x - origin.x) * scale.x, frame.width);
    const int top = clipped((command.ClipRect.y - origin.y) * scale.y, frame.height);
    const int right = clipped((command.ClipRect.z - origin.x) * scale.x, frame.width);
    const int bottom = clipped((command.ClipRect.w - origin.y) * scale.y, frame.height);
    if (right <= left || bottom <= top) continue;
    glScissor(left, frame.height - bottom, right - left, bottom - top);
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(reinterpret_cast<std::intptr_t>(command.GetTexID())));
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                             sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                             offset(command.IdxOffset * sizeof(ImDrawIdx)),
                             static_cast<GLint>(command.VtxOffset));
  }
}

void GuiPainter::read(ImageSize frame, std::vector<std::byte>& pixels) const {
  pixels.resize(std::size_t{4} * static_cast<std::size_t>(frame.width) *
                static_cast<std::size_t>(frame.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, frame.width, frame.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

}  // namespace meniscus
