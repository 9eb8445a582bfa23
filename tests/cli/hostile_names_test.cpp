#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "src/cli/shell_quote.h"
#include "src/cli/terminal.h"
#include "tests/cli/program.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Names from files in scripts and on terminals. A command in a name would make the file `evil`.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// Names with characters that a shell interprets. No script may execute them.
const std::vector<std::string>& HostileNames() {
  static const std::vector<std::string> names{"$(touch evil)",
                                              "`touch evil`",
                                              "a; touch evil",
                                              "a & touch evil",
                                              "a | touch evil",
                                              "it's",
                                              "'; touch evil; '",
                                              "\"; touch evil; \"",
                                              "a' 'b",
                                              "\\",
                                              "end\\",
                                              "\\'",
                                              "back\\slash",
                                              "$HOME",
                                              "${HOME}",
                                              "~",
                                              "~root",
                                              "*",
                                              "?",
                                              "[a-z]",
                                              "{a,b}",
                                              "!",
                                              "!!",
                                              "-n",
                                              "--help",
                                              "a b",
                                              " blank ",
                                              "#no comment",
                                              "a#b",
                                              "a:b",
                                              "a=b",
                                              "(touch evil)",
                                              "<(touch evil)",
                                              "> evil",
                                              "%s%n",
                                              "\xC3\xA9\xE2\x82\xAC",
                                              "\xF0\x9F\x9A\x97",
                                              "packjob",
                                              "a hetjob b",
                                              "PackJob",
                                              "\\$(touch evil)",
                                              "'$(touch evil)'",
                                              "\"$(touch evil)\"",
                                              "$'\\x41'",
                                              "^a^b",
                                              "@(a|b)",
                                              "a''b",
                                              "'",
                                              "\"",
                                              "''",
                                              "names:(touch evil)",
                                              "[$(touch evil)]",
                                              "%(touch evil)",
                                              "=ls",
                                              "a\\ b",
                                              "$((1+1))"};
  return names;
}

/// Names that cannot be quoted: with a control character, or not UTF-8.
const std::vector<std::string>& UnquotableNames() {
  static const std::vector<std::string> names{"a\nb",
                                              "a\n#SBATCH --wrap=evil",
                                              "\ttab",
                                              "cr\r",
                                              "\x1b[31mred",
                                              "\x07",
                                              "\x7f",
                                              "\xff",
                                              "cut \xE2\x82",
                                              "\xC0\xAF",
                                              "\xED\xA0\x80",
                                              "a\xC2\x85"
                                              "b"};
  return names;
}

