#include "trackbed/analysis/sweep_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

ordered_json Header(std::size_t rows = 5) {
  return {{"study", "s"}, {"vary", {{"mission.speed", {1, 2}}}}, {"rows_expected", rows}};
}

ordered_json RowOf(int value) {
  return {{"cells", {std::to_string(value), "passed"}}};
}

class Records : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "sweep.records"; }
  [[nodiscard]] SweepRecords Open() const { return {file(), Header()}; }

  TempFolder folder_;
};

TEST_F(Records, AreThereWhenTheFileIsOpenedAgain) {
  {
    SweepRecords records = Open();
    records.Append(3, RowOf(30));
    records.Append(0, RowOf(0));
    EXPECT_EQ(records.count(), 2U);
  }
  const SweepRecords records = Open();
  EXPECT_EQ(records.count(), 2U);
  EXPECT_TRUE(records.Has(0));
  EXPECT_FALSE(records.Has(1));
  EXPECT_EQ(records.Read(3)["cells"][0], "30");
  EXPECT_EQ(records.Read(3)["row"], 3);
}

TEST_F(Records, HaveTheLastOfSeveralLinesOfARow) {
  {
    SweepRecords records = Open();
    records.Append(1, RowOf(10));
    records.Append(1, RowOf(11));
    EXPECT_EQ(records.count(), 1U);
  }
  EXPECT_EQ(Open().Read(1)["cells"][0], "11");
}

// A killed process, a full disk or a power failure may truncate the file anywhere after its header.
// The header is always complete, because the file is created together with its header.
TEST_F(Records, GoOnBehindTheLastWholeLineOfAFileThatIsCutOff) {
  {
    SweepRecords records = Open();
    records.Append(0, RowOf(0));
    records.Append(1, RowOf(10));
  }
  const std::string whole = ReadFile(file());
  std::vector<std::size_t> ends;
  for (std::size_t at = whole.find('\n'); at != std::string::npos; at = whole.find('\n', at + 1)) {
    ends.push_back(at + 1);
  }
  ASSERT_EQ(ends.size(), 3U);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    WriteFileAtomically(file(), whole.substr(0, size));
    if (size > 0 && size < ends[0]) {
      ASSERT_THROW(static_cast<void>(Open()), InputError) << size;
      ASSERT_EQ(ReadFile(file()), whole.substr(0, size));
      continue;
    }
    SweepRecords records = Open();
    const std::size_t expected = size < ends[1] ? 0U : size < ends[2] ? 1U : 2U;
    ASSERT_EQ(records.count(), expected) << "cut after " << size << " bytes";
    records.Append(4, RowOf(40));
    ASSERT_EQ(Open().count(), expected + 1);
  }
}

TEST_F(Records, LeaveFilesOfOthers) {
  for (const std::string text : {"mine", "my notes on it", "0", "deadbeef {", "deadbeef {}\n", "\n",
                                 "00000000 {\"row\":1}\n", "a,b\n1,2\n", " "}) {
    WriteFileAtomically(file(), text);
    EXPECT_FALSE(SweepRecords::IsFileOfRecords(file())) << text;
    EXPECT_THROW(static_cast<void>(Open()), InputError) << text;
    EXPECT_THROW(SweepRecords::Remove(file()), RunError) << text;
    EXPECT_EQ(ReadFile(file()), text);
  }
  std::filesystem::remove(file());
  SweepRecords::Remove(file());  // no file exists
  { const SweepRecords records = Open(); }
  EXPECT_TRUE(SweepRecords::IsFileOfRecords(file()));
  const std::filesystem::path link = file().string() + ".link";
  std::filesystem::create_symlink(file(), link);
  EXPECT_THROW(SweepRecords::Remove(link), RunError);
  EXPECT_TRUE(std::filesystem::exists(file()));
  SweepRecords::Remove(file());
  EXPECT_FALSE(std::filesystem::exists(file()));
}

// Blocks that were not yet written when the power failed read as zeros.
TEST_F(Records, TakeNoLineForWholeWhoseBytesAreOthers) {
  {
    SweepRecords records = Open();
    records.Append(0, RowOf(0));
    records.Append(1, RowOf(10));
  }
  const std::string whole = ReadFile(file());
  const std::size_t second = whole.find('\n') + 1;
  for (std::size_t at = second; at + 1 < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = changed[at] == '0' ? '1' : '0';
    WriteFileAtomically(file(), changed);
    EXPECT_LT(Open().count(), 2U) << "byte " << at;
  }
}

TEST_F(Records, RefuseAnotherStudyAndSayWhatChanged) {
  static_cast<void>(Open());
  ordered_json other = Header();
  other["vary"]["mission.speed"][1] = 3;
  other["repeat"] = 2;
  try {
    const SweepRecords records(file(), other);
    FAIL() << "did not throw";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("has rows of another study (vary.mission.speed: "
                                                 "[1,3], was [1,2]; repeat: 2, was absent)"));
  }
  EXPECT_EQ(Open().count(), 0U);  // the file is unchanged
}

TEST_F(Records, RefuseAFileOfSomethingElse) {
  WriteFileAtomically(file(), "t_s,x_m\n0,0\n1,1\n");
  EXPECT_THROW(static_cast<void>(Open()), InputError);
  EXPECT_EQ(ReadFile(file()), "t_s,x_m\n0,0\n1,1\n");
}

TEST_F(Records, TakeRowsFromSeveralThreads) {
  constexpr std::size_t kRows = 4000;
  {
    SweepRecords records(file(), Header(kRows));
    std::vector<std::jthread> threads;
    for (std::size_t first = 0; first < 4; ++first) {
      threads.emplace_back([&records, first] {
        for (std::size_t row = first; row < kRows; row += 4) {
          records.Append(row, RowOf(static_cast<int>(row)));
        }
      });
    }
  }
  const SweepRecords records(file(), Header(kRows));
  ASSERT_EQ(records.count(), kRows);
  for (std::size_t row = 0; row < kRows; ++row) {
    ASSERT_EQ(records.Read(row)["cells"][0], std::to_string(row));
  }
}

TEST_F(Records, FollowNoLinks) {
  folder_.Write("elsewhere", "");
  std::filesystem::create_symlink(folder_.path() / "elsewhere", file());
  EXPECT_THROW(static_cast<void>(Open()), RunError);
}

TEST_F(Records, InMemoryAreTheSame) {
  SweepRecords records = SweepRecords::InMemory(Header());
  records.Append(2, RowOf(20));
  EXPECT_EQ(records.count(), 1U);
  EXPECT_EQ(records.Read(2)["cells"][0], "20");
}

}  // namespace
}  // namespace trackbed
