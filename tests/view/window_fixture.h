#pragma once
// `meniscus view` in a real window on a display of its own, driven as a user would: by mouse and keys.

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/view/window_pixels.h"

namespace meniscus::test {

/// A program that runs beside the test; ended when this is.
class BackgroundProcess {
 public:
  using Environment = std::vector<std::pair<std::string, std::string>>;
  /// Standard output and error go to `log`. `keepOpen`: a descriptor that it inherits; -1 = none.
  BackgroundProcess(const std::vector<std::string>& argv, const Environment& environment,
                    const std::filesystem::path& folder, const std::filesystem::path& log, int keepOpen = -1);
  ~BackgroundProcess();
  BackgroundProcess(const BackgroundProcess&) = delete;
  BackgroundProcess& operator=(const BackgroundProcess&) = delete;
  bool running();
  /// Waits for its end; its exit code, or minus the signal that ended it.
  int wait();
  pid_t id() const { return id_; }

 private:
  pid_t id_;
  int code_ = -1;
  bool ended_ = false;
};

class WindowTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  /// A display whose server gets these arguments, too.
  void startServer(const std::vector<std::string>& arguments);

  /// Starts `meniscus view` in the test's folder and waits for its window.
  void open(const std::vector<std::string>& arguments);
  /// Until the window's title says that its picture is finished.
  void waitUntilDrawn();
  void waitForTitle(const std::string& title);
  void waitForFile(const std::string& name);
  std::string title();
  WindowPixels shown();  ///< what the window shows
  /// Ctrl Q, and the exit code; statistics of --stats are in stats.json.
  int quit();

  void key(const std::string& keys);
  void moveTo(int x, int y);  ///< in the window
  void click(int x, int y, int button = 1);
  void drag(int x, int y, int byX, int byY, int button = 1);
  /// Turns the wheel away from the user, with these keys held.
  void wheel(int x, int y, int steps, const std::vector<std::string>& keys);
  void resize(int width, int height);
  std::string clipboard();
  std::string xdotool(std::vector<std::string> arguments);
  void waitFor(const std::string& what, const std::function<bool()>& happens);
  /// Saves the picture, which gets this name, copies the command, runs it, and compares the two files; what
  /// is left is the one that was saved.
  void saveAndCompare(const std::string& name);
  /// Runs a command as it was copied in a folder.
  ProcessResult runCommand(const std::string& line, const std::filesystem::path& folder);

  TemporaryFolder folder_;
  std::string display_;
  BackgroundProcess::Environment environment_;  // of the windows to come
  std::unique_ptr<BackgroundProcess> server_, viewer_;
  std::string window_;
};

}  // namespace meniscus::test
