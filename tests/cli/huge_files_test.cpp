#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

// A run folder may come from an untrusted source. With any contents, the verbs that read it
// must end with a message, within 1 GiB of address space in addition to the libraries.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Writes a file that no run would produce.
struct HugeFile {
  std::string what;
  std::function<void(const fs::path& file)> write;
};

std::string Repeated(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

HugeFile OfText(std::string what, std::function<std::string()> text) {
  return {std::move(what),
          [text = std::move(text)](const fs::path& file) { WriteFileAtomically(file, text()); }};
}

HugeFile Sparse() {
  return {"100 GB of nothing", [](const fs::path& file) {
            WriteFileAtomically(file, "t_s");
            fs::resize_file(file, 100'000'000'000);
          }};
}

std::vector<HugeFile> HugeJson() {
  return {
      Sparse(),
      OfText("a million lists in each other", [] { return std::string(1'000'000, '['); }),
      OfText("a million sections in each other", [] { return Repeated("{\"a\":", 1'000'000); }),
      OfText("three million lists", [] { return "[" + Repeated("[],", 3'000'000) + "0]"; }),
      OfText("a number of a million digits", [] { return std::string(1'000'000, '1'); }),
      OfText("a key of ten million letters",
             [] { return "{\"" + std::string(10'000'000, 'a') + "\": 1}"; }),
      OfText("what is no UTF-8", [] { return "{\"a\": \"\xff\"}"; }),
  };
}

std::vector<HugeFile> HugeTables() {
  return {
      Sparse(),
      OfText("a million columns", [] { return Repeated("t_s,", 1'000'000) + "x\n"; }),
      OfText("a row of a million cells",
             [] { return "t_s\n" + Repeated("1,", 1'000'000) + "1\n"; }),
      OfText("a cell of a hundred million letters",
             [] { return "t_s\n" + std::string(100'000'000, '1'); }),
      OfText("a million rows of no numbers", [] { return "t_s\n" + Repeated("x\n", 1'000'000); }),
      OfText("a million rows too short", [] { return "t_s,x_m\n" + Repeated("1\n", 1'000'000); }),
      OfText("a column that is no UTF-8", [] { return "\"t_s\xff\"\n1\n"; }),
      OfText("nothing", [] { return ""; }),
      OfText("times of 1e300 s", [] { return "t_s\n0\n1e300\n"; }),
  };
}

class HugeFiles : public testing::Test {
 protected:
  HugeFiles() {
    EXPECT_EQ(Trackbed(folder_, "run -q -o r --set drive.time_limit=0.1 --set 'expect={}' " +
                                    ScenarioFile("winding"))
                  .code,
              3);
    fs::remove(run() / "manifest.json");  // the manifest would detect every change
  }

  [[nodiscard]] fs::path run() const { return folder_.path() / "r"; }

  /// Replaces the file `name` and runs the verbs on it.
  void Try(const std::string& name, const HugeFile& huge, const std::vector<std::string>& verbs) {
    const fs::path kept = folder_.path() / "kept";
    const bool was_there = fs::exists(run() / name);
    if (was_there) {
      fs::rename(run() / name, kept);
    }
    huge.write(run() / name);
    for (const std::string& verb : verbs) {
      const Outcome outcome = Shell(folder_, Limit() + TRACKBED_PROGRAM " " + verb);
      EXPECT_EQ(outcome.code, 2) << verb << " of " << name << " with " << huge.what;
      EXPECT_LT(outcome.output.size(), 21'000U) << verb << " of " << name << " with " << huge.what;
      EXPECT_THAT(outcome.output, testing::HasSubstr(name)) << verb << ", " << huge.what;
      EXPECT_THAT(outcome.output, testing::Not(testing::HasSubstr("exception"))) << huge.what;
      EXPECT_THAT(outcome.output, testing::Not(testing::HasSubstr("memory"))) << huge.what;
    }
    fs::remove(run() / name);
    if (was_there) {
      fs::rename(kept, run() / name);
    }
  }

  /// The sanitizers reserve terabytes of address space.
  static std::string Limit() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return "";
#else
    return "ulimit -v " + std::to_string(kLibraries + kMemory) + "; ";
#endif
  }

  static constexpr long kMemory = 1L << 20U;   // KiB
  static constexpr long kLibraries = 500'000;  // KiB, mapped but only partly used
  TempFolder folder_;
};

constexpr const char* kReport = "report r -o page.html";
constexpr const char* kRender = "render r --at 0 --size 128x72 -o p.png";
constexpr const char* kCompare = "compare r r -o c";

TEST_F(HugeFiles, OfJsonAreRefused) {
  for (const HugeFile& huge : HugeJson()) {
    Try("metrics.json", huge, {kReport, kRender, kCompare});
    Try("plan.json", huge, {kReport});
    Try("manifest.json", huge, {kReport, kRender, kCompare});
  }
}

TEST_F(HugeFiles, OfNumbersAreRefused) {
  for (const HugeFile& huge : HugeTables()) {
    Try("mujoco.csv", huge, {kReport, kRender});
    Try("mujoco.state.csv", huge, {kRender});
    Try("plan.csv", huge, {kReport});
  }
}

TEST_F(HugeFiles, OfModelsAndScenariosAreRefused) {
  for (const char* name : {"model.xml", "scenario.resolved.yaml"}) {
    Try(name, Sparse(), {kReport, kRender});
    Try(name, OfText("a million elements in each other", [] { return Repeated("<a>", 1'000'000); }),
        {kReport, kRender});
    Try(name, OfText("a million lists", [] { return Repeated("[", 1'000'000); }),
        {kReport, kRender});
  }
}

TEST_F(HugeFiles, OfStudiesAreRefused) {
  fs::create_directory(folder_.path() / "r/s");
  for (const HugeFile& huge : HugeTables()) {
    if (huge.what != "times of 1e300 s") {
      Try("s/sweep.csv", huge, {"report r/s -o page.html"});
    }
  }
}

TEST_F(HugeFiles, ThatAreNoneAreRefused) {
  // No process writes to the pipe, so a reader that opens it would wait forever.
  Try("metrics.json",
      {"a pipe", [&](const fs::path& file) { Shell(folder_, "mkfifo '" + file.string() + "'"); }},
      {kReport, kRender, kCompare});
}

}  // namespace
}  // namespace trackbed
