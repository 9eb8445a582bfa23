#include "trackbed/analysis/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// A page as Trackbed writes it.
const std::string kPage = "<html><head>" + std::string(kPageMark);

/// Writes a result whose files all hold `content`.
void Write(const fs::path& folder, const std::string& result, const std::vector<std::string>& names,
           const std::string& content, const std::vector<std::string>& obsolete = {}) {
  ResultWriter writer(OutputFolder(folder, std::vector<std::string>()));
  for (const std::string& name : names) {
    writer.Add(name, content);
  }
  writer.Commit(result, obsolete);
}

TEST(ResultWriter, ReplacesAResultAsAWhole) {
  const TempFolder folder;
  folder.Write("notes.txt", "mine");
  Write(folder.path(), "run", {"metrics.json", "model.xml", "tree.csv"}, "old");
  folder.Write("report.html", kPage);
  folder.Write("video.mp4", "mine");
  Write(folder.path(), "run", {"metrics.json", "model.xml"}, "new",
        {"report.html", "video.mp4", "notes.txt"});
  EXPECT_THAT(folder.Names(),
              UnorderedElementsAre("metrics.json", "model.xml", "manifest.json", "notes.txt",
                                   "video.mp4"));  // the file has no mark of Trackbed
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
  ResultWriter writer(OutputFolder(folder.path(), std::vector<std::string>()));
  const std::string rest = "; move it away, or choose another place (-o)";
  EXPECT_EQ(ErrorText<std::exception>([&] { writer.Add("model.xml", "new"); }),
            "cannot write " + (folder.path() / "model.xml").string() + ": it is a folder" + rest);
  EXPECT_EQ(ErrorText<std::exception>([&] { writer.Add("plan.csv", "new"); }),
            "cannot write " + (folder.path() / "plan.csv").string() + ": it is a link" + rest);
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
    EXPECT_EQ(ErrorText<std::exception>([&] { const OutputFolder other(folder.path()); }), refused);
    EXPECT_EQ(ErrorText<std::exception>(
                  [&] { LockFolderOf(folder.path() / "video.mp4", folder.path()); }),
              refused);
    // Folders that are only read, or lie elsewhere, need no lock.
    EXPECT_EQ(LockFolderOf(folder.path() / "video.mp4", folder.path() / "r"), std::nullopt);
  }
  const auto film = LockFolderOf(folder.path() / "video.mp4", folder.path());
  const auto page = LockFolderOf(folder.path() / "report.html", folder.path());
  EXPECT_TRUE(film && page);
  EXPECT_EQ(ErrorText<std::exception>([&] { const OutputFolder other(folder.path()); }), refused);
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
  folder.Write(".trackbed.partial/manifest.json", "{}");
  // The last line may be truncated. The file that it names was then not begun.
  folder.Write(".trackbed.partial/.written", "metrics.json\nmanifest.json\nplan.c");
  folder.Write(".video.1-0.trackbed.mp4", "half");
  const auto film = LockFolderOf(folder.path() / "video.mp4", folder.path());
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("metrics.json", "manifest.json"));
  EXPECT_EQ(ReadFile(folder.path() / "metrics.json"), "old");
}

// A writer killed after the commit point may have moved none, some or all of its files.
TEST(OutputFolder, MovesIntoPlaceWhatAKilledWriterHadCompleted) {
  const TempFolder folder;
  const std::vector<std::string> names{"metrics.json", "model.xml", "plan.csv"};
  Write(folder.path() / "whole", "run", names, "new");
  for (std::size_t moved = 0; moved <= names.size() + 1; ++moved) {
    const fs::path run = folder.path() / std::to_string(moved);
    Write(run, "run", {"metrics.json", "model.xml", "tree.csv"}, "old");
    folder.Write(run.filename().string() + "/report.html", kPage);
    const fs::path complete = run / run_folder::kComplete;
    fs::copy(folder.path() / "whole", complete);
    folder.Write(run.filename().string() + "/.trackbed.complete/.obsolete",
                 R"(["tree.csv", "report.html", "../notes.txt", "mine.csv", ".", ""])");
    const fs::path notes = folder.Write("notes.txt", "mine");
    const fs::path mine = folder.Write(run.filename().string() + "/mine.csv", "mine");
    if (moved > 0) {
      fs::remove(run / "tree.csv");
      fs::remove(run / "report.html");
    }
    for (std::size_t i = 0; i < moved; ++i) {
      const std::string name = i < names.size() ? names[i] : "manifest.json";
      fs::rename(complete / name, run / name);
    }
    // Until recovery, readers reject the folder.
    EXPECT_THAT(ErrorText<std::exception>([&] { run_folder::RequireFile(run / "metrics.json"); }),
                HasSubstr("between two results"));
    const OutputFolder next(run, OutputFolder::For::kAddition);
    std::vector<std::string> left;
    for (const auto& entry : fs::directory_iterator(run)) {
      left.push_back(entry.path().filename());
    }
    EXPECT_THAT(left, UnorderedElementsAre("metrics.json", "model.xml", "plan.csv", "manifest.json",
                                           "mine.csv"));
    fs::remove(mine);
    std::erase(left, "mine.csv");
    for (const std::string& name : left) {
      EXPECT_EQ(ReadFile(run_folder::RequireFile(run / name)),
                ReadFile(folder.path() / "whole" / name));
    }
    EXPECT_TRUE(fs::exists(notes));
  }
}

