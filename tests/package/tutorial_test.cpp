// Follows docs/tutorial.md as a new user would: writes its files and runs its commands in the order
// of the page, in an empty home, against the installed package. The output must match the page.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/shell.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

using Lines = std::vector<std::string>;

/// Commands of the page that the test does not run, with the reason.
const std::map<std::string, std::string> kDoneBefore = {
    {"scripts/demo", "installs packages, builds and films: the build under test is what it leaves"},
    {"scripts/setup testing",
     "installs GoogleTest and builds trackbed::testing, as this build has"},
    {"cmake --install build/release --prefix $HOME/trackbed",
     "Package.IsInstalledAndMoved has done it; $HOME/trackbed leads to what it left"},
};

Lines SplitIntoLines(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

std::string Joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

/// A fenced block of the page.
struct Block {
  std::string language;
  std::string file;  ///< named at the end of the line before it, as in: `corner.yaml`:
  Lines lines;
};

std::vector<Block> ParseBlocks(const std::string& page) {
  static const std::regex kNames("`([^`]+)`:$");
  std::vector<Block> blocks;
  bool inside = false;
  std::string last;
  for (const std::string& line : SplitIntoLines(page)) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) {
        std::smatch name;
        const bool named = std::regex_search(last, name, kNames);
        blocks.push_back({line.substr(3), named ? name.str(1) : "", {}});
      }
      last.clear();
    } else if (inside) {
      blocks.back().lines.push_back(line);
    } else if (!line.empty()) {
      last = line;
    }
  }
  return blocks;
}

/// Whether a line of the page matches an output line. Words must be equal; spaces may differ.
/// Numbers may differ by one in the last digit shown: a run is bitwise reproducible on one build
/// and machine, and another processor's sines, 1e-15 off relatively, can only change the rounding.
/// Wall-clock times ("ms", "sec") may have any value.
bool Shows(const std::string& shown, const std::string& told) {
  static const std::regex kClock(" *[0-9.]+ (ms|sec)\\b");
  static const std::regex kSpaces(" +");
  static const std::regex kNumber("[0-9]+(\\.([0-9]+))?");
  const auto plain = [](const std::string& line) {
    return std::regex_replace(std::regex_replace(line, kClock, " $1"), kSpaces, " ");
  };
  const std::string a = plain(shown);
  const std::string b = plain(told);
  if (std::regex_replace(a, kNumber, "#") != std::regex_replace(b, kNumber, "#")) {
    return false;
  }
  const std::sregex_iterator end;
  for (std::sregex_iterator i(a.begin(), a.end(), kNumber), j(b.begin(), b.end(), kNumber);
       i != end; ++i, ++j) {
    const double unit = std::pow(10.0, -static_cast<double>(i->length(2)));
    if (std::abs(std::stod(i->str()) - std::stod(j->str())) > 1.001 * unit) {
      return false;
    }
  }
  return true;
}

/// The first line that is shown but was not printed, or was printed but is not shown; empty if
/// all lines match. A shown line "..." matches any lines.
std::string FirstDifference(const Lines& shown, const Lines& told) {
  std::size_t next = 0;
  bool skip = false;
  for (const std::string& line : shown) {
    if (line == "...") {
      skip = true;
      continue;
    }
    while (skip && next < told.size() && !Shows(line, told[next])) {
      ++next;
    }
    if (next == told.size() || !Shows(line, told[next])) {
      return "shown: " + line;
    }
    ++next;
    skip = false;
  }
  return skip || next == told.size() ? "" : "told: " + told[next];
}

/// A simulated user at a terminal who follows the page.
class Newcomer {
 public:
  Newcomer() {
    std::filesystem::create_directory_symlink(TRACKBED_INSTALLED, home_.path() / "trackbed");
    kept_ = "unset TRACKBED_DATA; export HOME='" + home_.path().string() + "'";
  }

  [[nodiscard]] std::filesystem::path corner() const { return home_.path() / "corner"; }

  void Do(const Block& block) {
    if (block.language == "sh") {
      ExpectAllShown();
      for (const std::string& line : block.lines) {
        Run(line);
      }
    } else if (block.language == "text") {
      EXPECT_EQ(FirstDifference(block.lines, diagnostics_), "") << "what came out:\n"
                                                                << Joined(diagnostics_);
      diagnostics_.clear();
    } else if (block.file.empty()) {
      ADD_FAILURE() << "nobody knows what to do with:\n" << Joined(block.lines);
    } else if (block.language == "diff") {
      Edit(corner() / block.file, block.lines);
    } else {
      WriteFileAtomically(corner() / block.file, Joined(block.lines));
    }
  }

  /// Expects that the page shows all output of the last commands, except that of builds.
  void ExpectAllShown() {
    EXPECT_TRUE(diagnostics_.empty()) << "the page does not show:\n" << Joined(diagnostics_);
    diagnostics_.clear();
  }

  [[nodiscard]] std::size_t skipped() const { return skipped_; }

