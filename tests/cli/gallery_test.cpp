#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

/// The names that `trackbed list KIND` prints.
std::vector<std::string> ListedNames(const std::string& kind) {
  const TempFolder folder;
  std::istringstream lines(Trackbed(folder, "list " + kind).output);
  std::vector<std::string> names;
  std::string line;
  std::getline(lines, line);  // the heading
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    words >> names.emplace_back();
  }
  return names;
}

/// The names below the pictures of a section of docs/gallery.md.
std::vector<std::string> ShownNames(const std::string& page, const std::string& title) {
  const std::size_t begin = page.find("\n## " + title + "\n");
  EXPECT_NE(begin, std::string::npos) << title;
  const std::string section = page.substr(begin, page.find("\n## ", begin + 1) - begin);
  std::vector<std::string> names;
  const std::regex entry(R"re(<img src="images/gallery/[\w/]+\.webp" alt="(\w+)")re");
  for (std::sregex_iterator it(section.begin(), section.end(), entry), end; it != end; ++it) {
    names.push_back((*it)[1]);
  }
  return names;
}

TEST(Docs, GalleryShowsAllThatIsListed) {
  const std::string page = ReadFile(std::string(TRACKBED_SOURCE_DIR) + "/docs/gallery.md");
  const std::vector<std::pair<std::string, std::string>> kSections{{"scenarios", "Scenarios"},
                                                                   {"planners", "Planners"},
                                                                   {"controllers", "Controllers"},
                                                                   {"maneuvers", "Maneuvers"}};
  for (const auto& [kind, title] : kSections) {
    const std::vector<std::string> listed = ListedNames(kind);
    EXPECT_GT(listed.size(), 5U) << kind;
    EXPECT_THAT(ShownNames(page, title), testing::UnorderedElementsAreArray(listed))
        << title << " of docs/gallery.md; its table is docs/gallery.txt";
  }
}

}  // namespace
}  // namespace trackbed
