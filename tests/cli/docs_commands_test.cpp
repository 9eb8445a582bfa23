// Runs the program's commands in the shell blocks of README.md and docs/. Each page is a test in a
// separate folder, which runs the page's commands in their order, like a reader.

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

/// Arguments of a command, without the program; with their quotes.
using Words = std::vector<std::string>;

/// The commands of a page, in order.
struct Page {
  std::string name;  ///< of the test
  std::vector<Words> commands;
};

void PrintTo(const Page& page, std::ostream* out) {
  *out << page.name;
}

/// One of the kParts parts of a command that runs all scenarios of a folder.
struct FolderPart {
  std::string name;  ///< of the test
  std::string folder;
  std::size_t part = 0;
};

void PrintTo(const FolderPart& part, std::ostream* out) {
  *out << part.name;
}

std::string Joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

Words WordsOf(const std::string& command) {
  static const std::regex kWord(R"((?:[^\s']|'[^']*')+)");
  Words words;
  for (std::sregex_iterator it(command.begin(), command.end(), kWord), end; it != end; ++it) {
    words.push_back(it->str());
  }
  return words;
}

std::vector<Words> CommandsOf(const fs::path& page) {
  const std::string program = "build/release/trackbed ";
  std::istringstream text(ReadFile(page));
  std::vector<Words> commands;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with(program)) {
      commands.push_back(WordsOf(line.substr(program.size(), line.find(" #") - program.size())));
    }
  }
  return commands;
}

bool IsTestOfAFolder(const Words& words) {
  return words.size() == 2 && words[0] == "test" && fs::is_directory(kSource / words[1]);
}

std::string TestName(const fs::path& page) {
  std::string name = page.lexically_relative(kSource).replace_extension().string();
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

/// Returns all pages that have commands.
std::vector<Page> DocumentedPages() {
  std::vector<fs::path> files{kSource / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin() + 1, files.end());
  std::vector<Page> pages;
  for (const fs::path& file : files) {
    if (std::vector<Words> commands = CommandsOf(file); !commands.empty()) {
      pages.push_back({TestName(file), std::move(commands)});
    }
  }
  return pages;
}

std::vector<FolderPart> DocumentedFolders() {
  std::vector<FolderPart> parts;
  for (const Page& page : DocumentedPages()) {
    for (const Words& words : page.commands) {
      for (std::size_t part = 0; IsTestOfAFolder(words) && part < kParts; ++part) {
        parts.push_back(
            {page.name + "_" + TestName(kSource / words[1]) + "_" + std::to_string(part + 1),
             words[1], part});
      }
    }
  }
  return parts;
}

/// The arguments of options that name outputs.
std::vector<std::string> Outputs(const Words& words) {
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
std::string MadeBy(const Words& words) {
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
std::vector<std::string> ReadBy(const Words& words) {
  const std::vector<std::string> outputs = Outputs(words);
  std::vector<std::string> read;
  std::copy_if(words.begin(), words.end(), std::back_inserter(read), [&](const std::string& word) {
    return word.starts_with("out/") &&
           std::find(outputs.begin(), outputs.end(), word) == outputs.end();
  });
  return read;
}

/// A folder in which the commands of a page run, in their order.
class DocumentedCommands : public testing::Test {
 protected:
  DocumentedCommands() {
    for (const char* name : {"scenarios", "models", "tests"}) {
      fs::create_directory_symlink(kSource / name, folder_.path() / name);
    }
    fs::create_directory(folder_.path() / "out");
  }

  /// Runs the commands of the README that produce the inputs of `words` which are missing.
  void Prepare(const Words& words) {
    for (const std::string& result : ReadBy(words)) {
      for (const Words& maker : CommandsOf(kSource / "README.md")) {
        const std::string made = MadeBy(maker);
        if (!fs::exists(folder_.path() / result) && !made.empty() &&
            (result + "/").starts_with(made + "/")) {
          Prepare(maker);
          Do(maker);
        }
      }
      ASSERT_TRUE(fs::exists(folder_.path() / result))
          << result << ": no command before it on its page, or of the README, makes it";
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

  void Do(const Words& words) {
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

class Documented : public DocumentedCommands, public testing::WithParamInterface<Page> {};

TEST_P(Documented, CommandsDoWhatTheirPageSays) {
  for (const Words& words : GetParam().commands) {
    SCOPED_TRACE(Joined(words));
    if (IsTestOfAFolder(words) || (words[0] == "render" && !HasVideo(folder_))) {
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(Prepare(words));
    Do(words);
  }
}

INSTANTIATE_TEST_SUITE_P(Docs, Documented, testing::ValuesIn(DocumentedPages()),
                         [](const auto& test) { return test.param.name; });

class DocumentedFolder : public DocumentedCommands,
                         public testing::WithParamInterface<FolderPart> {};

TEST_P(DocumentedFolder, PassesItsTest) {
  const std::vector<fs::path> files =
      ScenarioFiles({(kSource / GetParam().folder).string()}, FolderContent::kScenarios);
  ASSERT_GE(files.size(), kParts);
  Words words{"test"};
  for (std::size_t i = GetParam().part; i < files.size(); i += kParts) {
    words.push_back(files[i].string());
  }
  Do(words);
}

INSTANTIATE_TEST_SUITE_P(Docs, DocumentedFolder, testing::ValuesIn(DocumentedFolders()),
                         [](const auto& test) { return test.param.name; });

TEST(DocumentedPages, HaveManyCommands) {
  std::size_t commands = 0;
  for (const Page& page : DocumentedPages()) {
    commands += page.commands.size();
  }
  EXPECT_GE(commands, 100U);
  EXPECT_GE(DocumentedFolders().size(), kParts);
}

}  // namespace docs_commands_test
}  // namespace trackbed