// A run folder may come from an untrusted source.
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
  EXPECT_EQ(ErrorText<std::exception>([&] { LockFolderOf(run / "report.html", run); }),
            "cannot write " + (run / "report.html").string() +
                ": it is a link; remove it, or give another place");
  EXPECT_EQ(ErrorText<std::exception>([&] { const OutputFolder next(run); }),
            run.string() +
                " has files that Trackbed has not written, according to its "
                "manifest.json: report.html, video.mp4; move them away, or choose "
                "another folder (-o)");
  EXPECT_THAT(ErrorText<std::exception>([&] { LockFolderOf(run / "video.mp4", run); }),
              HasSubstr(": it is not a regular file"));
  EXPECT_EQ(ErrorText<std::exception>([&] { LockFolderOf(run / "picture.png", run); }), "");
}

TEST(OutputFolder, OfSomebodyElsesFilesIsRefused) {
  const TempFolder folder;
  folder.Write("notes.txt", "mine");
  { const OutputFolder mine(folder.path()); }  // no file of Trackbed has this name
  folder.Write("plan.csv", "mine");
  folder.Write("metrics.json", "mine");
  folder.Write("sweep.csv", "mine");  // no run has that name
  const std::string rest = "; move them away, or choose another folder (-o)";
  const std::string begin = folder.path().string() +
                            " has files that Trackbed has not written, according to its "
                            "manifest.json: ";
  EXPECT_EQ(ErrorText<std::exception>([&] { const OutputFolder next(folder.path()); }),
            begin + "plan.csv, metrics.json" + rest);
  EXPECT_EQ(ErrorText<std::exception>(
                [&] { const OutputFolder next(folder.path(), FileNamesOfVerb("verify")); }),
            begin + "sweep.csv" + rest);
  { const OutputFolder page(folder.path(), OutputFolder::For::kAddition); }
}

// The user may have files in the folder of a result, under names that other results use.
TEST(OutputFolder, OfAResultKeepsFilesOfOthers) {
  const std::vector<std::string> own{"metrics.json", "model.xml"};
  for (const std::string& name : run_folder::AllNames()) {
    if (name == "manifest.json" || name == "timing.json" ||
        std::find(own.begin(), own.end(), name) != own.end()) {
      continue;
    }
    const TempFolder folder;
    Write(folder.path(), "run", own, "old");
    folder.Write(name, "mine");
    EXPECT_THAT(ErrorText<std::exception>([&] { const OutputFolder next(folder.path()); }),
                HasSubstr(": " + name))
        << name;
    // Without that check the writer still refuses the name, and removes nothing.
    const OutputFolder unasked(folder.path(), std::vector<std::string>());
    ResultWriter writer(unasked);
    EXPECT_THAT(ErrorText<std::exception>([&] { writer.Add(name, "new"); }),
                HasSubstr("Trackbed has not written the file of that name"));
    writer.Add("model.xml", "new");
    writer.Commit("run", run_folder::AllNames());
    EXPECT_EQ(ReadFile(folder.path() / name), "mine");
    EXPECT_FALSE(fs::exists(folder.path() / "metrics.json"));
  }
}

