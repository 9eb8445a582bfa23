#include "trackbed/analysis/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::string Refusal(const auto& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// A result of files that hold `content`.
void Write(const fs::path& folder, const std::string& result, const std::vector<std::string>& names,
           const std::string& content, const std::vector<std::string>& obsolete = {}) {
  ResultWriter writer(folder);
  for (const std::string& name : names) {
    writer.Add(name, content);
  }
  writer.Commit(result, obsolete);
}

TEST(ResultWriter, ReplacesAResultAsAWhole) {
  const TempFolder folder;
  folder.Write("notes.txt", "mine");
  Write(folder.path(), "run", {"metrics.json", "model.xml", "tree.csv"}, "old");
  folder.Write("report.html", "of the old one");
  Write(folder.path(), "run", {"metrics.json", "model.xml"}, "new", {"report.html"});
  EXPECT_THAT(folder.Names(),
              UnorderedElementsAre("metrics.json", "model.xml", "manifest.json", "notes.txt"));
  EXPECT_EQ(ReadFile(folder.path() / "model.xml"), "new");
  const auto manifest = nlohmann::json::parse(ReadFile(folder.path() / "manifest.json"));
  // printf new | sha256sum
  EXPECT_EQ(manifest["results"]["run"]["model.xml"]["sha256"],
            "11507a0e2f5e69d5dfa40a62a1bd7b6ee57e6bcd85c67c9b8431b36fff21c437");
  EXPECT_EQ(manifest["results"]["run"]["model.xml"]["bytes"], 3);
  EXPECT_EQ(manifest["results"]["run"].size(), 2U);
}

TEST(ResultWriter, ChangesNothingWithoutCommit) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json"}, "old");
  {
    ResultWriter writer(folder.path());
    writer.Add("metrics.json", "new");
    writer.Add("model.xml", "new");
    EXPECT_EQ(ReadFile(folder.path() / "metrics.json"), "old");
  }
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("metrics.json", "manifest.json"));
  EXPECT_EQ(run_folder::RequireFile(folder.path() / "metrics.json"),
            folder.path() / "metrics.json");
}

TEST(ResultWriter, TellsBeforeItCommitsWhatIsInItsWay) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json"}, "old");
  fs::create_directory(folder.path() / "model.xml");
  fs::create_symlink("/dev/null", folder.path() / "plan.csv");
  ResultWriter writer(folder.path());
  EXPECT_EQ(Refusal([&] { writer.Add("model.xml", "new"); }),
            "cannot write " + (folder.path() / "model.xml").string() + ": Is a directory");
  EXPECT_EQ(Refusal([&] { writer.Add("plan.csv", "new"); }),
            "cannot write " + (folder.path() / "plan.csv").string() + ": it is not a regular file");
}

TEST(ResultWriter, MakesAFolderAnewThatVanished) {
  const TempFolder folder;
  const OutputFolder out(folder.path() / "r");
  fs::remove_all(out.path());
  ResultWriter writer(out);
  writer.Add("metrics.json", "new");
  writer.Commit("run", {});
  EXPECT_EQ(ReadFile(out.path() / "metrics.json"), "new");
}

TEST(OutputFolder, IsOfOneProcessAtATime) {
  const TempFolder folder;
  const std::string refused = folder.path().string() +
                              " is being written by another trackbed (process " +
                              std::to_string(::getpid()) + ")";
  {
    const OutputFolder one(folder.path());
    EXPECT_EQ(Refusal([&] { const OutputFolder other(folder.path()); }), refused);
    EXPECT_EQ(Refusal([&] { UseFolderOf(folder.path() / "video.mp4", folder.path()); }), refused);
    // What is only read, or lies elsewhere, needs no lock.
    EXPECT_EQ(UseFolderOf(folder.path() / "video.mp4", folder.path() / "r"), std::nullopt);
  }
  const auto film = UseFolderOf(folder.path() / "video.mp4", folder.path());
  const auto page = UseFolderOf(folder.path() / "report.html", folder.path());
  EXPECT_TRUE(film && page);
  EXPECT_EQ(Refusal([&] { const OutputFolder other(folder.path()); }), refused);
  EXPECT_THAT(folder.Names(), IsEmpty());  // the lock leaves no file
}

