#include "io/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"
#include "tests/support/process.h"

namespace meniscus {
namespace {

using test::readFile;
using test::TemporaryFolder;
using test::writeFile;
using Names = std::vector<std::string>;

/// The line that writing to `path` fails with; empty if it works.
std::string errorOf(const std::filesystem::path& path) {
  try {
    writeTextFile(path, "text");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void expectError(const std::filesystem::path& path, const std::string& reason, const std::string& remedy) {
  const std::string line = errorOf(path);
  for (const std::string& part : {path.string(), reason, remedy})
    EXPECT_NE(line.find(part), std::string::npos) << "'" << part << "' is not in: " << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(OutputFile, appearsOnCommitOnly) {
  const TemporaryFolder folder;
  {
    OutputFile file(folder / "a.txt");
    file.write("new");
    EXPECT_EQ(folder.names().size(), 1u);
    EXPECT_TRUE(folder.names().front().starts_with(".meniscus-"));
    file.commit();
  }
  EXPECT_EQ(folder.names(), Names{"a.txt"});
  EXPECT_EQ(readFile(folder / "a.txt"), "new");
}

TEST(OutputFile, leavesTheOldFileWholeWithoutCommit) {
  const TemporaryFolder folder;
  writeFile(folder / "a.txt", "old");
  {
    OutputFile file(folder / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(folder.names(), Names{"a.txt"});
  EXPECT_EQ(readFile(folder / "a.txt"), "old");
}

TEST(OutputFile, keepsThePermissionsOfWhatItReplaces) {
  const TemporaryFolder folder;
  writeFile(folder / "a.txt", "old");
  chmod((folder / "a.txt").c_str(), 0640);
  writeTextFile(folder / "a.txt", "new");
  struct stat status {};
  ASSERT_EQ(stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST(OutputFile, writesThroughALink) {
  const TemporaryFolder folder;
  writeFile(folder / "real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  writeTextFile(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(readFile(folder / "real.txt"), "new");
}

TEST(OutputFile, twoAtOnceDoNotMeet) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.txt"), second(folder / "a.txt");
  first.write("first");
  second.write("second");
  first.commit();
  second.commit();
  EXPECT_EQ(readFile(folder / "a.txt"), "second");
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(OutputFile, isRemovedByTheSignalHandlersFunction) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt");
  removeTemporaryFiles();
  EXPECT_EQ(folder.names(), Names{});
}

TEST(OutputFile, goesStraightIntoADevice) {
  EXPECT_EQ(errorOf("/dev/null"), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(OutputFileError, namesThePathTheReasonAndTheRemedy) {
  const TemporaryFolder folder;
  writeFile(folder / "file", "old");
  expectError(folder / "missing" / "a.txt", "no folder", "mkdir -p");
  expectError(folder.path(), "is a folder", "name of a file");
  expectError(folder / "file" / "a.txt", "not a folder", "write elsewhere");
  expectError(folder / std::string(300, 'a'), "too long", "shorter name");
  expectError("/dev/full", "space", "free some space");
  EXPECT_EQ(folder.names(), Names{"file"});
  EXPECT_EQ(readFile(folder / "file"), "old");
}

/// Root may write everywhere; while this exists it is somebody who may not.
class OrdinaryUser {
 public:
  OrdinaryUser() {
    if (geteuid() == 0) {
      EXPECT_EQ(seteuid(kNobody), 0);
    }
  }
  ~OrdinaryUser() { EXPECT_EQ(seteuid(before_), 0); }
  static constexpr uid_t kNobody = 65534;

 private:
  uid_t before_ = geteuid();
};

TEST(OutputFileError, saysThatAFolderOrFileIsProtected) {
  const TemporaryFolder folder;
  writeFile(folder / "file", "old");
  chmod((folder / "file").c_str(), 0400);
  chmod(folder.path().c_str(), 0555);
  const OrdinaryUser user;
  expectError(folder / "file", "write-protected", "chmod u+w");
  expectError(folder / "new", "no permission", "folder of your own");
}

}  // namespace
}  // namespace meniscus
