// The executable `meniscus`: picks the sub-command, and is the one place where errors end: one line on stderr
// and the exit code of core/error.h.

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.h"
#include "core/error.h"
#include "io/output_file.h"

namespace meniscus {
namespace {

constexpr const char* kHelp =
    "Meniscus draws molecules: exact pictures of structure files, with or without a GPU or a display.\n"
    "\n"
    "Usage: meniscus COMMAND ...\n"
    "\n"
    "Commands:\n"
    "  render FILE... -o OUT.png   Draw structure files as pictures\n"
    "  view [FILE...]              Show structure files in a window\n"
    "  info FILE                   Say what a structure file holds\n"
    "  measure SWEEP -o DIR        Measure error against run time, and write a report\n"
    "  doctor                      Say which ways to OpenGL work here, and what to do about the others\n"
    "  help [COMMAND]              Show this, or the options of a command (also COMMAND --help)\n"
    "\n"
    "Options:\n"
    "  -h, --help                  Show this help\n"
    "  -V, --version               Print the version\n"
    "\n"
    "Examples:\n"
    "  meniscus render 1crn.pdb -o crambin.png\n"
    "  meniscus render 4hhb.cif.gz -o blood.png --color chain --size 1920x1080\n"
    "  meniscus info 4hhb.cif.gz\n"
    "\n"
    "Exit codes: 0 done, 1 a file could not be read, drawn or written, 2 wrong usage, 3 no OpenGL 4.5.\n";

constexpr const char* kCommands = "there are render, view, info, measure and doctor, see meniscus --help";

int runViewIfBuilt(const std::vector<std::string>& arguments) {
#ifdef MENISCUS_VIEWER
  return runView(arguments);
#else
  static_cast<void>(arguments);
  throw UsageError(
      "this meniscus was built without its window (MENISCUS_VIEWER=OFF); 'meniscus render FILE -o "
      "OUT.png' draws pictures");
#endif
}

int runCommand(std::vector<std::string> arguments) {
  if (arguments.empty()) throw UsageError(std::string("no command; ") + kCommands);
  std::string command = arguments.front();
  arguments.erase(arguments.begin());
  if (command == "help" && !arguments.empty()) {
    command = arguments.front();
    arguments = {"--help"};
  }
  if (command == "render") return runRender(arguments);
  if (command == "view") return runViewIfBuilt(arguments);
  if (command == "info") return runInfo(arguments);
  if (command == "measure") return runMeasure(arguments);
  if (command == "doctor") return runDoctor(arguments);
  if (command == "help" || command == "--help" || command == "-h") {
    std::fputs(kHelp, stdout);
    return 0;
  }
  if (command == "--version" || command == "-V") {
    std::printf("meniscus %s\n", version());
    return 0;
  }
  throw UsageError("there is no command '" + command + "'; " + kCommands);
}

extern "C" void endBySignal(int signal) {
  removeTemporaryFiles();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void installSignalHandlers() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // What the parent chose to ignore (nohup) stays ignored.
    if (std::signal(signal, endBySignal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  // A file that grows too large is then reported by write(), as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
}

int fail(ExitCode code, std::string_view line) {
  std::string text(line);
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  std::fprintf(stderr, "meniscus: %s\n", text.c_str());
  return static_cast<int>(code);
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  using namespace meniscus;
  installSignalHandlers();
  try {
    const int code = runCommand({argv + (argc > 0 ? 1 : 0), argv + argc});
    if (std::fflush(stdout) != 0) throw InputError("cannot write to standard output; the disk may be full");
    return code;
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::badInput, "not enough memory; draw fewer atoms or a smaller picture");
  } catch (const std::exception& error) {
    return fail(ExitCode::badInput, std::string("unexpected error, please report it: ") + error.what());
  }
}