/// Random words of characters that shells interpret, and of other characters.
std::vector<std::string> RandomNames(std::size_t count) {
  const std::vector<std::string> parts{"'", "\"", "\\", "$", "`",   "(",    ")",   "{",       "}",
                                       "[", "]",  "*",  "?", "!",   "~",    "#",   "&",       ";",
                                       "|", "<",  ">",  " ", "-",   "=",    ":",   ",",       "%",
                                       "^", "@",  "a",  "b", "job", "pack", "het", "\xC3\xA9"};
  std::mt19937 random(5);
  std::vector<std::string> names;
  while (names.size() < count) {
    std::string name;
    for (std::size_t i = 0; i < 1 + random() % 12; ++i) {
      name += parts[random() % parts.size()];
    }
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> EveryName() {
  std::vector<std::string> names = HostileNames();
  const std::vector<std::string> more = RandomNames(300);
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

/// Runs a script in a shell. The output has one word per line.
std::string Echoed(const TempFolder& folder, const std::string& shell, const std::string& script) {
  folder.Write("words", script);
  return Shell(folder, "HOME=$PWD " + shell + " words").output;
}

std::string InLines(const std::vector<std::string>& words) {
  std::string lines;
  for (const std::string& word : words) {
    lines += word + "\n";
  }
  return lines;
}

TEST(ShellQuoting, GivesEveryShellTheWordItself) {
  const TempFolder folder;
  const std::vector<std::string> names = EveryName();
  for (const char* shell : {"sh", "bash", "zsh -f", "zsh -f -o RC_QUOTES"}) {
    std::string script;
    for (const std::string& name : names) {
      script += "printf '%s\\n' " + cli::QuotedForSh(name).value() + "\n";
    }
    EXPECT_EQ(Echoed(folder, shell, script), InLines(names)) << shell;
  }
  std::string script;
  for (const std::string& name : names) {
    script += "printf '%s\\n' " + cli::QuotedForFish(name).value() + "\n";
  }
  EXPECT_EQ(Echoed(folder, "fish --no-config", script), InLines(names));
  EXPECT_FALSE(fs::exists(folder.path() / "evil"));
}

TEST(ShellQuoting, RefusesControlCharactersAndBytesThatAreNotUtf8) {
  for (const std::string& name : UnquotableNames()) {
    EXPECT_FALSE(cli::QuotedForSh(name)) << name;
    EXPECT_FALSE(cli::QuotedForFish(name)) << name;
    EXPECT_FALSE(cli::QuotedForSbatch(name)) << name;
  }
  EXPECT_EQ(cli::AllQuoted({"a", "b\n", "c d"}, cli::QuotedForSh), "'a' 'c d'");
  EXPECT_EQ(cli::AllQuoted({"\n"}, cli::QuotedForSh), "");
}

/// Returns the words of a line after "#SBATCH" by the rules of Slurm's parser: a backslash quotes
/// the next character, quotes keep blanks, and "#" begins a comment outside of quotes.
std::vector<std::string> WordsOfSbatch(const std::string& line) {
  std::vector<std::string> words;
  std::optional<std::string> word;
  char quote = '\0';
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (c == '\\' && at + 1 < line.size()) {
      word = word.value_or("") + line[++at];
    } else if (quote != '\0') {
      if (c == quote) {
        quote = '\0';
      } else {
        word = word.value_or("") + c;
      }
    } else if (c == '"' || c == '\'') {
      quote = c;
      word = word.value_or("");
    } else if (c == '#') {
      break;
    } else if (c == ' ') {
      if (word) {
        words.push_back(*word);
      }
      word.reset();
    } else {
      word = word.value_or("") + c;
    }
  }
  EXPECT_EQ(quote, '\0') << line;
  if (word) {
    words.push_back(*word);
  }
  return words;
}

TEST(ShellQuoting, GivesSlurmTheWordItself) {
  for (const std::string& name : EveryName()) {
    const std::string line = cli::QuotedForSbatch("--chdir=" + name).value();
    EXPECT_THAT(WordsOfSbatch(line), testing::ElementsAre("--chdir=" + name)) << line;
    std::string lower = line;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    EXPECT_THAT(lower, Not(HasSubstr("packjob")));
    EXPECT_THAT(lower, Not(HasSubstr("hetjob")));
  }
}

/// A data folder whose scenarios have hostile names, and two whose names cannot be quoted.
class CompletionOfHostileNames : public testing::Test {
 protected:
  CompletionOfHostileNames() {
    const std::string scenario = ReadFile(ScenarioFile("three_turns"));
    for (const std::string& name : UnquotableNames()) {
      std::ofstream(folder_.Write("data/scenarios/x", "").parent_path() / ("un" + name + ".yaml"))
          << scenario;
    }
    fs::remove(folder_.path() / "data/scenarios/x");
    for (const std::string& name : HostileNames()) {
      std::ofstream(folder_.path() / "data/scenarios" / (name + ".yaml")) << scenario;
    }
    fs::create_directory_symlink(fs::path(TRACKBED_SOURCE_DIR) / "models",
                                 folder_.path() / "data/models");
  }

  Outcome In(const std::string& script) const {
    folder_.Write("script", script);
    return Shell(folder_, "export HOME=$PWD TRACKBED_DATA=$PWD/data; . ./script");
  }

  /// Types the texts into a shell on a terminal after the shell has made the file `ready`, slowly
  /// enough for an answer to each text. Returns the output of the terminal.
  std::string Typed(const std::vector<std::string>& texts, const std::string& shell) const {
    std::string script = "{ until [ -e ready ]; do sleep 0.1; done; sleep 1; ";
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const std::string file = "keys" + std::to_string(i);
      folder_.Write(file, texts[i]);
      script += "cat " + file + "; sleep 1; printf '\\025'; ";  // Ctrl-U
    }
    script += "echo exit; sleep 0.3; } | script -qefc '" + shell + "' /dev/null > said 2>&1";
    In("export ZDOTDIR=$PWD; " + script);
    return ReadFile(folder_.path() / "said");
  }

  void ExpectNothingRan() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      EXPECT_NE(entry.path().filename(), "evil") << entry.path();
    }
  }

  TempFolder folder_;
};

