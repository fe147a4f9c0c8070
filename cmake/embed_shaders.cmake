# Writes OUTPUT, a C++ file that holds the text of FILES (relative to ROOT).
set(entries "")
foreach(file ${FILES})
  file(READ ${ROOT}/${file} text)
  string(APPEND entries "    {\"${file}\", R\"__glsl__(${text})__glsl__\"},\n")
endforeach()
list(LENGTH FILES count)
file(WRITE ${OUTPUT}
"#include \"shaders/embedded_shaders.h\"

#include <array>

namespace meniscus {

namespace {
constexpr std::array<EmbeddedShader, ${count}> kShaders{{
${entries}}};
}  // namespace

std::span<const EmbeddedShader> embeddedShaders() { return kShaders; }

}  // namespace meniscus
")
