#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/scenario/identification.h"
#include "trackbed/scenario/keys.h"
#include "trackbed/scenario/record.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

/// A file with one section on its second line, without the keys of the sections around it.
struct OneSection {
  std::string yaml;
  std::string key;  // dotted key of the section, with the index 0 for elements of lists
};

/// Writes a section into a file. The text `inside` stands from the first column of line 2.
OneSection WriteSection(const std::string& section, const std::string& inside) {
  if (section.empty()) {
    return {"\n" + inside + "\n", ""};
  }
  OneSection written;
  std::string end;
  std::size_t from = 0;
  while (from <= section.size()) {
    const std::size_t dot = std::min(section.find('.', from), section.size());
    std::string name = section.substr(from, dot - from);
    const std::size_t list = name.find("[N]");
    if (list != std::string::npos) {
      name.erase(list);
    }
    written.key += (written.key.empty() ? "" : ".") + name;
    written.yaml += (from == 0 ? "" : "{") + name + ": ";
    end = (from == 0 ? "" : "}") + end;
    if (list != std::string::npos) {
      written.key += "[0]";
      written.yaml += "[";
      end = "]" + end;
    }
    from = dot + 1;
  }
  written.yaml += "\n {" + inside + "}" + end + "\n";
  return written;
}

std::string Messages(const std::string& yaml) {
  return ErrorText([&] { ParseScenario(yaml, "test.yaml", ".", {}); });
}

std::string DottedIn(const OneSection& section, const std::string& key) {
  return section.key.empty() ? key : section.key + "." + key;
}

/// A kind of file: its keys, and a function that reads a text and returns the error messages.
struct FileKind {
  std::vector<KeySection> sections;
  std::function<std::string(const std::string& yaml)> messages;
};

FileKind Scenarios() {
  return {ScenarioKeys(), Messages};
}

template <typename Read>
FileKind ReadByPath(std::vector<KeySection> sections, const Read& read) {
  const auto folder = std::make_shared<TempFolder>();
  return {std::move(sections), [folder, read](const std::string& yaml) {
            return ErrorText([&] { read(folder->Write("test.yaml", yaml)); });
          }};
}

FileKind Studies() {
  return ReadByPath(StudyKeys(), [](const std::filesystem::path& file) { ReadStudy(file); });
}

FileKind Identifications() {
  return ReadByPath(IdentificationKeys(),
                    [](const std::filesystem::path& file) { ReadIdentification(file); });
}

FileKind LogMaps() {
  return ReadByPath(LogMapKeys(), [](const std::filesystem::path& file) { ReadLogMap(file); });
}

/// Returns the text that selects the method of a section, with a comma; empty without a method.
std::string MethodOf(const KeySection& section) {
  const char* key = section.key == "vary.KEY" ? "distribution" : "method";
  return section.method.empty() ? "" : fmt::format("{}: {}, ", key, section.method);
}

/// Checks that a file whose section has `key` with its last letter doubled is refused for this key.
void CheckMisspelling(const FileKind& kind, const KeySection& section, const KeyInfo& key) {
  const std::string wrong = key.name + key.name.back();
  const bool is_known = std::any_of(section.keys.begin(), section.keys.end(),
                                    [&](const KeyInfo& other) { return other.name == wrong; });
  if (is_known) {
    return;
  }
  const std::string method = MethodOf(section);
  const OneSection file =
      WriteSection(section.key, section.key.empty() ? wrong + ": 1" : method + wrong + ": 1");
  const std::size_t column = section.key.empty() ? 1 : 3 + method.size();
  const std::string all = kind.messages(file.yaml);
  SCOPED_TRACE(file.yaml);
  EXPECT_THAT(all, HasSubstr(fmt::format("test.yaml:2:{}: {}: unknown key '{}'; did you mean '",
                                         column, DottedIn(file, wrong), wrong)));
  // Words of fewer than four letters resemble several keys.
  if (key.required && key.name.size() >= 4) {
    EXPECT_THAT(all, HasSubstr(fmt::format("did you mean '{}'?", key.name)));
  }
}