TEST(OutputFolder, KnowsTheFilesOfAResultThatIsNoLongerWhole) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json", "plan.csv", "asset0_body.stl", "timing.json"}, "a");
  Write(folder.path(), "plan", {"plan.csv"}, "b");
  const auto manifest = nlohmann::json::parse(ReadFile(folder.path() / "manifest.json"));
  EXPECT_EQ(manifest["others"], nlohmann::json({"asset0_body.stl", "metrics.json", "timing.json"}));
  { const OutputFolder next(folder.path()); }
  Write(folder.path(), "run", {"metrics.json", "plan.csv"}, "c");
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("metrics.json", "plan.csv", "manifest.json"));
  EXPECT_FALSE(nlohmann::json::parse(ReadFile(folder.path() / "manifest.json")).contains("others"));
}

TEST(OutputFolder, LeavesFilesOfOthersInItsHiddenFolders) {
  for (const char* hidden : {run_folder::kPartial, run_folder::kComplete}) {
    const TempFolder folder;
    Write(folder.path(), "run", {"metrics.json"}, "old");
    const fs::path notes = folder.Write(std::string(hidden) + "/notes.txt", "mine");
    const fs::path plan = folder.Write(std::string(hidden) + "/plan.csv", "mine");
    EXPECT_EQ(ErrorText<std::exception>([&] { const OutputFolder next(folder.path()); }),
              (folder.path() / hidden).string() +
                  " has files that Trackbed has not written: notes.txt, plan.csv; move them away");
    EXPECT_EQ(ReadFile(notes) + ReadFile(plan), "minemine");
    EXPECT_EQ(ReadFile(folder.path() / "metrics.json"), "old");
  }
}

// A killed process may have moved a part of the first result of a folder, whose manifest comes
// last.
TEST(OutputFolder, TakesNoPartOfAMovedResultForForeign) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json", "plan.csv"}, "new");
  const fs::path complete = folder.path() / run_folder::kComplete;
  fs::create_directory(complete);
  for (const char* name : {"manifest.json", "plan.csv"}) {
    fs::rename(folder.path() / name, complete / name);
  }
  folder.Write("tree.csv", "mine");
  EXPECT_THAT(ForeignNames(folder.path(), run_folder::AllNames()),
              testing::ElementsAre("tree.csv"));
}

TEST(OutputFolder, MovesNoResultOverAFileOfAnother) {
  const TempFolder folder;
  Write(folder.path() / "new", "run", {"metrics.json", "plan.csv"}, "new");
  Write(folder.path() / "r", "run", {"metrics.json"}, "old");
  fs::rename(folder.path() / "new", folder.path() / "r" / run_folder::kComplete);
  const fs::path mine = folder.Write("r/plan.csv", "mine");
  EXPECT_THAT(ErrorText<std::exception>([&] { const OutputFolder next(folder.path() / "r"); }),
              HasSubstr("Trackbed has not written the file of that name"));
  EXPECT_EQ(ReadFile(mine), "mine");
  fs::remove(mine);
  { const OutputFolder next(folder.path() / "r"); }
  EXPECT_EQ(ReadFile(folder.path() / "r/plan.csv"), "new");
}

TEST(OutputFolder, RefusesLinksForItsHiddenFolders) {
  for (const char* hidden : {run_folder::kPartial, run_folder::kComplete}) {
    const TempFolder folder;
    const fs::path notes = folder.Write("mine/metrics.json", "mine");
    fs::create_directory(folder.path() / "r");
    fs::create_symlink(folder.path() / "mine", folder.path() / "r" / hidden);
    EXPECT_THAT(ErrorText<std::exception>([&] { const OutputFolder next(folder.path() / "r"); }),
                HasSubstr(std::string(hidden) + ": it is a link, not a folder"));
    EXPECT_EQ(ReadFile(notes), "mine");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "r" / hidden));
  }
}

