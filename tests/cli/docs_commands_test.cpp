// Runs the program's commands in the shell blocks of README.md and docs/. Each command is a test in
// a separate folder, after the commands that produce the results it reads.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/scenario_files.h"

namespace trackbed {
namespace docs_commands_test {

namespace fs = std::filesystem;

const fs::path kSource = TRACKBED_SOURCE_DIR;
/// A command that runs all scenarios of a folder is split into this many tests.
constexpr std::size_t kParts = 8;

struct Command {
  std::string name;                 ///< of the test
  std::vector<std::string> words;   ///< without the program; including quotes
  std::vector<std::string> before;  ///< the preceding commands on its page, in order
  std::size_t part = 0;
  std::size_t parts = 1;
};

void PrintTo(const Command& command, std::ostream* out) {
  *out << command.name;
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

std::vector<std::string> Words(const std::string& command) {
  static const std::regex kWord(R"((?:[^\s']|'[^']*')+)");
  std::vector<std::string> words;
  for (std::sregex_iterator it(command.begin(), command.end(), kWord), end; it != end; ++it) {
    words.push_back(it->str());
  }
  return words;
}

std::vector<std::string> CommandsOf(const fs::path& page) {
  const std::string program = "build/release/trackbed ";
  std::istringstream text(ReadFile(page));
  std::vector<std::string> commands;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with(program)) {
      commands.push_back(line.substr(program.size(), line.find(" #") - program.size()));
    }
  }
  return commands;
}

bool IsTestOfAFolder(const std::vector<std::string>& words) {
  return words.size() == 2 && words[0] == "test" && fs::is_directory(kSource / words[1]);
}

std::vector<Command> DocumentedCommands() {
  std::vector<fs::path> pages{kSource / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") {
      pages.push_back(entry.path());
    }
  }
  std::sort(pages.begin() + 1, pages.end());
  std::vector<Command> commands;
  for (const fs::path& page : pages) {
    std::string title = page.lexically_relative(kSource).replace_extension().string();
    std::replace_if(
        title.begin(), title.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    const std::vector<std::string> own = CommandsOf(page);
    for (std::size_t i = 0; i < own.size(); ++i) {
      Command command{.words = Words(own[i]),
                      .before = {own.begin(), own.begin() + static_cast<std::ptrdiff_t>(i)}};
      std::string verb = command.words.front();
      std::erase(verb, '-');
      command.name = title + "_" + std::to_string(i + 1) + "_" + verb;
      command.parts = IsTestOfAFolder(command.words) ? kParts : 1;
      const std::string name = command.name;
      for (command.part = 0; command.part < command.parts; ++command.part) {
        command.name = command.parts == 1 ? name : name + "_" + std::to_string(command.part + 1);
        commands.push_back(command);
      }
    }
  }
  return commands;
}

/// The arguments of options that name outputs.
std::vector<std::string> Outputs(const std::vector<std::string>& words) {
  static const std::vector<std::string> kOptions{"-o",     "--out",    "--junit",
                                                 "--save", "--report", ">"};
  std::vector<std::string> outputs;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (std::find(kOptions.begin(), kOptions.end(), words[i - 1]) != kOptions.end()) {
      outputs.push_back(words[i]);
    }
  }
  return outputs;
}

/// Output folder or file of a command; "" if it writes none.
std::string MadeBy(const std::vector<std::string>& words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i - 1] == "-o" || words[i - 1] == "--out" || words[i - 1] == ">") {
      return words[i];
    }
  }
  const auto file = std::find_if(words.begin(), words.end(),
                                 [](const std::string& word) { return word.ends_with(".yaml"); });
  const std::string stem = file == words.end() ? "" : fs::path(*file).stem().string();
  if (words[0] == "compare") {
    return stem.empty() ? "out/compare" : "out/compare/" + stem;
  }
  return words[0] == "run" || words[0] == "sweep" || words[0] == "falsify" ? "out/" + stem : "";
}

/// Results that a command reads.
std::vector<std::string> ReadBy(const std::vector<std::string>& words) {
  const std::vector<std::string> outputs = Outputs(words);
  std::vector<std::string> read;
  std::copy_if(words.begin(), words.end(), std::back_inserter(read), [&](const std::string& word) {
    return word.starts_with("out/") &&
           std::find(outputs.begin(), outputs.end(), word) == outputs.end();
  });
  return read;
}

class Documented : public testing::TestWithParam<Command> {
 protected:
  Documented() {
    for (const char* name : {"scenarios", "models", "tests"}) {
      fs::create_directory_symlink(kSource / name, folder_.path() / name);
    }
    fs::create_directory(folder_.path() / "out");
  }