TEST_F(CompletionOfHostileNames, InBashOffersThemQuoted) {
  const Outcome offered =
      In("bash -c '" TRACKBED_PROGRAM
         " completion bash > b.sh && source ./b.sh; COMP_WORDS=(trackbed run \"\"); COMP_CWORD=2; "
         "_trackbed; for word in \"${COMPREPLY[@]}\"; do eval \"printf \\\"%s\\\\n\\\" $word\"; "
         "done'");
  for (const std::string& name : HostileNames()) {
    EXPECT_THAT("\n" + offered.output, HasSubstr("\n" + name + "\n"));
  }
  EXPECT_EQ(
      static_cast<std::size_t>(std::count(offered.output.begin(), offered.output.end(), '\n')),
      HostileNames().size())
      << offered.output;
  ExpectNothingRan();
}

TEST_F(CompletionOfHostileNames, RunNothingAtTheTabKeyOfBash) {
  folder_.Write("rc", "PS1=\nsource <(" TRACKBED_PROGRAM " completion bash)\ntouch ready\n");
  const std::string said = Typed({"trackbed run \t\t", "trackbed check \\$\\(to\t",
                                  "trackbed test it\t", "trackbed test \\`\t"},
                                 "bash --noprofile --rcfile rc -i");
  EXPECT_THAT(said, HasSubstr("trackbed test it\\'s "));
  EXPECT_THAT(said, HasSubstr("\\`touch\\ evil\\`"));
  ExpectNothingRan();
}

TEST_F(CompletionOfHostileNames, InFishOffersThem) {
  const Outcome offered = In("fish --no-config -c '" TRACKBED_PROGRAM
                             " completion fish | source; complete -C \"trackbed run \"'");
  for (const std::string& name : HostileNames()) {
    // Fish completes a leading ~ or - differently, and shows words escaped as they are inserted.
    if (name.find_first_of("\\~") == std::string::npos && name.front() != '-') {
      EXPECT_THAT("\n" + offered.output, HasSubstr("\n" + name + "\n")) << name;
    }
  }
  ExpectNothingRan();
}

TEST_F(CompletionOfHostileNames, InZshOffersThem) {
  const Outcome offered =
      In("zsh -fc '" TRACKBED_PROGRAM
         " completion zsh > _t && compdef() { : }; _files() { : }; compset() { : }; "
         "_arguments() { : }; _describe() { : }; compadd() { print -rl -- ${(P)2}; }; "
         "words=(trackbed run \"\"); CURRENT=3; source ./_t; "
         "for f in ${(ok)functions[(I)_trackbed_*]}; do $f; done'");
  for (const std::string& name : HostileNames()) {
    EXPECT_THAT("\n" + offered.output, HasSubstr("\n" + name + "\n"));
  }
  EXPECT_THAT(offered.output, Not(HasSubstr("\x1b")));
  ExpectNothingRan();
}

TEST_F(CompletionOfHostileNames, RunNothingAtTheTabKeyOfZsh) {
  In(TRACKBED_PROGRAM " completion zsh > _trackbed");
  folder_.Write(".zshrc",
                "PS1=\nfpath=($PWD $fpath)\nautoload -U compinit\ncompinit -u -D\ntouch ready\n");
  const std::string said =
      Typed({"trackbed run \t\t", "trackbed check \\$\\(to\t", "trackbed test it\t",
             "trackbed render x --camera cha\t", "trackbed render --plants kinematic,sing\t"},
            "zsh -i");
  EXPECT_THAT(said, HasSubstr("it\\'s"));
  EXPECT_THAT(said, HasSubstr("--camera chase"));
  EXPECT_THAT(said, HasSubstr("kinematic,single_track"));
  EXPECT_THAT(said, Not(HasSubstr("parse error")));
  ExpectNothingRan();
}

/// Writes a replacement for Slurm's sbatch that accepts every script, prints a job number and logs
/// its options.
void WriteSbatch(const TempFolder& folder) {
  folder.Write("bin/sbatch", "#!/bin/sh\nprintf '%s\\n' \"$@\" >> " +
                                 (folder.path() / "sbatch.log").string() + "\necho 7\n");
  fs::permissions(folder.path() / "bin/sbatch", fs::perms::owner_all);
}

void WriteStudy(const TempFolder& folder, const std::string& name = "study.yaml") {
  fs::copy(ScenarioFile("three_turns"), folder.path() / "three_turns.yaml",
           fs::copy_options::overwrite_existing);
  folder.Write(name,
               "schema: 1\nname: study\nscenario: three_turns.yaml\n"
               "set: {drive.plants: [kinematic], drive.time_limit: 0.1, expect: {}}\n"
               "vary: {mission.speed: [1, 2]}\noutputs: [metrics.kinematic.distance]\n");
}

