#include "src/cli/terminal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "src/cli/sweep_table.h"
#include "tests/cli/program.h"

namespace trackbed {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kEscape = "\x1b[";

/// Runs a command on a pseudo-terminal made by `script`.
Outcome OnTerminal(const TempFolder& folder, const std::string& command) {
  return Shell(folder, "TERM=xterm script -qefc '" + command + "' /dev/null");
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// The verbs that --help lists.
std::vector<std::string> VerbsOfHelp(const TempFolder& folder) {
  const std::string help = Trackbed(folder, "--help").output;
  std::vector<std::string> verbs;
  bool listed = false;
  for (const std::string& line : LinesOf(help)) {
    std::smatch name;
    listed = listed || line == "Verbs:";
    if (listed && std::regex_search(line, name, std::regex("^  ([a-z]+) "))) {
      verbs.push_back(name[1]);
    }
  }
  return verbs;
}

TEST(Wrapping, BreaksBetweenWords) {
  EXPECT_THAT(cli::Wrapped("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(cli::Wrapped("incomprehensible a b", 4), ElementsAre("incomprehensible", "a b"));
  EXPECT_THAT(cli::Wrapped("", 10), ElementsAre(""));
}

TEST(Durations, AreRoundedToWhatOneWantsToKnow) {
  EXPECT_EQ(cli::DurationText(3.21), "3.2 s");
  EXPECT_EQ(cli::DurationText(59.96), "1 min 0 s");
  EXPECT_EQ(cli::DurationText(3599.4), "59 min 59 s");
  EXPECT_EQ(cli::DurationText(7384.0), "2 h 3 min");
}

TEST(Colors, AreForTerminalsOnly) {
  const TempFolder folder;
  const std::string command =
      TRACKBED_PROGRAM " test three_turns --plant kinematic --set expect={}";
  EXPECT_THAT(Shell(folder, command).output, Not(HasSubstr(kEscape)));
  EXPECT_THAT(Shell(folder, command + " --color always").output, HasSubstr(kEscape + "32m"));
  EXPECT_THAT(OnTerminal(folder, command).output, HasSubstr(kEscape + "32m"));
  EXPECT_THAT(OnTerminal(folder, command + " --color never").output,
              Not(HasSubstr(kEscape + "32m")));
  EXPECT_THAT(OnTerminal(folder, "NO_COLOR=1 " + command).output, Not(HasSubstr(kEscape + "32m")));
  EXPECT_THAT(OnTerminal(folder, "NO_COLOR= " + command).output, HasSubstr(kEscape + "32m"));
  EXPECT_THAT(OnTerminal(folder, "TERM=dumb " + command).output, Not(HasSubstr(kEscape + "32m")));
  EXPECT_EQ(Shell(folder, command + " --color blue").code, 2);
}

TEST(Suites, EndWithTheirTotal) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "test three_turns winding --plant kinematic --set 'expect={}'");
  EXPECT_THAT(outcome.output, testing::ContainsRegex("\n2 scenarios in [0-9.]+ s: 2 (passed|not "
                                                     "judged)\n$"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("three_turns.yaml \\([0-9.]+ s\\): "));
}

TEST(ShippedScenarios, AreFoundByName) {
  const TempFolder folder;
  const Outcome one = Trackbed(folder,
                               "check three_turns iso_3888_2_lane_change robustness "
                               "studies/validity");
  EXPECT_EQ(one.code, 0) << one.output;
  for (const char* file :
       {"scenarios/three_turns.yaml: ok", "scenarios/maneuvers/iso_3888_2_lane_change.yaml: ok",
        "scenarios/studies/robustness.yaml: ok", "scenarios/studies/validity.yaml: ok"}) {
    EXPECT_THAT(one.output, HasSubstr(file));
  }
  const Outcome near = Trackbed(folder, "run thre_turns");
  EXPECT_EQ(near.code, 2);
  EXPECT_EQ(near.output,
            "thre_turns: no such file, and no scenario of this name comes with Trackbed; did you "
            "mean 'three_turns'?\n");
  EXPECT_THAT(Trackbed(folder, "sweep zzzzzz").output, HasSubstr("`trackbed list scenarios`"));
  // A local file takes precedence over a shipped scenario.
  std::ofstream(folder.path() / "three_turns") << "no: scenario\n";
  EXPECT_EQ(Trackbed(folder, "check three_turns").code, 2);
}

TEST(Help, OfEveryVerbIsNoWiderThanATerminalAndHasExamples) {
  const TempFolder folder;
  const std::vector<std::string> verbs = VerbsOfHelp(folder);
  ASSERT_GT(verbs.size(), 10U);
  for (const std::string& verb : verbs) {
    const std::string help = Trackbed(folder, verb + " --help").output;
    EXPECT_THAT(help, HasSubstr("\nExamples:\n")) << verb;
    EXPECT_THAT(help, Not(HasSubstr("C.40"))) << verb;
    for (const std::string& line : LinesOf(help)) {
      // Lines with commands are not wrapped, so that they can be copied.
      if (line.find("trackbed ") == std::string::npos) {
        EXPECT_LE(line.size(), 80U) << verb << ": " << line;
      }
    }
  }
}

TEST(Help, ExamplesDoWhatTheySay) {
  const TempFolder folder;
  std::string commands = "set -e\ntrackbed() { " TRACKBED_PROGRAM " \"$@\" > /dev/null; }\n";
  std::string words;
  for (const char* verb : {"run", "check", "compare", "test", "plan", "render", "report", "list",
                           "model", "fmu", "experiment", "sweep"}) {
    for (const std::string& line :
         LinesOf(Trackbed(folder, std::string(verb) + " --help").output)) {
      if (line.starts_with("    trackbed ") &&
          (HasVideo(folder) || line.find(".webp") == std::string::npos)) {
        commands += line + "\n";
        words += line;
      }
    }
  }
  std::ofstream(folder.path() / "examples.sh") << commands;
  const Outcome outcome = Shell(folder, "bash examples.sh");
  EXPECT_EQ(outcome.code, 0) << outcome.output << commands;
  EXPECT_THAT(words, HasSubstr("trackbed sweep "));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "turn.png"));
}

TEST(SweepTables, ShowFewRowsAsTheyAre) {
  TextTable table({"mission.speed", "status", "runs", "metrics.mujoco.cross_track.max", "reason"});
  table.AddRow({"2", "passed", "1", "0.123456", ""});
  table.AddRow({"10", "failed", "1", "", "because"});
  EXPECT_EQ(cli::SweepTableText(table, 80),
            "                                    Maximum\n"
            "                                cross-track\n"
            "    mission                           error\n"
            "      speed    status      runs    (mujoco)\n"
            "      [m/s]                             [m]\n"
            "          2    passed         1      0.1235\n"
            "         10    failed         1           -\n");
  // Columns that do not fit are counted.
  EXPECT_THAT(cli::SweepTableText(table, 40), testing::EndsWith("\n  and 1 more column\n"));
}

TEST(SweepTables, ShowTheExtremesOfManyRows) {
  TextTable table({"mission.speed", "status", "runs", "metrics.mujoco.cross_track.max", "reason"});
  for (int i = 0; i <= 100; ++i) {
    table.AddRow({std::to_string(i), "passed", "1", std::to_string(100 - i), ""});
  }
  const std::string text = cli::SweepTableText(table, 80);
  EXPECT_THAT(text, testing::ContainsRegex("smallest +median +largest +of rows\n"));
  EXPECT_THAT(text, testing::ContainsRegex(" 0 +50 +100 +101\n"));
}

/// Completions that bash offers for the last of these words.
std::string BashOffers(const TempFolder& folder, const std::string& words) {
  return Shell(folder, "bash -c '" TRACKBED_PROGRAM
                       " completion bash > b.sh; source ./b.sh; COMP_WORDS=(" +
                           words +
                           "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _trackbed; "
                           "echo \"${COMPREPLY[@]}\"'")
      .output;
}

TEST(Completion, OfBashOffersVerbsOptionsAndNames) {
  const TempFolder folder;
  EXPECT_EQ(BashOffers(folder, "trackbed comp"), "compare completion\n");
  EXPECT_EQ(BashOffers(folder, "trackbed run --rep"), "--report\n");
  EXPECT_EQ(BashOffers(folder, "trackbed run three_t"), "three_turns\n");
  EXPECT_EQ(BashOffers(folder, "trackbed render x --camera ch"), "chase\n");
  EXPECT_EQ(BashOffers(folder, "trackbed render x --plants kinematic,sing"),
            "kinematic,single_track\n");
  EXPECT_EQ(BashOffers(folder, "trackbed sweep me"), "merge\n");
  EXPECT_EQ(BashOffers(folder, "trackbed sweep submit --tas"), "--tasks\n");
  EXPECT_EQ(BashOffers(folder, "trackbed run -o \"\""), "\n");  // bash completes file names itself
}

TEST(Completion, OfFishOffersVerbsOptionsAndNames) {
  const TempFolder folder;
  const auto offers = [&](const std::string& line) {
    return Shell(folder, "HOME=$PWD fish --no-config -c '" TRACKBED_PROGRAM
                         " completion fish | source; complete -C \"" +
                             line + "\"'")
        .output;
  };
  EXPECT_THAT(offers("trackbed comp"), testing::MatchesRegex("compare\t.*\ncompletion\t.*\n"));
  EXPECT_THAT(offers("trackbed run --rep"), testing::MatchesRegex("--report\t.*\n"));
  EXPECT_EQ(offers("trackbed run three_t"), "three_turns\n");
  EXPECT_THAT(offers("trackbed render x --camera ch"), testing::StartsWith("chase\t"));
}

TEST(Completion, OfZshIsRegistered) {
  const TempFolder folder;
  const Outcome outcome =
      Shell(folder, "HOME=$PWD zsh -fc '" TRACKBED_PROGRAM
                    " completion zsh > _trackbed && zsh -n _trackbed && fpath=($PWD $fpath) && "
                    "autoload -U compinit && compinit -u -D && echo $_comps[trackbed]'");
  EXPECT_EQ(outcome.output, "_trackbed\n");
}

TEST(ManualPages, HaveNoMistakes) {
  const TempFolder folder;
  ASSERT_EQ(Trackbed(folder, "man pages").code, 0);
  // The pages have no date, so that two builds of one version write the same pages.
  EXPECT_EQ(Shell(folder, "mandoc -T lint -W warning pages/*.1 | grep -v \"missing date\"").output,
            "");
  EXPECT_THAT(Shell(folder, "mandoc -T html pages/trackbed-run.1").output, HasSubstr("--report"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "pages/trackbed-sweep-merge.1"));
}

}  // namespace
}  // namespace trackbed