 private:
  void Run(const std::string& line) {
    static const std::regex kExit(" +# exit code ([0-9]+)$");
    if (kDoneBefore.contains(line)) {
      ++skipped_;
      return;
    }
    if (line.starts_with("cd ") || line.starts_with("export ")) {
      kept_ += "; " + line;  // commands whose effect a shell keeps
    }
    std::smatch exit;
    const int code = std::regex_search(line, exit, kExit) ? std::stoi(exit[1]) : 0;
    const Outcome outcome = Shell(home_, kept_ + "; " + std::regex_replace(line, kExit, ""));
    EXPECT_EQ(outcome.code, code) << line << "\n" << outcome.output;
    if (line.starts_with("cmake ")) {
      return;  // its output depends on its version and is not shown
    }
    const std::string output =
        std::regex_replace(outcome.output, std::regex(home_.path().string()), "/home/you");
    for (const std::string& told : SplitIntoLines(output)) {
      diagnostics_.push_back(told);
    }
  }

  /// Replaces the diff's lines that begin with '-' by those that begin with '+'.
  static void Edit(const std::filesystem::path& file, const Lines& diff) {
    Lines before;
    Lines after;
    for (const std::string& line : diff) {
      (line.starts_with('-') ? before : after).push_back(line.substr(1));
    }
    std::string text = ReadFile(file);
    const std::size_t place = text.find(Joined(before));
    ASSERT_NE(place, std::string::npos) << file << " does not have:\n" << Joined(before);
    WriteFileAtomically(file, text.replace(place, Joined(before).size(), Joined(after)));
  }

  TempFolder home_;
  std::string kept_;   ///< precedes every command
  Lines diagnostics_;  ///< printed since the last output shown
  std::size_t skipped_ = 0;
};

double NumberIn(const std::filesystem::path& json, const std::string& key) {
  const std::string text = ReadFile(json);
  const std::string name = "\"" + key + "\": ";
  const std::size_t place = text.rfind(name);
  return place == std::string::npos ? NAN : std::stod(text.substr(place + name.size()));
}

/// The value of a log's column at five seconds.
double AtFiveSeconds(const std::filesystem::path& log, const std::string& column) {
  const Table table = ReadCsv(log);
  const std::vector<double> times = table.Column("t_s");
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::abs(times[i] - 5.0) < 1e-9) {
      return table.Column(column)[i];
    }
  }
  return NAN;
}

TEST(Tutorial, EndsAsItsPageSays) {
  const std::string page = ReadFile(TRACKBED_SOURCE_DIR "/docs/tutorial.md");
  Newcomer newcomer;
  for (const Block& block : ParseBlocks(page)) {
    newcomer.Do(block);
  }
  newcomer.ExpectAllShown();
  EXPECT_EQ(newcomer.skipped(), kDoneBefore.size());

  // The page quotes values of logs and figures in its text.
  const std::string text = std::regex_replace(page, std::regex("\n"), " ");
  const std::filesystem::path run = newcomer.corner() / "out/corner";
  const std::filesystem::path kinematic = run / "kinematic.csv";
  const std::filesystem::path tyres = run / "mujoco-magic_formula.csv";
  EXPECT_THAT(text,
              testing::HasSubstr(fmt::format("The wheels need {:.2f} s to turn from straight ahead",
                                             NumberIn(run / "plan.json", "ramp_time_s"))));
  EXPECT_THAT(
      text,
      testing::HasSubstr(fmt::format(
          "At 5 s, the kinematic car has a wheel angle of {:.3f} rad and a yaw rate of "
          "{:.3f} rad/s. The car on tyres has nearly the same wheel angle, {:.3f} rad, but "
          "a yaw rate of only {:.3f} rad/s.",
          AtFiveSeconds(kinematic, "steering_rad"), AtFiveSeconds(kinematic, "yaw_rate_radps"),
          AtFiveSeconds(tyres, "steering_rad"), AtFiveSeconds(tyres, "yaw_rate_radps"))));
  EXPECT_THAT(
      text,
      testing::HasSubstr(fmt::format(
          "the yaw rate of the car on tyres is {:.2f} times the value that the kinematic model "
          "predicts",
          NumberIn(newcomer.corner() / "out/longer_preview/metrics.json", "yaw_rate_ratio"))));
}

// Tests the comparison of outputs itself: which lines match and which do not.
TEST(Tutorial, SeesWhatIsNotShown) {
  const Lines told = {"a 1.25 m", "b 3 s", "c", "d"};
  EXPECT_EQ(FirstDifference({"a  1.26 m", "b 3 s", "c", "d"}, told), "");
  EXPECT_EQ(FirstDifference({"a 1.27 m", "b 3 s", "c", "d"}, told), "shown: a 1.27 m");
  EXPECT_EQ(FirstDifference({"...", "c", "..."}, told), "");
  EXPECT_EQ(FirstDifference({"...", "c"}, told), "told: d");
  EXPECT_EQ(FirstDifference({"...", "e", "..."}, told), "shown: e");
  EXPECT_EQ(FirstDifference({"a 1.25 m", "c", "d"}, told), "shown: c");
  EXPECT_EQ(FirstDifference({"Passed  0.03 sec"}, {"Passed 1.2 sec"}), "");
}

}  // namespace
}  // namespace trackbed