TEST(SweepSubmit, QuotesTheNamesOfFolders) {
  const TempFolder folder;
  WriteSbatch(folder);
  WriteStudy(folder);
  for (std::string name : HostileNames()) {
    if (name.front() == '-') {
      name = "./" + name;  // otherwise an option
    }
    const std::string out = cli::QuotedForSh("o/" + name).value();
    const Outcome said = Shell(folder, "PATH=$PWD/bin:$PATH " TRACKBED_PROGRAM
                                       " sweep submit study.yaml --tasks 2 -q -o " +
                                           out);
    ASSERT_EQ(said.code, 0) << name << said.output;
    const fs::path path = (folder.path() / "o" / name).lexically_normal();
    for (const char* script : {"array.sh", "merge.sh"}) {
      std::istringstream lines(ReadFile(folder.path() / "o" / name / script));
      std::vector<std::string> words;
      for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("#SBATCH ")) {
          const std::vector<std::string> own = WordsOfSbatch(line.substr(8));
          ASSERT_EQ(own.size(), 1U) << line;
          words.push_back(own.front().starts_with("--chdir=")
                              ? "--chdir=" +
                                    fs::path(own.front().substr(8)).lexically_normal().string()
                              : own.front());
        }
      }
      EXPECT_THAT(words, testing::Contains("--chdir=" + path.string()));
    }
    EXPECT_THAT(ReadFile(folder.path() / "sbatch.log"), HasSubstr("array.sh\n"));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "evil"));
}

TEST(SweepSubmit, WritesScriptsThatDoTheStudy) {
  const TempFolder folder;
  WriteSbatch(folder);
  const std::string study = "it's $(touch evil).yaml";
  WriteStudy(folder, study);
  const std::string out = "o/a 'b' \"c\" $(touch evil) `touch evil` \\ %j #d";
  const std::string quoted = cli::QuotedForSh(out).value();
  ASSERT_EQ(Shell(folder, "PATH=$PWD/bin:$PATH " TRACKBED_PROGRAM " sweep submit " +
                              cli::QuotedForSh(study).value() + " --tasks 1 -q -o " + quoted +
                              " --set \"render.camera='chase'\"")
                .code,
            0);
  const Outcome array = Shell(
      folder, "cd / && SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_COUNT=1 SLURM_ARRAY_TASK_MIN=1 sh '" +
                  folder.path().string() + "'/" + quoted + "/array.sh");
  EXPECT_EQ(array.code, 0) << array.output << ReadFile(folder.path() / out / "task_1.log");
  const Outcome merge =
      Shell(folder, "cd / && sh '" + folder.path().string() + "'/" + quoted + "/merge.sh");
  EXPECT_EQ(merge.code, 0) << merge.output << ReadFile(folder.path() / out / "merge.log");
  EXPECT_TRUE(fs::exists(folder.path() / out / "sweep.csv"));
  EXPECT_EQ(ReadFile(folder.path() / out / "task_1.log"), "");
  EXPECT_EQ(ReadFile(folder.path() / out / "merge.log"), "");
  EXPECT_FALSE(fs::exists(folder.path() / "evil"));
}

TEST(SweepSubmit, FindsShippedStudiesFromEveryFolder) {
  const TempFolder folder;
  WriteSbatch(folder);
  const Outcome said = Shell(folder, "PATH=$PWD/bin:$PATH " TRACKBED_PROGRAM
                                     " sweep submit steering_delay --tasks 1 -q -o o");
  ASSERT_EQ(said.code, 0) << said.output;
  EXPECT_THAT(ReadFile(folder.path() / "o/array.sh"),
              HasSubstr("/scenarios/studies/steering_delay.yaml' --out "));
}

TEST(SweepSubmit, RefusesWhatNoScriptCanHold) {
  const TempFolder folder;
  WriteSbatch(folder);
  WriteStudy(folder);
  for (const std::string& name : UnquotableNames()) {
    folder.Write("out_name", name);
    const Outcome said =
        Shell(folder, "PATH=$PWD/bin:$PATH " TRACKBED_PROGRAM
                      " sweep submit study.yaml --tasks 2 -o \"$(cat out_name; echo x)\"");
    EXPECT_EQ(said.code, 2) << name;
    EXPECT_THAT(said.output, HasSubstr("--out: '"));
    EXPECT_THAT(said.output, HasSubstr("which a script for Slurm cannot hold"));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "sbatch.log"));
  EXPECT_FALSE(fs::exists(folder.path() / "evil"));
}

