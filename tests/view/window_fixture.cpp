#include "tests/view/window_fixture.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/support/paths.h"

namespace meniscus::test {
namespace {

using namespace std::chrono_literals;

// Far beyond what anything takes, also under sanitizers on a busy machine.
constexpr auto kPatience = 60s;
constexpr auto kLook = 20ms;  // between two looks

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

}  // namespace

BackgroundProcess::BackgroundProcess(const std::vector<std::string>& argv, const Environment& environment,
                                     const std::filesystem::path& folder, const std::filesystem::path& log,
                                     int keepOpen)
    : id_(fork()) {
  if (id_ != 0) return;
  std::vector<char*> pointers;
  for (const std::string& argument : argv) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  const int out = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int in = ::open("/dev/null", O_RDONLY);
  dup2(in, 0);
  dup2(out, 1);
  dup2(out, 2);
  if (keepOpen >= 0) fcntl(keepOpen, F_SETFD, 0);
  if (chdir(folder.c_str()) == 0) execvp(pointers[0], pointers.data());
  _exit(127);
}

BackgroundProcess::~BackgroundProcess() {
  if (!running()) return;
  kill(id_, SIGKILL);
  wait();
}

bool BackgroundProcess::running() {
  int status = 0;
  if (!ended_ && waitpid(id_, &status, WNOHANG) == id_) {
    ended_ = true;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  return !ended_;
}

int BackgroundProcess::wait() {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (running() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kLook);
  if (running()) kill(id_, SIGKILL);
  while (running()) std::this_thread::sleep_for(kLook);
  return code_;
}

void WindowTest::SetUp() {
  startServer({});
}

void WindowTest::startServer(const std::vector<std::string>& arguments) {
  // The server chooses a display that is free and says which.
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  std::vector<std::string> argv{"Xvfb",      "-displayfd", std::to_string(ends[1]),
                                "-screen",   "0",          "1280x1024x24",
                                "-nolisten", "tcp",        "-noreset"};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  server_ = std::make_unique<BackgroundProcess>(argv, BackgroundProcess::Environment{}, folder_.path(),
                                                folder_ / "xvfb.log", ends[1]);
  close(ends[1]);
  std::string number;
  for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
  close(ends[0]);
  ASSERT_FALSE(number.empty()) << "Xvfb does not start: " << readFile(folder_ / "xvfb.log");
  display_ = ":" + number;
}

void WindowTest::TearDown() {
  viewer_.reset();
  server_.reset();
}

std::string WindowTest::xdotool(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "/usr/bin/xdotool");
  ProcessOptions options;
  options.environment = {{"DISPLAY", display_}};
  return trimmed(runProcess(arguments, options).out);
}

void WindowTest::waitFor(const std::string& what, const std::function<bool()>& happens) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!happens()) {
    if (std::chrono::steady_clock::now() > end) {
      FAIL() << what << " did not happen; the title is '" << title()
             << "', and was said: " << readFile(folder_ / "view.log");
    }
    std::this_thread::sleep_for(kLook);
  }
}

void WindowTest::open(const std::vector<std::string>& arguments) {
  std::vector<std::string> argv{program(), "view", "--stats", "stats.json"};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  BackgroundProcess::Environment environment{{"DISPLAY", display_}, {"WAYLAND_DISPLAY", ""}};
  environment.insert(environment.end(), environment_.begin(), environment_.end());
  viewer_ = std::make_unique<BackgroundProcess>(argv, environment, folder_.path(), folder_ / "view.log");
  ASSERT_NO_FATAL_FAILURE(waitFor("a window", [this] {
    window_ = xdotool({"search", "--name", "Meniscus"});
    window_ = window_.substr(0, window_.find('\n'));
    return !window_.empty() || !viewer_->running();
  }));
  ASSERT_FALSE(window_.empty()) << readFile(folder_ / "view.log");
  // There is no window manager that would do it.
  xdotool({"windowmove", window_, "0", "0"});
  xdotool({"windowfocus", window_});
}