TEST(FolderBelow, IsNoLink) {
  const TempFolder folder;
  folder.Write("mine/3/metrics.json", "mine");
  folder.Write("s/rows/0/metrics.json", "a");
  fs::create_symlink(folder.path() / "mine", folder.path() / "linked");
  fs::create_symlink(folder.path() / "mine/3", folder.path() / "s/rows/3");
  fs::create_symlink("absent", folder.path() / "s/rows/4");
  folder.Write("s/rows/5", "a file");
  EXPECT_EQ(FolderBelow(folder.path() / "s", "rows/0"), folder.path() / "s/rows/0");
  EXPECT_EQ(FolderBelow(folder.path() / "s", "rows/1"), folder.path() / "s/rows/1");
  // The output folder itself is the user's choice.
  EXPECT_EQ(FolderBelow(folder.path() / "linked", "3"), folder.path() / "linked/3");
  for (const char* below : {"rows/3", "rows/4", "rows/3/deep"}) {
    EXPECT_THAT(ErrorText<std::exception>([&] { FolderBelow(folder.path() / "s", below); }),
                HasSubstr(": it is a link, not a folder"))
        << below;
  }
  EXPECT_THAT(ErrorText<std::exception>([&] { FolderBelow(folder.path() / "s", "rows/5"); }),
              HasSubstr(": it is a file, not a folder"));
}

TEST(RemoveResults, LeavesFilesOfOthers) {
  const TempFolder folder;
  const fs::path row = folder.path() / "rows/3";
  Write(row, "run", {"metrics.json", "model.xml", "timing.json"}, "a");
  Write(row, "comparison", {"compare.csv"}, "a");
  for (const char* name : {"notes.txt", "plan.csv", "deep/notes.txt", "video.mp4"}) {
    folder.Write(std::string("rows/3/") + name, "mine");
  }
  folder.Write("rows/3/report.html", kPage);
  folder.Write("elsewhere", "mine");
  fs::remove(row / "model.xml");
  fs::create_symlink(folder.path() / "elsewhere", row / "model.xml");
  RemoveResults(row);
  std::vector<std::string> left;
  for (const auto& entry : fs::recursive_directory_iterator(row)) {
    left.push_back(entry.path().lexically_relative(row));
  }
  EXPECT_THAT(left, UnorderedElementsAre("notes.txt", "plan.csv", "deep", "deep/notes.txt",
                                         "video.mp4", "model.xml"));
  EXPECT_EQ(ReadFile(folder.path() / "elsewhere"), "mine");
  RemoveResults(row);  // nothing to remove
  EXPECT_EQ(ReadFile(row / "plan.csv"), "mine");
}

TEST(RemoveResults, RemovesAFolderThatIsEmptyThen) {
  const TempFolder folder;
  Write(folder.path() / "r", "run", {"metrics.json"}, "a");
  RemoveResults(folder.path() / "r");
  RemoveResults(folder.path() / "r");
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(RemoveResults, GoesThroughNoLink) {
  const TempFolder folder;
  Write(folder.path() / "mine", "run", {"metrics.json"}, "a");
  fs::create_symlink("mine", folder.path() / "r");
  EXPECT_THAT(ErrorText<std::exception>([&] { RemoveResults(folder.path() / "r"); }),
              HasSubstr("is a link"));
  EXPECT_EQ(ReadFile(folder.path() / "mine/metrics.json"), "a");
}

// Other functions convert names from inputs to file names (FileNameOf), so ResultWriter rejects
// names that are paths.
TEST(ResultWriter, TakesPlainFileNamesOnly) {
  const TempFolder folder;
  folder.Write("victim.xml", "mine");
  ResultWriter writer(folder.path() / "r");
  for (const std::string& name :
       {std::string("../victim.xml"), std::string("/tmp/victim.xml"), std::string("a/b.xml"),
        std::string(), std::string("."), std::string(".."), std::string(".hidden.xml"),
        std::string("a\nb.xml"), std::string("a\0b.xml", 7), std::string("\xff.xml"),
        std::string("a b.xml"), std::string(256, 'a'), std::string(".written"),
        std::string("caf\xc3\xa9.xml")}) {
    EXPECT_THAT(ErrorText<std::exception>([&] { writer.Add(name, "new"); }),
                HasSubstr("not a plain file name"))
        << name;
  }
  EXPECT_EQ(ReadFile(folder.path() / "victim.xml"), "mine");
  EXPECT_THAT(folder.Names(), UnorderedElementsAre("r", "victim.xml"));
}

TEST(ResultWriter, WritesOnlyNamesThatAreDeclared) {
  const TempFolder folder;
  ResultWriter writer(folder.path());
  writer.Add("notes.txt", "new");
  EXPECT_THAT(ErrorText<std::exception>([&] { writer.EndResult("run", {}); }),
              HasSubstr("AllResultNames lists no file notes.txt of the result run"));
}

TEST(ResultWriter, CommitsSeveralResultsAtOnce) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json"}, "old");
  Write(folder.path(), "comparison", {"compare.json"}, "old");
  {
    ResultWriter writer(folder.path());
    writer.Add("metrics.json", "new");
    writer.EndResult("run", run_folder::AllNames());
    writer.Add("compare.json", "new");
    writer.EndResult("comparison", {"report.html"});
    EXPECT_EQ(ReadFile(folder.path() / "metrics.json"), "old");
    writer.Commit();
  }
  const auto manifest = nlohmann::json::parse(ReadFile(folder.path() / "manifest.json"));
  EXPECT_EQ(manifest["results"].size(), 2U);
  for (const char* name : {"metrics.json", "compare.json"}) {
    EXPECT_EQ(ReadFile(run_folder::RequireFile(folder.path() / name)), "new");
  }
}

