#include "trackbed/analysis/written_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/temp_folder.h"
#include "trackbed/analysis/run_folder.h"

namespace trackbed {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsSupersetOf;
using testing::Not;

TEST(WrittenNames, OfAVerbFollowFromItsResults) {
  EXPECT_THAT(FileNamesOfVerb("plan"),
              ElementsAre("plan.json", "plan.csv", "schedule.csv", "convergence.csv", "tree.csv"));
  EXPECT_THAT(FileNamesOfVerb("verify"), ElementsAre("sweep.csv", "sweep.json", "verify.json",
                                                     "sweep.records", "report.html"));
  const auto names = FileNamesOfVerb("identify", {{"vehicle", {"a/b"}}, {"record", {"x", "y"}}});
  EXPECT_THAT(names, ElementsAre("identify.json", "a_b.xml", "x.residuals.csv", "y.residuals.csv",
                                 "bank.csv", "timing.json", "report.html"));
  EXPECT_THAT(FileNamesOfVerb("run"),
              IsSupersetOf({"kinematic.state.csv", "mujoco-contact.csv", "video.mp4"}));
  EXPECT_THAT(NamesOfVerb("sweep"), IsSupersetOf({"rows/<row>/", "sweep.records"}));
}

TEST(WrittenNames, MatchTheirParts) {
  EXPECT_TRUE(IsNameOf(run_folder::kRun, "kinematic.csv"));
  EXPECT_TRUE(IsNameOf(run_folder::kRun, "asset12_body.stl"));
  EXPECT_TRUE(IsNameOf(run_folder::kIdentification, "dart.xml"));
  EXPECT_TRUE(IsNameOf(run_folder::kPlan, "tree.csv"));
  EXPECT_FALSE(IsNameOf(run_folder::kPlan, "kinematic.csv"));
  EXPECT_FALSE(IsNameOf(run_folder::kRun, ".csv"));
  EXPECT_FALSE(IsNameOf(run_folder::kRun, "asset_body.stl"));
  EXPECT_FALSE(IsNameOf(run_folder::kRun, "notes.txt"));
  EXPECT_FALSE(IsNameOf("result of nobody", "plan.csv"));
}

TEST(WrittenNames, KnowTrackbedsPagesPicturesAndVideosByTheirMarks) {
  const TempFolder folder;
  const std::string header(33, 'h');
  const std::vector<std::tuple<std::string, std::string, bool>> files{
      {"a.html", "<html><head>" + std::string(kPageMark), true},
      {"b.html", "<html><head><meta name=\"generator\" content=\"pytest\">", false},
      {"c.html", "", false},
      {"a.png", header + PictureMark() + "rest", true},
      {"b.png", header + "rest of the picture of somebody else", false},
      {"c.png", "short", false},
      {"a.mp4", "film" + VideoMark(), true},
      {"b.mp4", VideoMark() + "film", false},
      {"c.mp4", "x", false},
      {"a.csv", std::string(kPageMark), false},
  };
  for (const auto& [name, content, own] : files) {
    EXPECT_EQ(HasMark(folder.Write(name, content)), own) << name;
  }
  std::filesystem::create_symlink("a.html", folder.path() / "link.html");
  EXPECT_FALSE(HasMark(folder.path() / "link.html"));
  EXPECT_FALSE(HasMark(folder.path() / "absent.html"));
  // A box: its size, big-endian, and its type.
  EXPECT_EQ(VideoMark(), std::string("\0\0\0\x10", 4) + "freeTrackbed");
}

}  // namespace
}  // namespace trackbed