  /// Runs the commands that produce the inputs of `words`: preceding commands on the same page, or
  /// commands of the README.
  void Prepare(const std::vector<std::string>& words, const std::vector<std::string>& before) {
    for (const std::string& result : ReadBy(words)) {
      bool is_made = fs::exists(folder_.path() / result);
      for (const auto& commands : {before, CommandsOf(kSource / "README.md")}) {
        for (std::size_t i = 0; i < commands.size() && !is_made; ++i) {
          const std::vector<std::string> maker = Words(commands[i]);
          const std::string made = MadeBy(maker);
          if (!made.empty() && (result + "/").starts_with(made + "/")) {
            Prepare(maker, {commands.begin(), commands.begin() + static_cast<std::ptrdiff_t>(i)});
            Do(maker);
          }
        }
        is_made = fs::exists(folder_.path() / result);
      }
      ASSERT_TRUE(is_made) << result << ": no command before it on its page, or of the README, "
                           << "makes it";
    }
  }

  /// Reduces an identification study to one recording, one start and three parameters: full ones
  /// take minutes.
  void Shorten(const std::string& study) const {
    fs::remove(folder_.path() / "scenarios");
    fs::copy(kSource / "scenarios", folder_.path() / "scenarios", fs::copy_options::recursive);
    std::istringstream lines(ReadFile(folder_.path() / study));
    std::string text;
    int parameters = 0;
    for (std::string line; std::getline(lines, line);) {
      line = std::regex_replace(line, std::regex(R"(^fit: \[([^,\]]+)[^\]]*\])"), "fit: [$1]");
      line = std::regex_replace(line, std::regex("^starts: [0-9]+"), "starts: 1");
      parameters += line.starts_with("  - {name: ") ? 1 : 0;
      text += !line.starts_with("  - {name: ") || parameters <= 3 ? line + "\n" : "";
    }
    ASSERT_GT(parameters, 3);
    folder_.Write(study, text);
  }

  void Do(const std::vector<std::string>& words) {
    if (words[0] == "identify") {
      Shorten(words[1]);
    }
    std::string command = Joined(words);
    if (!HasVideo(folder_)) {
      command = std::regex_replace(command, std::regex(" --video"), "");
    }
    if (words[0] == "watch") {
      // `watch` ends only with Ctrl-C.
      const Outcome watched = Watched(folder_, command.substr(6));
      EXPECT_TRUE(watched.code == 130 || watched.code == 0) << command << "\n" << watched.output;
      EXPECT_THAT(watched.output, testing::StartsWith("http://127.0.0.1:")) << command;
      return;
    }
    // A whole film takes minutes at full size; a small one at two frames a second tests the
    // command. Short runs test a sweep.
    const bool film = words[0] == "render";
    const bool sweep = words[0] == "sweep" && words[1] != "merge";
    const bool run_film = command.find(" --video") != std::string::npos;
    static const std::regex kLook(" --(size|fps) [^ ]+");
    const Outcome outcome =
        Trackbed(folder_, std::regex_replace(command, kLook, "") +
                              (film       ? " --size 128x72 --fps 2"
                               : run_film ? " --set render.size=[128,72] --set render.fps=2"
                               : sweep    ? " --set drive.time_limit=1"
                                          : ""));
    // The documented searches find a violation.
    EXPECT_EQ(outcome.code, words[0] == "falsify" ? 3 : 0) << command << "\n" << outcome.output;
  }

  TempFolder folder_;
};

TEST_P(Documented, CommandDoesWhatItsPageSays) {
  const Command& command = GetParam();
  if (command.words[0] == "render" && !HasVideo(folder_)) {
    GTEST_SKIP() << "built without video";
  }
  std::vector<std::string> words = command.words;
  if (command.parts > 1) {
    const std::vector<fs::path> files =
        ScenarioFiles({(kSource / words[1]).string()}, FolderContent::kScenarios);
    ASSERT_GE(files.size(), command.parts);
    words.resize(1);
    for (std::size_t i = command.part; i < files.size(); i += command.parts) {
      words.push_back(files[i].string());
    }
  }
  ASSERT_NO_FATAL_FAILURE(Prepare(words, command.before));
  Do(words);
}

INSTANTIATE_TEST_SUITE_P(Docs, Documented, testing::ValuesIn(DocumentedCommands()),
                         [](const auto& test) { return test.param.name; });

TEST(DocumentedCommands, AreFoundOnManyPages) {
  EXPECT_GE(DocumentedCommands().size(), 100U);
}

}  // namespace docs_commands_test
}  // namespace trackbed
