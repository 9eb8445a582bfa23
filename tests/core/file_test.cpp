#include "trackbed/core/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <typename Function>
std::string RunErrorMessage(const Function& function) {
  try {
    function();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no RunError";
}

TEST(WriteFileAtomically, WritesWhatReadFileReads) {
  const TempFolder folder;
  const fs::path file = folder.path() / "a.bin";
  std::string content(300000, 'x');  // more than one block
  content[0] = '\0';
  content[1] = '\r';
  content[2] = '\n';
  WriteFileAtomically(file, content);
  EXPECT_EQ(ReadFile(file), content);
  WriteFileAtomically(file, "");
  EXPECT_EQ(ReadFile(file), "");
  EXPECT_THAT(folder.Names(), ElementsAre("a.bin"));
}

TEST(WriteFileAtomically, ReplacesTheWholeFile) {
  const TempFolder folder;
  const fs::path file = folder.path() / "a.txt";
  WriteFileAtomically(file, "long content");
  WriteFileAtomically(file, "short");
  EXPECT_EQ(ReadFile(file), "short");
}

TEST(CheckCanWrite, TellsWhatWritingWouldAndLeavesNothing) {
  const TempFolder folder;
  CheckCanWrite(folder.path() / "a.txt");
  CheckCanWrite("/dev/full");  // what a device takes, only writing shows
  EXPECT_THAT(folder.Names(), IsEmpty());
  const fs::path file = folder.Write("there.txt", "as it was");
  CheckCanWrite(file);
  EXPECT_EQ(ReadFile(file), "as it was");
  EXPECT_EQ(RunErrorMessage([&] { CheckCanWrite(folder.path()); }),
            "cannot write " + folder.path().string() + ": Is a directory");
  EXPECT_EQ(
      RunErrorMessage([&] { CheckCanWrite(folder.path() / "missing/a.txt"); }),
      "cannot write " + (folder.path() / "missing/a.txt").string() + ": No such file or directory");
  EXPECT_THAT(folder.Names(), ElementsAre("there.txt"));
}

TEST(WriteFileAtomically, NamesAMissingFolder) {
  const TempFolder folder;
  const fs::path file = folder.path() / "missing" / "a.txt";
  EXPECT_THAT(RunErrorMessage([&] { WriteFileAtomically(file, "x"); }),
              AllOf(HasSubstr("cannot write " + file.string()), HasSubstr("No such file")));
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(WriteFileAtomically, LeavesNothingWhenTheTargetIsAFolder) {
  const TempFolder folder;
  const fs::path file = folder.path() / "target";
  fs::create_directory(file);
  EXPECT_THAT(RunErrorMessage([&] { WriteFileAtomically(file, "x"); }),
              AllOf(HasSubstr("cannot write " + file.string()), HasSubstr("directory")));
  EXPECT_THAT(folder.Names(), ElementsAre("target"));
  EXPECT_TRUE(fs::is_empty(file));
}

TEST(WriteFileAtomically, SaysThatTheDiskIsFull) {
  // /dev/full answers every write with ENOSPC; a link gives it a name of ours.
  const TempFolder folder;
  const fs::path file = folder.path() / "full.csv";
  fs::create_symlink("/dev/full", file);
  EXPECT_THAT(RunErrorMessage([&] { WriteFileAtomically(file, "x"); }),
              AllOf(HasSubstr("cannot write " + file.string()), HasSubstr("No space left")));
  EXPECT_THAT(folder.Names(), ElementsAre("full.csv"));
  EXPECT_TRUE(fs::is_symlink(file));
}

TEST(WriteFileAtomically, KeepsTheOldFileWhenTheTemporaryCannotBeWritten) {
  // The temporary's name is taken by a folder, so opening it fails.
  const TempFolder folder;
  const fs::path file = folder.path() / "a.txt";
  WriteFileAtomically(file, "old");
  fs::create_directory(TemporaryNameFor(file));
  EXPECT_NE(RunErrorMessage([&] { WriteFileAtomically(file, "new"); }), "no RunError");
  EXPECT_EQ(ReadFile(file), "old");
}

TEST(WriteFileAtomically, WritesToADevice) {
  // Through a link of ours: an implementation that replaced the file would lose the link only, and
  // not, run by root, the machine's /dev/null.
  const TempFolder folder;
  const fs::path file = folder.path() / "device";
  fs::create_symlink("/dev/null", file);
  EXPECT_NO_THROW(WriteFileAtomically(file, "x"));
  EXPECT_TRUE(fs::is_symlink(file));
  EXPECT_TRUE(fs::is_character_file(file));
  EXPECT_THAT(folder.Names(), ElementsAre("device"));
}

TEST(ReadFile, NamesWhatItCannotRead) {
  const TempFolder folder;
  EXPECT_THAT(RunErrorMessage([&] { ReadFile(folder.path() / "no.txt"); }),
              AllOf(HasSubstr("cannot read"), HasSubstr("no.txt"), HasSubstr("No such file")));
  EXPECT_THAT(RunErrorMessage([&] { ReadFile(folder.path()); }), HasSubstr("Is a directory"));
}

TEST(TemporaryNameFor, IsBesideTheFileWithItsExtension) {
  const fs::path name = TemporaryNameFor("some/where/film.mp4");
  EXPECT_EQ(name.parent_path(), "some/where");
  EXPECT_EQ(name.extension(), ".mp4");
  EXPECT_NE(name.filename(), "film.mp4");
  EXPECT_EQ(TemporaryNameFor("plain").parent_path(), "");
}

TEST(PublishFile, RemovesTheTemporaryOnFailure) {
  const TempFolder folder;
  const fs::path temporary = folder.path() / "t";
  WriteFileAtomically(temporary, "x");
  EXPECT_THAT(RunErrorMessage([&] { PublishFile(temporary, folder.path() / "missing" / "f"); }),
              HasSubstr("missing"));
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(MakeFolder, MakesItsParentsToo) {
  const TempFolder folder;
  MakeFolder(folder.path() / "a" / "b");
  EXPECT_TRUE(fs::is_directory(folder.path() / "a" / "b"));
  EXPECT_NO_THROW(MakeFolder(folder.path() / "a" / "b"));
  WriteFileAtomically(folder.path() / "file", "x");
  EXPECT_THAT(RunErrorMessage([&] { MakeFolder(folder.path() / "file" / "c"); }),
              HasSubstr("file"));
}

}  // namespace
}  // namespace trackbed
