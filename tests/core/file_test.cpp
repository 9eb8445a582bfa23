#include "trackbed/core/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

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
  CheckCanWrite("/dev/full");  // a device rejects data only on writing
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
  // /dev/full answers every write with ENOSPC; a link gives it a name in the test's folder.
  const TempFolder folder;
  const fs::path file = folder.path() / "full.csv";
  fs::create_symlink("/dev/full", file);
  EXPECT_THAT(RunErrorMessage([&] { WriteFileAtomically(file, "x"); }),
              AllOf(HasSubstr("cannot write " + file.string()), HasSubstr("No space left")));
  EXPECT_THAT(folder.Names(), ElementsAre("full.csv"));
  EXPECT_TRUE(fs::is_symlink(file));
}

TEST(WriteFileAtomically, KeepsTheOldFileWhenTheTemporaryCannotBeWritten) {
  // A name has at most 255 bytes. The file's name has 250 bytes. The name of the temporary file
  // also contains the process id, so it is too long.
  const TempFolder folder;
  const fs::path file = folder.Write(std::string(250, 'a'), "old");
  EXPECT_THAT(RunErrorMessage([&] { WriteFileAtomically(file, "new"); }), HasSubstr("too long"));
  EXPECT_EQ(ReadFile(file), "old");
}

TEST(WriteFileAtomically, WritesToADevice) {
  // Writes through a link in the test's folder. An implementation that replaced the file would
  // replace the link in the test's folder, and never the machine's /dev/null, even when root runs
  // the test.
  const TempFolder folder;
  const fs::path file = folder.path() / "device";
  fs::create_symlink("/dev/null", file);
  EXPECT_NO_THROW(WriteFileAtomically(file, "x"));
  EXPECT_TRUE(fs::is_symlink(file));
  EXPECT_TRUE(fs::is_character_file(file));
  EXPECT_THAT(folder.Names(), ElementsAre("device"));
}

TEST(WriteFileAtomically, WritesToAPipeThatIsRead) {
  const TempFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] {
    std::ifstream in(pipe);  // waits for the writer
    read.assign(std::istreambuf_iterator<char>(in), {});
  });
  const std::string content(300'000, 'x');  // more than the pipe holds
  EXPECT_NO_THROW(WriteFileAtomically(pipe, content));
  reader.join();
  EXPECT_EQ(read, content);
  EXPECT_THAT(folder.Names(), ElementsAre("pipe"));
}

TEST(WriteFileAtomically, DoesNotWaitLongForAReader) {
  const TempFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(RunErrorMessage([&] { WriteFileAtomically(pipe, "x"); }),
            "cannot write " + pipe.string() +
                ": it is a pipe, and no process reads it; start the reader first");
}

TEST(TemporaryFile, IsRefusedForAFileThatItCannotReplace) {
  const TempFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const fs::path device = folder.path() / "device";
  fs::create_symlink("/dev/null", device);
  const fs::path below = folder.path() / "folder";
  fs::create_directory(below);
  const auto message = [](const fs::path& file) {
    return RunErrorMessage([&] { const TemporaryFile temporary(file); });
  };
  EXPECT_THAT(message(pipe), HasSubstr("pipe: it is a pipe; must be a regular file, or a new one"));
  EXPECT_THAT(message(device), HasSubstr("device: it is a device; must be a regular file"));
  EXPECT_THAT(message(below), HasSubstr("folder: Is a directory"));
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("device", "folder", "pipe"));
}

TEST(WriteFileAtomically, KeepsALinkWhoseTargetIsAbsent) {
  const TempFolder folder;
  const fs::path file = folder.path() / "link";
  fs::create_symlink(folder.path() / "absent", file);
  const std::string message = "cannot write " + file.string() +
                              ": it is a link to a file that does not exist; remove it, or name "
                              "another file";
  EXPECT_EQ(RunErrorMessage([&] { WriteFileAtomically(file, "x"); }), message);
  EXPECT_EQ(RunErrorMessage([&] { PrepareToWrite(file); }), message);
  EXPECT_THAT(folder.Names(), ElementsAre("link"));
  EXPECT_TRUE(fs::is_symlink(file));
}

