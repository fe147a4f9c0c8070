#include "render/post/fullscreen.h"

#include <glad/gl.h>

namespace meniscus {

void drawFullscreen(unsigned program, bool add) {
  // A core context draws nothing without a vertex array, even one without attributes.
  GLuint vertexArray = 0;
  glCreateVertexArrays(1, &vertexArray);
  glBindVertexArray(vertexArray);
  glUseProgram(program);
  if (add) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
  }
  glDrawArrays(GL_TRIANGLES, 0, 3);
  if (add) glDisable(GL_BLEND);
  glDeleteVertexArrays(1, &vertexArray);
}

void drawOverSurface(unsigned program, bool add) {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_LESS);  // the triangle's depth is 0, as the background's
  drawFullscreen(program, add);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace meniscus
