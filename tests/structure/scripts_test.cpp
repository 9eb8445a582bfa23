#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

/// The programs of scripts/; other files are read by them.
std::vector<fs::path> Scripts() {
  std::vector<fs::path> scripts;
  for (const auto& entry : fs::directory_iterator(kRoot / "scripts")) {
    const bool runs = (entry.status().permissions() & fs::perms::owner_exec) != fs::perms::none;
    if (entry.is_regular_file() && runs) {
      scripts.push_back(entry.path());
    }
  }
  return scripts;
}

/// Returns the first sentence of the comment or docstring at the head of a script, up to the end of
/// its line.
std::string Purpose(const fs::path& script) {
  std::ifstream in(script);
  std::string line;
  std::getline(in, line);
  std::getline(in, line);
  return line.substr(line.find_first_not_of("#\" "));
}

struct Outcome {
  int code = -1;
  std::string output;
};

/// Runs a script for at most 10 s, so that a script without help does not build.
Outcome RunScript(const fs::path& script, const std::string& arguments) {
  FILE* pipe =
      ::popen(("timeout 10 '" + script.string() + "' " + arguments + " 2>&1").c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
    outcome.output.append(part.data(), n);
  }
  const int status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

TEST(Scripts, PrintTheirPurposeForHelp) {
  ASSERT_GT(Scripts().size(), 20U);
  for (const fs::path& script : Scripts()) {
    const Outcome help = RunScript(script, "--help");
    EXPECT_EQ(help.code, 0) << script << "\n" << help.output;
    EXPECT_THAT(help.output, testing::HasSubstr(Purpose(script))) << script;
  }
}

/// A misspelled option must not start the long work that these scripts do without options.
TEST(Scripts, RefuseUnknownOptions) {
  for (const char* name : {"demo", "format", "gallery", "figures", "laps", "matrix", "package",
                           "setup", "stability", "wheel"}) {
    const Outcome refused = RunScript(kRoot / "scripts" / name, "--wrong-option");
    EXPECT_THAT(refused.code, testing::AnyOf(1, 2)) << name << "\n" << refused.output;
    EXPECT_THAT(refused.output, testing::HasSubstr("--wrong-option")) << name;
  }
}

}  // namespace