TEST(OutputFolder, IsNotMadeForAnAddition) {
  const TempFolder folder;
  const OutputFolder missing(folder.path() / "r", OutputFolder::For::kAddition);
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(OutputFolder, LosesWhatAKilledWriterHadNotCompleted) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json"}, "old");
  folder.Write(".trackbed.partial/metrics.json", "half");
  folder.Write(".video.1-0.trackbed.mp4", "half");
  const auto film = UseFolderOf(folder.path() / "video.mp4", folder.path());
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("metrics.json", "manifest.json"));
  EXPECT_EQ(ReadFile(folder.path() / "metrics.json"), "old");
}

// A writer killed after the commit point has moved none of its files, some, or all of them.
TEST(OutputFolder, MovesIntoPlaceWhatAKilledWriterHadCompleted) {
  const TempFolder folder;
  const std::vector<std::string> names{"metrics.json", "model.xml", "plan.csv"};
  Write(folder.path() / "whole", "run", names, "new");
  for (std::size_t moved = 0; moved <= names.size() + 1; ++moved) {
    const fs::path run = folder.path() / std::to_string(moved);
    Write(run, "run", {"metrics.json", "model.xml", "tree.csv"}, "old");
    folder.Write(run.filename().string() + "/report.html", "of the old one");
    const fs::path complete = run / run_folder::kComplete;
    fs::copy(folder.path() / "whole", complete);
    folder.Write(run.filename().string() + "/.trackbed.complete/.obsolete",
                 R"(["tree.csv", "report.html", "../notes.txt"])");
    const fs::path notes = folder.Write("notes.txt", "mine");
    for (std::size_t i = 0; i < moved; ++i) {
      const std::string name = i < names.size() ? names[i] : "manifest.json";
      fs::rename(complete / name, run / name);
    }
    // Until then nobody takes it for a result.
    EXPECT_THAT(Refusal([&] { run_folder::RequireFile(run / "metrics.json"); }),
                HasSubstr("between two results"));
    const OutputFolder next(run, OutputFolder::For::kAddition);
    std::vector<std::string> left;
    for (const auto& entry : fs::directory_iterator(run)) {
      left.push_back(entry.path().filename());
    }
    EXPECT_THAT(left,
                UnorderedElementsAre("metrics.json", "model.xml", "plan.csv", "manifest.json"));
    for (const std::string& name : left) {
      EXPECT_EQ(ReadFile(run_folder::RequireFile(run / name)),
                ReadFile(folder.path() / "whole" / name));
    }
    EXPECT_TRUE(fs::exists(notes));
  }
}

// A run folder may come from anybody.
TEST(OutputFolder, MovesNothingOutOfWhatALinkPointsTo) {
  const TempFolder folder;
  folder.Write("mine/notes.txt", "mine");
  folder.Write("mine/.obsolete", R"(["mine.txt"])");
  folder.Write("r/mine.txt", "mine");
  fs::create_symlink(folder.path() / "mine", folder.path() / "r" / run_folder::kComplete);
  const OutputFolder next(folder.path() / "r", OutputFolder::For::kAddition);
  EXPECT_TRUE(fs::exists(folder.path() / "mine/notes.txt"));
  EXPECT_TRUE(fs::exists(folder.path() / "r/mine.txt"));
}

TEST(OutputFolder, IsNotWrittenThroughLinks) {
  const TempFolder folder;
  const fs::path notes = folder.Write("notes.txt", "mine");
  const fs::path run = folder.path() / "r";
  Write(run, "run", {"metrics.json"}, "a");
  fs::create_symlink(notes, run / "report.html");
  ASSERT_EQ(::mkfifo((run / "video.mp4").c_str(), 0600), 0);
  EXPECT_EQ(Refusal([&] { UseFolderOf(run / "report.html", run); }),
            "cannot write " + (run / "report.html").string() +
                ": it is a link; remove it, or give another place");
  EXPECT_THAT(Refusal([&] { UseFolderOf(run / "video.mp4", run); }),
              HasSubstr(": it is not a regular file"));
  EXPECT_EQ(Refusal([&] { UseFolderOf(run / "picture.png", run); }), "");
}

