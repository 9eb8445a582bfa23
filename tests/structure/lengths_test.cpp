#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

/// Limits of CONTRIBUTING.md [lines].
constexpr std::size_t kMaxHeader = 300;
constexpr std::size_t kMaxSource = 450;
/// A source that is longer than this begins with its algorithm [lines].
constexpr std::size_t kLongSource = 250;
/// An algorithm takes at least these lines.
constexpr std::size_t kAlgorithm = 3;

std::vector<std::string> LinesOf(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Returns the length of the longest comment before the first declaration. Documentation comments
/// belong to declarations.
std::size_t LinesOfAlgorithm(const std::vector<std::string>& lines) {
  std::size_t longest = 0;
  std::size_t here = 0;
  for (const std::string& line : lines) {
    const std::string_view text = line;
    if (text.starts_with("//") && !text.starts_with("///")) {
      longest = std::max(longest, ++here);
    } else if (text.empty() || text.starts_with('#') || text.starts_with("namespace") ||
               text.starts_with("using")) {
      here = 0;
    } else {
      break;
    }
  }
  return longest;
}

std::vector<fs::path> SourceFiles() {
  std::vector<fs::path> files;
  for (const char* folder : {"include/trackbed", "src", "render", "python/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      const fs::path ending = entry.path().extension();
      if (ending == ".h" || ending == ".cpp" || ending == ".js" || ending == ".css") {
        files.push_back(entry.path());
      }
    }
  }
  return files;
}

TEST(Lengths, OfFilesAreLimited) {
  const std::vector<fs::path> files = SourceFiles();
  EXPECT_GT(files.size(), 500U);  // the scan found the files
  for (const fs::path& file : files) {
    const std::size_t most = file.extension() == ".h" ? kMaxHeader : kMaxSource;
    EXPECT_LE(LinesOf(file).size(), most)
        << fs::relative(file, kRoot) << " is too long; divide it by its ideas";
  }
}

TEST(LongSources, BeginWithTheirAlgorithm) {
  std::size_t seen = 0;
  for (const fs::path& file : SourceFiles()) {
    const std::vector<std::string> lines = LinesOf(file);
    if (file.extension() != ".cpp" || lines.size() <= kLongSource) {
      continue;
    }
    ++seen;
    EXPECT_GE(LinesOfAlgorithm(lines), kAlgorithm)
        << fs::relative(file, kRoot) << " has " << lines.size()
        << " lines; describe its algorithm before the first declaration, with its source";
  }
  EXPECT_GT(seen, 50U);  // the scan found the long sources
}

}  // namespace