TEST(Manifest, RefusesFilesOfAnotherRun) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& name) {
    return ErrorText<std::exception>([&] { run_folder::RequireFile(folder.path() / name); });
  };
  folder.Write("metrics.json", "of an older version");
  EXPECT_EQ(refusal("metrics.json"), "");  // no manifest
  folder.Write("manifest.json", R"({"results": {}})");
  Write(folder.path(), "comparison", {"compare.csv", "compare.json"}, "a");
  EXPECT_EQ(refusal("metrics.json"), "");  // a manifest without results
  fs::remove(folder.path() / "metrics.json");
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

// Other programs have files of this name.
TEST(Manifest, OfAnotherProgramIsRefused) {
  for (const char* text :
       {R"({"name": "a page", "results": {}})", R"({"results": []})", "{}", "[]", "1",
        R"({"results": {"run": 1}})", R"({"results": {"run": {"a": {"bytes": 1}}}})",
        R"({"results": {}, "others": [1]})", "", "mine"}) {
    const TempFolder folder;
    folder.Write("manifest.json", text);
    EXPECT_THAT(ErrorText<std::exception>([&] { const OutputFolder out(folder.path()); }),
                HasSubstr("manifest.json"))
        << text;
    EXPECT_EQ(ReadFile(folder.path() / "manifest.json"), text);
  }
}

TEST(Manifest, IsNotWaitedFor) {
  const TempFolder folder;
  folder.Write("metrics.json", "{}");
  ASSERT_EQ(::mkfifo((folder.path() / "manifest.json").c_str(), 0600), 0);
  const std::string refused = (folder.path() / "manifest.json").string() + ": is no regular file";
  EXPECT_EQ(
      ErrorText<std::exception>([&] { run_folder::RequireFile(folder.path() / "metrics.json"); }),
      refused);
  EXPECT_EQ(ErrorText<std::exception>([&] { const OutputFolder out(folder.path()); }), refused);
}

TEST(Manifest, KnowsARunByThePlanThatItWasDrivenOn) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json", "plan.csv", "tree.csv"}, "a");
  const auto refusal = [&] {
    return ErrorText<std::exception>(
        [&] { run_folder::RequireFile(folder.path() / "metrics.json"); });
  };
  Write(folder.path(), "plan", {"plan.csv", "tree.csv"}, "a");  // the same one again
  EXPECT_EQ(refusal(), "");
  Write(folder.path(), "plan", {"plan.csv"}, "b", {"tree.csv"});
  EXPECT_THAT(refusal(), HasSubstr("does not belong to this run"));
  EXPECT_TRUE(fs::exists(folder.path() / "metrics.json"));  // the file still exists
}

TEST(Reading, TellsThatAResultWasReplacedMeanwhile) {
  const TempFolder folder;
  Write(folder.path(), "run", {"metrics.json"}, "a");
  const run_folder::Reading reading({folder.path()});
  Write(folder.path(), "run", {"metrics.json"}, "a");  // the same one again
  reading.RequireUnchanged();
  Write(folder.path(), "run", {"metrics.json"}, "b");
  EXPECT_EQ(ErrorText<std::exception>([&] { reading.RequireUnchanged(); }),
            folder.path().string() + ": its result was replaced while it was read; try again");
}

}  // namespace
}  // namespace trackbed
