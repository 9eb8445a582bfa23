#include "trackbed/core/file_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/folder_lock.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(FileSet, ReplacesAnEarlierResultWithAllOfANewOne) {
  const TempFolder folder;
  folder.Write("a.csv", "old a");
  folder.Write("b.csv", "old b");
  folder.Write("done.json", "old");
  folder.Write("notes.txt", "mine");
  FileSet files(folder.path());
  files.Add("done.json", "new");
  files.Add("a.csv", "new a");
  EXPECT_EQ(ReadFile(folder.path() / "a.csv"), "old a");
  files.Commit({"a.csv", "b.csv", "c.csv"}, "done.json");
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("a.csv", "done.json", "notes.txt"));
  EXPECT_EQ(ReadFile(folder.path() / "a.csv"), "new a");
  EXPECT_EQ(ReadFile(folder.path() / "done.json"), "new");
}

TEST(FileSet, LeavesTheEarlierResultUnlessItIsCommitted) {
  const TempFolder folder;
  folder.Write("a.csv", "old");
  {
    FileSet files(folder.path());
    files.Add("a.csv", "new");
    EXPECT_EQ(folder.Names().size(), 2U);
  }
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("a.csv"));
  EXPECT_EQ(ReadFile(folder.path() / "a.csv"), "old");
}

TEST(FileSet, RefusesNamesOfFoldersBeforeAnythingIsReplaced) {
  const TempFolder folder;
  folder.Write("a.csv/in", "");
  FileSet files(folder.path());
  try {
    files.Add("a.csv", "new");
    FAIL();
  } catch (const RunError& error) {
    EXPECT_EQ(error.what(),
              "cannot write " + (folder.path() / "a.csv").string() + ": it is a folder");
  }
}

/// The number of a process that has ended.
pid_t EndedProcess() {
  const pid_t child = ::fork();
  if (child == 0) {
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(RemoveAbandonedTemporaries, RemovesThoseOfEndedProcessesAlone) {
  const TempFolder folder;
  const std::string ended = std::to_string(EndedProcess());
  folder.Write(".plan." + ended + ".partial.csv", "");
  folder.Write(".mujoco.state." + ended + ".partial.csv", "");
  folder.Write(".noextension." + ended + ".partial", "");
  const std::string own = TemporaryNameFor(folder.path() / "plan.csv").filename().string();
  folder.Write(own, "");
  folder.Write("plan." + ended + ".partial.csv", "");  // not hidden
  folder.Write(".notes.partial.csv", "");
  RemoveAbandonedTemporaries(folder.path());
  EXPECT_THAT(folder.Names(),
              UnorderedElementsAre(own, "plan." + ended + ".partial.csv", ".notes.partial.csv"));
  RemoveAbandonedTemporaries(folder.path() / "none");
}

TEST(FolderLock, KeepsWritersOutAndLetsReadersShare) {
  using Access = FolderLock::Access;
  const TempFolder folder;
  const auto refused = [&](Access access) -> std::string {
    try {
      const FolderLock lock(folder.path(), access);
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  };
  {
    const FolderLock writer(folder.path(), Access::kWrite);
    EXPECT_EQ(refused(Access::kWrite),
              folder.path().string() + " is in use: another process reads or writes it");
    EXPECT_EQ(refused(Access::kRead),
              folder.path().string() + " is in use: another process writes it");
  }
  {
    const FolderLock reader(folder.path(), Access::kRead);
    EXPECT_EQ(refused(Access::kRead), "");
    EXPECT_NE(refused(Access::kWrite), "");
  }
  EXPECT_EQ(refused(Access::kWrite), "");
  EXPECT_THAT(folder.Names(), IsEmpty());
  const FolderLock absent(folder.path() / "none", Access::kWrite);
}

TEST(FolderLock, RemovesWhatAKilledProcessLeft) {
  const TempFolder folder;
  folder.Write(".plan." + std::to_string(EndedProcess()) + ".partial.csv", "");
  { const FolderLock reader(folder.path(), FolderLock::Access::kRead); }
  EXPECT_EQ(folder.Names().size(), 1U);
  const FolderLock writer(folder.path(), FolderLock::Access::kWrite);
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(FolderLock, EndsWithTheProcessThatHoldsIt) {
  const TempFolder folder;
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder.path(), FolderLock::Access::kWrite);
    static_cast<void>(!::write(pipe[1], "x", 1));
    ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(pipe[0], &byte, 1), 1);
  EXPECT_THROW(FolderLock(folder.path(), FolderLock::Access::kWrite), RunError);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_NO_THROW(FolderLock(folder.path(), FolderLock::Access::kWrite));
}

}  // namespace
}  // namespace trackbed
