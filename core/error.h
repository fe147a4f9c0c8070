#pragma once
// The errors that reach the user, one class per exit code (docs/errors.md). Thrown where the cause
// is known; caught in app/main.cpp and by the viewer's frame loop.

#include <stdexcept>
#include <string>

namespace meniscus {

/// Process exit codes.
enum class ExitCode : int { ok = 0, badInput = 1, badUsage = 2, noGraphics = 3 };

/// Base of every error meant for the user. what() is one line without a trailing newline: it names
/// the file or option, the place in it if there is one, and what to do about it.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// A file that cannot be read, understood or written (exit code 1).
class InputError : public Error {
 public:
  explicit InputError(const std::string& line) : Error(ExitCode::badInput, line) {}
};

/// A command line that asks for something that does not exist (exit code 2).
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& line) : Error(ExitCode::badUsage, line) {}
};

/// No OpenGL 4.5 core context could be made, or the one there is failed (exit code 3).
class GraphicsError : public Error {
 public:
  explicit GraphicsError(const std::string& line) : Error(ExitCode::noGraphics, line) {}
};

/// Ends the program: a broken invariant is the programmer's error, not the user's.
[[noreturn]] void failCheck(const char* condition, const char* file, int line);

}  // namespace meniscus

#define MENISCUS_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::meniscus::failCheck(#condition, __FILE__, __LINE__))
