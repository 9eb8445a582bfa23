#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/error_text.h"
#include "trackbed/scenario/keys.h"
#include "trackbed/scenario/scenario.h"

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

/// Checks that a file whose section has `key` with its last letter doubled is refused for this key.
void CheckMisspelling(const KeySection& section, const KeyInfo& key) {
  const std::string wrong = key.name + key.name.back();
  const bool is_known = std::any_of(section.keys.begin(), section.keys.end(),
                                    [&](const KeyInfo& other) { return other.name == wrong; });
  if (is_known) {
    return;
  }
  const std::string method = section.method.empty() ? "" : "method: " + section.method + ", ";
  const OneSection file =
      WriteSection(section.key, section.key.empty() ? wrong + ": 1" : method + wrong + ": 1");
  const std::size_t column = section.key.empty() ? 1 : 3 + method.size();
  const std::string all = Messages(file.yaml);
  SCOPED_TRACE(file.yaml);
  EXPECT_THAT(all, HasSubstr(fmt::format("test.yaml:2:{}: {}: unknown key '{}'; did you mean '",
                                         column, DottedIn(file, wrong), wrong)));
  // Words of fewer than four letters resemble several keys.
  if (key.required && key.name.size() >= 4) {
    EXPECT_THAT(all, HasSubstr(fmt::format("did you mean '{}'?", key.name)));
  }
}

TEST(MisspelledKey, IsNamedInEverySection) {
  std::size_t keys = 0;
  for (const KeySection& section : ScenarioKeys()) {
    for (const KeyInfo& key : section.keys) {
      CheckMisspelling(section, key);
      ++keys;
    }
  }
  EXPECT_GT(keys, 300U);
}

TEST(MisspelledKey, IsNamedBesideAMissingKey) {
  std::size_t required = 0;
  for (const KeySection& section : ScenarioKeys()) {
    for (const KeyInfo& key : section.keys) {
      if (!key.required) {
        continue;
      }
      ++required;
      const std::string method = section.method.empty() ? "" : "method: " + section.method + ", ";
      const OneSection file =
          WriteSection(section.key, section.key.empty() ? "qqzzxw: 1" : method + "qqzzxw: 1");
      const std::size_t column = section.key.empty() ? 1 : 3 + method.size();
      SCOPED_TRACE(file.yaml);
      const std::string all = Messages(file.yaml);
      EXPECT_THAT(all, HasSubstr(fmt::format("test.yaml:2:{}: {}: unknown key 'qqzzxw'; ", column,
                                             DottedIn(file, "qqzzxw"))));
      // Sections inside a section without a method are not read, so their keys are not missed.
      if (key.name == "method" || all.find("method: missing") == std::string::npos) {
        EXPECT_THAT(all, HasSubstr(fmt::format(" {}: missing", DottedIn(file, key.name))));
      }
    }
  }
  EXPECT_GT(required, 30U);
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