TEST(SafeTexts, NameControlCharactersAndKeepOthers) {
  EXPECT_EQ(cli::SafeLine("a\tb\nc\x1b[31m\x7f"), "a<U+0009>b<U+000A>c<U+001B>[31m<U+007F>");
  EXPECT_EQ(cli::SafeLine("\xff\xC3\xA9 \xF0\x9F\x9A\x97 \xC2\x9B"),
            "<0xFF>\xC3\xA9 \xF0\x9F\x9A\x97 <U+009B>");
  cli::ChooseColors("always");
  EXPECT_EQ(cli::Colorize(cli::Tone::kBad, "\x1b[0mx").text, "\x1b[31m<U+001B>[0mx\x1b[0m");
  EXPECT_EQ(cli::Joined({cli::Colorize(cli::Tone::kGood, "a"), {"b"}}, ", ").text,
            "\x1b[32ma\x1b[0m, b");
  cli::ChooseColors("auto");
}

/// Whether the text has no control characters except line feeds and tabs.
bool IsSafeOutput(const std::string& text) {
  return WithoutControls(text) == text;
}

// Colors are off, as the output is no terminal: every escape sequence is from a name.
TEST(HostileNames, DoNotReachTheTerminal) {
  const TempFolder folder;
  const std::string good = ReadFile(ScenarioFile("three_turns"));
  for (const std::string& name : UnquotableNames()) {
    folder.Write("data/scenarios/" + name + ".yaml", good);
    folder.Write("good/" + name + ".yaml", good);
    folder.Write("bad/" + name + ".yaml", "schema: 1\n\"" + std::string("k\\e[31m") + "\": 1\n");
  }
  fs::create_directory_symlink(fs::path(TRACKBED_SOURCE_DIR) / "models",
                               folder.path() / "data/models");
  const std::string quick = " --plant kinematic --set drive.time_limit=0.1 expect={}";
  for (const std::string& command :
       std::vector<std::string>{"list scenarios",
                                "list models",
                                "list $'\\e[31m'",
                                "check good bad",
                                "test good" + quick,
                                "test bad",
                                "run good/*" + quick + " -o out",
                                "run bad/*",
                                "run $'none\\e[31m\\xff.yaml'",
                                "run $'\\e[31m'",
                                "run good/$'\\xff'.yaml" + quick + " -o $'o\\e[31m\\xff'",
                                "plan good/$'\\xff'.yaml -o $'p\\e[31m\\xff'",
                                "fmu $'none\\e[31m\\xff.yaml' -o car.fmu",
                                "fmu good/$'\\xff'.yaml -o $'none\\e[31m\\xff/../f.fmu'",
                                "report $'o\\e[31m\\xff'",
                                "compare $'o\\e[31m\\xff' $'o\\e[31m\\xff' -o $'c\\e[31m'",
                                "render $'o\\e[31m\\xff/none'",
                                "check-path $'\\e[31m.csv'",
                                "import $'\\e[31m.csv' --map $'\\e[31m'",
                                "--no\\e[31m-option",
                                "run --$'\\e[31m'",
                                "model $'\\e[31m'",
                                "sweep $'\\e[31m\\xff'",
                                "sweep merge $'\\e[31m\\xff'",
                                "watch $'\\e[31m\\xff'",
                                "completion $'\\e[31m'",
                                "run good/$'\\xff'.yaml --set $'a\\e[31m=1'",
                                "run --from-sweep $'\\e[31m' --row 0"}) {
    folder.Write("command", "TRACKBED_DATA=$PWD/data " TRACKBED_PROGRAM " " + command + "\n");
    const Outcome said = Shell(folder, "bash command");
    EXPECT_TRUE(IsSafeOutput(said.output)) << command << "\n" << WithoutControls(said.output);
    EXPECT_NE(said.code, 1) << command << "\n" << said.output;
    EXPECT_FALSE(said.output.empty()) << command;
  }
}

TEST(Watch, EndsWhenItsAddressCannotBePrinted) {
  const TempFolder folder;
  ASSERT_EQ(Trackbed(folder,
                     "run -q three_turns --plant kinematic -o r --set "
                     "drive.time_limit=0.1 expect={}")
                .code,
            3);  // the run ends before the goal
  for (const char* command :
       {"watch r >&-", "watch r > /dev/full", "watch r -q >&-",
        "watch three_turns --plant kinematic -o w --set drive.time_limit=5 >&-"}) {
    const Outcome said = Shell(folder, "timeout 20 " TRACKBED_PROGRAM " " + std::string(command));
    EXPECT_EQ(said.code, 2) << command;
    EXPECT_THAT(said.output, HasSubstr("cannot write the address of the page to standard output"))
        << command;
  }
}

}  // namespace
}  // namespace trackbed