/// Checks every key of a kind of file; `fewest` is a lower bound of the number of keys.
void CheckAllMisspellings(const FileKind& kind, std::size_t fewest) {
  std::size_t keys = 0;
  for (const KeySection& section : kind.sections) {
    for (const KeyInfo& key : section.keys) {
      CheckMisspelling(kind, section, key);
      ++keys;
    }
  }
  EXPECT_GT(keys, fewest);
}

TEST(MisspelledKey, IsNamedInEverySection) {
  CheckAllMisspellings(Scenarios(), 300);
}

TEST(MisspelledKey, IsNamedInStudiesAndIdentifications) {
  CheckAllMisspellings(Studies(), 40);
  CheckAllMisspellings(Identifications(), 20);
  CheckAllMisspellings(LogMaps(), 20);
}

/// Checks that an unknown key is named beside each missing key of a kind of file; `fewest` is a
/// lower bound of the number of required keys.
void CheckBesideMissingKeys(const FileKind& kind, std::size_t fewest) {
  std::size_t required = 0;
  for (const KeySection& section : kind.sections) {
    for (const KeyInfo& key : section.keys) {
      if (!key.required) {
        continue;
      }
      ++required;
      const std::string method = MethodOf(section);
      const OneSection file =
          WriteSection(section.key, section.key.empty() ? "qqzzxw: 1" : method + "qqzzxw: 1");
      const std::size_t column = section.key.empty() ? 1 : 3 + method.size();
      SCOPED_TRACE(file.yaml);
      const std::string all = kind.messages(file.yaml);
      EXPECT_THAT(all, HasSubstr(fmt::format("test.yaml:2:{}: {}: unknown key 'qqzzxw'; ", column,
                                             DottedIn(file, "qqzzxw"))));
      // Sections inside a section without a method are not read, so their keys are not missed.
      if (key.name == "method" || all.find("method: missing") == std::string::npos) {
        EXPECT_THAT(all, HasSubstr(fmt::format(" {}: missing", DottedIn(file, key.name))));
      }
    }
  }
  EXPECT_GT(required, fewest);
}

TEST(MisspelledKey, IsNamedBesideAMissingKey) {
  CheckBesideMissingKeys(Scenarios(), 30);
}

TEST(MisspelledKey, IsNamedBesideAMissingKeyOfStudiesAndIdentifications) {
  CheckBesideMissingKeys(Studies(), 10);
  CheckBesideMissingKeys(Identifications(), 3);
  CheckBesideMissingKeys(LogMaps(), 0);
}

TEST(MisspelledKey, OfAMethodIsNamed) {
  const std::string rest =
      "schema: 1\nname: x\nmission: {speed: 3, waypoints: [[0, 0], [9, 0]]}\n"
      "plan: {method: dubins}\n";
  EXPECT_EQ(Messages(rest + "control: {metod: preview}\n"),
            "test.yaml:5:10: control.method: missing\n"
            "test.yaml:5:11: control.metod: unknown key 'metod'; did you mean 'method'?");
  EXPECT_EQ(Messages(rest + "control: {metod: preview, distnace: 2, speed: {gian: 1}}\n"),
            "test.yaml:5:10: control.method: missing\n"
            "test.yaml:5:11: control.metod: unknown key 'metod'; did you mean 'method'?\n"
            "test.yaml:5:27: control.distnace: unknown key 'distnace'; did you mean 'distance'?\n"
            "test.yaml:5:48: control.speed.gian: unknown key 'gian'; did you mean 'gain'?");
}

TEST(MisspelledKey, IsNamedBesideAMisspelledMethod) {
  const std::string rest = "schema: 1\nname: x\nmission: {speed: 3, waypoints: [[0, 0], [9, 0]]}\n";
  EXPECT_EQ(Messages(rest + "plan: {method: hybrid_star, headingz: 72, qqzzxw: 1}\n"),
            "test.yaml:4:16: plan.method: unknown 'hybrid_star'; did you mean 'hybrid_astar'?\n"
            "test.yaml:4:29: plan.headingz: unknown key 'headingz'; did you mean 'headings'?\n"
            "test.yaml:4:43: plan.qqzzxw: unknown key 'qqzzxw'; no method has this key");
}

}  // namespace
}  // namespace trackbed