std::string WindowTest::title() {
  return xdotool({"getwindowname", window_});
}

void WindowTest::waitForTitle(const std::string& wanted) {
  waitFor("the title '" + wanted + "'", [&] { return title() == wanted; });
}

void WindowTest::waitForFile(const std::string& name) {
  waitFor(name, [&] { return std::filesystem::exists(folder_ / name); });
}

// The picture that was there is finished, too, until the window has seen what was done to it.
void WindowTest::waitUntilDrawn() {
  std::this_thread::sleep_for(150ms);
  waitFor("a finished picture", [this] { return title().ends_with(" - Meniscus"); });
}

WindowPixels WindowTest::shown() {
  return pixelsOf(display_, std::stoul(window_));
}

int WindowTest::quit() {
  key("ctrl+q");
  return viewer_->wait();
}

void WindowTest::key(const std::string& keys) {
  xdotool({"key", keys});
}

void WindowTest::moveTo(int x, int y) {
  xdotool({"mousemove", std::to_string(x), std::to_string(y)});
}

void WindowTest::click(int x, int y, int button) {
  moveTo(x, y);
  std::this_thread::sleep_for(50ms);
  xdotool({"mousedown", std::to_string(button), "sleep", "0.05", "mouseup", std::to_string(button)});
  std::this_thread::sleep_for(50ms);
}

void WindowTest::drag(int x, int y, int byX, int byY, int button) {
  moveTo(x, y);
  std::this_thread::sleep_for(50ms);
  xdotool({"mousedown", std::to_string(button)});
  constexpr int kSteps = 8;
  for (int i = 1; i <= kSteps; ++i) {
    moveTo(x + byX * i / kSteps, y + byY * i / kSteps);
    std::this_thread::sleep_for(20ms);
  }
  xdotool({"mouseup", std::to_string(button)});
}

void WindowTest::wheel(int x, int y, int steps, const std::vector<std::string>& keys) {
  moveTo(x, y);
  for (const std::string& key : keys) xdotool({"keydown", key});
  std::this_thread::sleep_for(50ms);
  xdotool({"click", "--repeat", std::to_string(steps), "--delay", "20", "4"});
  std::this_thread::sleep_for(200ms);
  for (const std::string& key : keys) xdotool({"keyup", key});
}

void WindowTest::resize(int width, int height) {
  xdotool({"windowsize", window_, std::to_string(width), std::to_string(height)});
}

std::string WindowTest::clipboard() {
  ProcessOptions options;
  options.environment = {{"DISPLAY", display_}};
  std::this_thread::sleep_for(100ms);
  return runProcess({"/usr/bin/xclip", "-selection", "clipboard", "-o"}, options).out;
}

void WindowTest::saveAndCompare(const std::string& name) {
  std::filesystem::remove(folder_ / name);
  key("ctrl+s");
  ASSERT_NO_FATAL_FAILURE(waitForFile(name));
  const std::string saved = readFile(folder_ / name);
  std::filesystem::remove(folder_ / name);
  std::string command;
  waitFor("a command that writes " + name, [&] {
    key("ctrl+c");
    command = clipboard();
    return command.find(" -o " + name + " ") != std::string::npos;
  });
  const ProcessResult again = runCommand(command, folder_.path());
  ASSERT_EQ(again.exitCode, 0) << command << again.err;
  EXPECT_TRUE(readFile(folder_ / name) == saved) << command;
}

ProcessResult WindowTest::runCommand(const std::string& line, const std::filesystem::path& folder) {
  const std::string name = "meniscus ";
  EXPECT_TRUE(line.starts_with(name)) << line;
  ProcessOptions options;
  options.folder = folder;
  return runProcess({"/bin/sh", "-c", "'" + program() + "' " + line.substr(name.size())}, options);
}

}  // namespace meniscus::test
