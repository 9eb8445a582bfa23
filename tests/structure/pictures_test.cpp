#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/structure/files.h"

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 300'000;
constexpr std::uintmax_t kMaxBytesOfAll = 10'000'000;

/// Every picture that README.md and the pages of docs/ show, with a page that shows it.
std::map<fs::path, fs::path> ShownPictures() {
  std::vector<fs::path> pages{kRoot / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") {
      pages.push_back(entry.path());
    }
  }
  std::map<fs::path, fs::path> shown;
  const std::regex picture(R"re(!\[[^\]]*\]\(([^)]+)\)|<img src="([^"]+)")re");
  for (const fs::path& page : pages) {
    std::ostringstream stream;
    stream << std::ifstream(page).rdbuf();
    std::string text = stream.str();
    // Text in backquotes is only an example of the syntax.
    text = std::regex_replace(text, std::regex("`[^`\n]+`"), "");
    for (std::sregex_iterator it(text.begin(), text.end(), picture), end; it != end; ++it) {
      const std::string name = (*it)[1].str() + (*it)[2].str();
      shown.emplace((page.parent_path() / name).lexically_normal(), page);
    }
  }
  return shown;
}

/// Every file of docs/images except the record of the pictures' inputs.
std::set<fs::path> Pictures() {
  std::set<fs::path> pictures;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "docs/images")) {
    if (entry.is_regular_file() && entry.path().filename() != "inputs.sha256") {
      pictures.insert(entry.path());
    }
  }
  return pictures;
}

TEST(Pictures, ThatPagesShowAreThere) {
  const auto shown = ShownPictures();
  EXPECT_GT(shown.size(), 20U);  // the scan found the pages
  for (const auto& [picture, page] : shown) {
    EXPECT_TRUE(fs::exists(picture)) << page << " shows " << picture;
  }
}

TEST(Pictures, AreShownByPages) {
  const auto shown = ShownPictures();
  for (const fs::path& picture : Pictures()) {
    EXPECT_TRUE(shown.contains(picture)) << "no page shows " << picture;
  }
}

TEST(Pictures, AreSmall) {
  std::uintmax_t bytes = 0;
  for (const fs::path& picture : Pictures()) {
    EXPECT_LE(fs::file_size(picture), kMaxBytes) << picture;
    bytes += fs::file_size(picture);
  }
  EXPECT_LE(bytes, kMaxBytesOfAll);
}

}  // namespace