TEST(ReadFile, ReadsNothingOfWhatIsTooLarge) {
  const TempFolder folder;
  const std::filesystem::path file = folder.Write("sparse.csv", "t_s");
  std::filesystem::resize_file(file, 100'000'000'000);
  EXPECT_EQ(RunErrorMessage([&] { ReadFile(file); }),
            "cannot read " + file.string() + ": it has more than 512 MiB");
  // A file without a known size is read up to the limit.
  EXPECT_EQ(RunErrorMessage([&] { ReadFile("/proc/self/status", 16); }),
            "cannot read /proc/self/status: it has more than 0 MiB");
  const std::filesystem::path just = folder.Write("just.csv", std::string(1000, 'x'));
  EXPECT_EQ(ReadFile(just, 1000).size(), 1000U);
  EXPECT_THAT(RunErrorMessage([&] { ReadFile(just, 999); }), HasSubstr("more than"));
}

TEST(ReadFile, NamesWhatItCannotRead) {
  const TempFolder folder;
  EXPECT_THAT(RunErrorMessage([&] { ReadFile(folder.path() / "no.txt"); }),
              AllOf(HasSubstr("cannot read"), HasSubstr("no.txt"), HasSubstr("No such file")));
  EXPECT_THAT(RunErrorMessage([&] { ReadFile(folder.path()); }), HasSubstr("Is a directory"));
}

TEST(TemporaryFile, IsBesideItsFileWithItsExtension) {
  const TempFolder folder;
  {
    TemporaryFile film(folder.path() / "film.mp4");
    const TemporaryFile other(folder.path() / "film.mp4");  // belongs to another thread
    EXPECT_NE(film.path(), other.path());
    EXPECT_EQ(film.path().parent_path(), folder.path());
    EXPECT_EQ(film.path().extension(), ".mp4");
    film.Write("a ");
    film.Write("film");
    EXPECT_FALSE(fs::exists(folder.path() / "film.mp4"));
    film.Publish();
  }
  EXPECT_EQ(ReadFile(folder.path() / "film.mp4"), "a film");
  EXPECT_THAT(folder.Names(), ElementsAre("film.mp4"));
}

TEST(TemporaryFile, IsGoneAfterAFailure) {
  const TempFolder folder;
  fs::create_directory(folder.path() / "target");
  EXPECT_THAT(RunErrorMessage([&] { TemporaryFile(folder.path() / "target").Publish(); }),
              HasSubstr("Is a directory"));
  EXPECT_THAT(folder.Names(), ElementsAre("target"));
}

// Files left by killed processes have temporary names, but no process holds their lock.
TEST(RemoveAbandonedTemporaries, TakesThoseOfKilledProcessesAlone) {
  const TempFolder folder;
  for (const char* name :
       {".film.123-0.trackbed.mp4", ".plain.1-12.trackbed", ".my.plan.4-0.trackbed.csv"}) {
    folder.Write(name, "half");
  }
  folder.Write(".f.12-0.trackbed.png/f_00000.png", "a frame");
  const std::vector<std::string> others{"film.mp4",
                                        ".film.mp4",
                                        ".film.123.mp4",
                                        ".trackbed.mp4",
                                        ".film.123.partial",
                                        ".film.x-0.trackbed.mp4",
                                        "film.1-0.trackbed.a",
                                        ".film.1-0.trackbed.tar.gz"};
  for (const std::string& name : others) {
    folder.Write(name, "not ours");
  }
  const TemporaryFile alive(folder.path() / "alive.csv");
  const TemporaryFolder frames(folder.path() / "frames.png");
  RemoveAbandonedTemporaries(folder.path());
  std::vector<std::string> left = others;
  left.push_back(alive.path().filename());
  left.push_back(frames.path().filename());
  EXPECT_THAT(folder.Names(), ::testing::UnorderedElementsAreArray(left));
  RemoveAbandonedTemporaries(folder.path() / "missing");  // no error
}

TEST(PrepareToWrite, MakesTheFolderAndClearsIt) {
  const TempFolder folder;
  folder.Write("a/.b.1-0.trackbed.xml", "half");
  PrepareToWrite(folder.path() / "a/b.xml");
  EXPECT_TRUE(fs::is_empty(folder.path() / "a"));
  PrepareToWrite(folder.path() / "c/d/e.xml");
  EXPECT_TRUE(fs::is_empty(folder.path() / "c/d"));
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

TEST(OpenInput, RefusesWhatIsNoRegularFileWithoutWaiting) {
  const TempFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string rest = "; must be a regular file: save the content to one first";
  EXPECT_EQ(RunErrorMessage([&] { static_cast<void>(ReadFile(pipe)); }),
            "cannot read " + pipe.string() + ": it is a pipe" + rest);
  // A link to a pipe, as in a shell's process substitution.
  const fs::path link = folder.path() / "link";
  fs::create_symlink(pipe, link);
  EXPECT_EQ(RunErrorMessage([&] { static_cast<void>(OpenInput(link)); }),
            "cannot read " + link.string() + ": it is a pipe" + rest);
  for (const char* device : {"/dev/null", "/dev/zero"}) {
    EXPECT_EQ(RunErrorMessage([&] { static_cast<void>(ReadFile(device)); }),
              std::string("cannot read ") + device + ": it is a device" + rest);
  }
  EXPECT_EQ(RunErrorMessage([&] { static_cast<void>(ReadFile(folder.path())); }),
            "cannot read " + folder.path().string() + ": Is a directory");
}

// A checkout without Git LFS has such a file in place of each large file.
TEST(ReadFile, RefusesPointersOfGitLfs) {
  const TempFolder folder;
  const fs::path file = folder.Write(
      "mesh.obj", "version https://git-lfs.github.com/spec/v1\noid sha256:0123\nsize 141935\n");
  EXPECT_THAT(RunErrorMessage([&] { ReadFile(file); }),
              AllOf(HasSubstr("mesh.obj: it is a pointer of Git LFS"), HasSubstr("git lfs pull")));
  const fs::path other = folder.Write("a.txt", "# version https://git-lfs.github.com/spec/v1\n");
  EXPECT_EQ(ReadFile(other).size(), 45U);
}

}  // namespace
}  // namespace trackbed
