#include "render/shader_library.h"

#include <glad/gl.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/error.h"
#include "shaders/embedded_shaders.h"

namespace meniscus {

namespace {

constexpr std::string_view kFlagsMark = "// flags:";
constexpr std::string_view kIncludeMark = "#include \"";

ShaderFlags parseFlags(std::string_view line) {
  std::istringstream words{std::string(line.substr(kFlagsMark.size()))};
  return {std::istream_iterator<std::string>(words), {}};
}

std::string joined(const ShaderFlags& flags) {
  std::string out;
  for (const std::string& flag : flags) out += ' ' + flag;
  return out;
}

// Replaces the source string number that starts a line of a driver's log ("2:14(5): ...", "2(14) : ...") by
// its path.
std::string nameFiles(const std::string& log, const std::vector<std::string>& files) {
  std::istringstream lines(log);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t start = line.starts_with("ERROR: ") ? 7 : 0;
    std::size_t digits = start;
    while (digits < line.size() && line[digits] >= '0' && line[digits] <= '9') ++digits;
    if (digits > start && digits < start + 4 && digits < line.size() &&
        (line[digits] == ':' || line[digits] == '(')) {
      const auto number = static_cast<std::size_t>(std::stoul(line.substr(start, digits - start)));
      if (number < files.size()) line = "shaders/" + files[number] + line.substr(digits);
    }
    if (!out.empty()) out += "; ";
    out += line;
  }
  return out;
}

template <typename GetLength, typename GetLog>
std::string infoLog(GLuint object, GetLength getLength, GetLog getLog) {
  GLint length = 0;
  getLength(object, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  GLsizei written = 0;
  getLog(object, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

}  // namespace

std::string ShaderLibrary::read(std::string_view path) const {
  if (!directory_.empty()) {
    const std::filesystem::path file = directory_ / path;
    std::ifstream in(file, std::ios::binary);
    if (!in)
      throw InputError(file.string() +
                       ": cannot read this shader; --shader-dir needs a whole copy of shaders/");
    times_[std::string(path)] = std::filesystem::last_write_time(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (shader.path == path) return std::string(shader.text);
  }
  throw InputError("shaders/" + std::string(path) + ": there is no such shader");
}

void ShaderLibrary::append(std::string_view path, std::vector<std::string>& open, ShaderSource& out) const {
  if (std::find(open.begin(), open.end(), path) != open.end()) {
    throw InputError("shaders/" + std::string(path) + ": includes itself");
  }
  if (std::find(out.files.begin(), out.files.end(), path) != out.files.end())
    return;  // once per program stage
  open.emplace_back(path);
  const std::size_t number = out.files.size();
  out.files.emplace_back(path);
  std::istringstream lines(read(path));
  int lineNumber = 0;
  if (number > 0) out.text += "#line 1 " + std::to_string(number) + "\n";
  for (std::string line; std::getline(lines, line);) {
    ++lineNumber;
    if (line.starts_with(kFlagsMark)) out.understood.merge(parseFlags(line));
    if (!line.starts_with(kIncludeMark)) {
      out.text += line + "\n";
      continue;
    }
    const std::size_t end = line.find('"', kIncludeMark.size());
    append(std::string_view(line).substr(kIncludeMark.size(), end - kIncludeMark.size()), open, out);
    out.text += "#line " + std::to_string(lineNumber + 1) + " " + std::to_string(number) + "\n";
  }
  open.pop_back();
}

ShaderSource ShaderLibrary::source(std::string_view path) const {
  ShaderSource out;
  std::vector<std::string> open;
  append(path, open, out);
  return out;
}

void ShaderLibrary::refuse(std::string_view path, const ShaderSource& source, std::string log) const {
  const std::string line = "shader " + std::string(path) + " was refused: " + nameFiles(log, source.files);
  if (!directory_.empty()) throw InputError((directory_ / path).string() + ": " + line);
  throw GraphicsError(line + "; please report it with the output of 'meniscus doctor'");
}

unsigned ShaderLibrary::compileStage(unsigned kind, std::string_view path, const ShaderSource& source,
                                     const ShaderFlags& flags) {
  // Flags go right behind the #version line, which must stay the first.
  const std::size_t versionEnd = source.text.find('\n') + 1;
  std::string text = source.text.substr(0, versionEnd);
  for (const std::string& flag : flags) {
    if (source.understood.contains(flag)) text += "#define " + flag + " 1\n";
  }
  text += "#line 2 0\n" + source.text.substr(versionEnd);
  const GLuint shader = glCreateShader(kind);
  const char* pointer = text.c_str();
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::string log = infoLog(shader, glGetShaderiv, glGetShaderInfoLog);
  glDeleteShader(shader);
  refuse(path, source, std::move(log));
}

unsigned ShaderLibrary::program(std::string_view vertex, std::string_view fragment,
                                const ShaderFlags& flags) {
  for (const std::string_view path : {vertex, fragment}) {
    if (!sources_.contains(std::string(path))) sources_[std::string(path)] = source(path);
  }
  const ShaderSource& vertexSource = sources_[std::string(vertex)];
  const ShaderSource& fragmentSource = sources_[std::string(fragment)];
  ShaderFlags used;
  for (const std::string& flag : flags) {
    if (vertexSource.understood.contains(flag) || fragmentSource.understood.contains(flag)) used.insert(flag);
  }
  const std::string key = std::string(vertex) + ' ' + std::string(fragment) + joined(used);
  if (const auto found = programs_.find(key); found != programs_.end()) return found->second.name();

  const auto start = std::chrono::steady_clock::now();
  const GLuint name = glCreateProgram();
  gl::Object object(gl::ObjectKind::program, name);
  const GLuint vertexShader = compileStage(GL_VERTEX_SHADER, vertex, vertexSource, used);
  glAttachShader(name, vertexShader);
  glDeleteShader(vertexShader);
  const GLuint fragmentShader = compileStage(GL_FRAGMENT_SHADER, fragment, fragmentSource, used);
  glAttachShader(name, fragmentShader);
  glDeleteShader(fragmentShader);
  glLinkProgram(name);
  GLint ok = GL_FALSE;
  glGetProgramiv(name, GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) refuse(fragment, fragmentSource, infoLog(name, glGetProgramiv, glGetProgramInfoLog));
  compileMs_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  compiled_.push_back(std::string(fragment.substr(0, fragment.rfind('.'))) + joined(used));
  return (programs_[key] = std::move(object)).name();
}

void ShaderLibrary::reloadIfChanged() {
  const bool changed = std::any_of(times_.begin(), times_.end(), [&](const auto& entry) {
    std::error_code error;
    const auto now = std::filesystem::last_write_time(directory_ / entry.first, error);
    return !error && now != entry.second;
  });
  if (!changed) return;
  programs_.clear();
  sources_.clear();
  times_.clear();
}

}  // namespace meniscus