TEST(OutputFolder, OfSomebodyElsesFilesIsRefused) {
  const TempFolder folder;
  folder.Write("notes.txt", "mine");
  { const OutputFolder mine(folder.path()); }  // none of ours has that name
  folder.Write("plan.csv", "mine");
  folder.Write("sweep.csv", "mine");
  EXPECT_EQ(Refusal([&] { const OutputFolder next(folder.path()); }),
            folder.path().string() +
                " has files that are of no result, as there is no manifest.json: plan.csv, "
                "sweep.csv; choose another folder, or remove them");
  { const OutputFolder page(folder.path(), OutputFolder::For::kAddition); }
}

TEST(Manifest, RefusesFilesOfAnotherRun) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& name) {
    return Refusal([&] { run_folder::RequireFile(folder.path() / name); });
  };
  folder.Write("metrics.json", "of an older version");
  EXPECT_EQ(refusal("metrics.json"), "");  // no manifest
  folder.Write("manifest.json", R"({"results": {}})");
  Write(folder.path(), "comparison", {"compare.csv", "compare.json"}, "a");
  EXPECT_EQ(refusal("metrics.json"), "");  // nor one that tells of runs
  Write(folder.path(), "run", {"metrics.json", "plan.csv"}, "a");
  EXPECT_EQ(refusal("metrics.json"), "");
  EXPECT_EQ(refusal("compare.json"), "");
  folder.Write("plan.csv", "b");
  folder.Write("mujoco.plan.csv", "of another run");
  for (const char* name : {"plan.csv", "mujoco.plan.csv"}) {
    EXPECT_EQ(refusal(name), (folder.path() / name).string() +
                                 ": does not belong to this run: written by another (interrupted) "
                                 "run, or changed since (manifest.json has the SHA-256 of its "
                                 "files); run it again");
  }
  folder.Write("video.mp4", "any film");
  EXPECT_EQ(refusal("video.mp4"), "");
  folder.Write("manifest.json", "{]");
  EXPECT_THAT(refusal("metrics.json"), HasSubstr("manifest.json:1:2: not JSON"));
}

TEST(Manifest, IsNotWaitedFor) {
  const TempFolder folder;
  folder.Write("metrics.json", "{}");
  ASSERT_EQ(::mkfifo((folder.path() / "manifest.json").c_str(), 0600), 0);
  const std::string refused = (folder.path() / "manifest.json").string() + ": is no regular file";
  EXPECT_EQ(Refusal([&] { run_folder::RequireFile(folder.path() / "metrics.json"); }), refused);
  EXPECT_EQ(Refusal([&] { const OutputFolder out(folder.path()); }), refused);
}

TEST(Manifest, KnowsARunByThePlanThatItWasDrivenOn) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json", "plan.csv", "tree.csv"}, "a");
  const auto refusal = [&] {
    return Refusal([&] { run_folder::RequireFile(folder.path() / "metrics.json"); });
  };
  Write(folder.path(), "plan", {"plan.csv", "tree.csv"}, "a");  // the same one again
  EXPECT_EQ(refusal(), "");
  Write(folder.path(), "plan", {"plan.csv"}, "b", {"tree.csv"});
  EXPECT_THAT(refusal(), HasSubstr("does not belong to this run"));
  EXPECT_TRUE(fs::exists(folder.path() / "metrics.json"));  // but it is not lost
}

TEST(Reading, TellsThatAResultWasReplacedMeanwhile) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json"}, "a");
  const run_folder::Reading reading({folder.path()});
  Write(folder.path(), "run", {"metrics.json"}, "a");  // the same one again
  reading.RequireUnchanged();
  Write(folder.path(), "run", {"metrics.json"}, "b");
  EXPECT_EQ(Refusal([&] { reading.RequireUnchanged(); }),
            folder.path().string() + ": its result was replaced while it was read; try again");
}

}  // namespace
}  // namespace trackbed
