#include "trackbed/analysis/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

int NumberIn(const ordered_json& json) {
  return json.at("number").get<int>();
}

class JsonFile : public testing::Test {
 protected:
  /// The error of reading NumberIn the text, without the name of the file in front, but with line
  /// and column.
  std::string ErrorMessage(const std::string& text, const Problem& problem = {}) {
    const std::filesystem::path file = folder_.Write("a.json", text);
    try {
      ReadJson(file, NumberIn, problem);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with(file.string() + ":")) << what;
      const std::string rest = what.substr(file.string().size() + 1);
      return rest.substr(rest.starts_with(' ') ? 1 : 0);
    }
    return "no error";
  }

  TempFolder folder_;
};

TEST_F(JsonFile, GivesWhatIsReadFromIt) {
  EXPECT_EQ(ReadJson(folder_.Write("a.json", R"({"number": 7})"), NumberIn), 7);
}

TEST_F(JsonFile, KeepsTheOrderOfItsKeys) {
  std::vector<std::string> keys;
  VisitJson(folder_.Write("a.json", R"({"b": 1, "a": 2})"), [&](const ordered_json& json) {
    for (const auto& item : json.items()) {
      keys.push_back(item.key());
    }
  });
  EXPECT_THAT(keys, testing::ElementsAre("b", "a"));
}

TEST_F(JsonFile, NamesItselfWhenItIsNotAsExpected) {
  EXPECT_EQ(ErrorMessage("{}"), "not as Trackbed writes it: key 'number' not found");
  EXPECT_EQ(ErrorMessage(R"({"number": "x"})"),
            "not as Trackbed writes it: type must be number, but is string");
}

TEST_F(JsonFile, PlacesWhatIsNotJson) {
  EXPECT_THAT(ErrorMessage("{"), testing::StartsWith("1:2: not JSON: syntax error"));
  EXPECT_THAT(ErrorMessage("{\"a\": 1,\n\"b\": x}"),
              testing::StartsWith("2:6: not JSON: syntax error while parsing value"));
  EXPECT_THAT(ErrorMessage("{\"a\": \"\xff\"}"), testing::HasSubstr("ill-formed UTF-8"));
}

// A parser that calls itself for each level would overflow the stack.
TEST_F(JsonFile, RefusesWhatIsNestedDeeply) {
  EXPECT_EQ(ErrorMessage(std::string(1'000'000, '[')), "nested deeper than 64 levels");
  EXPECT_EQ(ErrorMessage("{\"number\": 1, \"deep\": " + std::string(63, '[') +
                         std::string(63, ']') + "}"),
            "no error");
}

TEST_F(JsonFile, SaysWhatItsReaderKnows) {
  EXPECT_THAT(ErrorMessage("{}", {.key = "number"}),
              testing::StartsWith("number: not as Trackbed writes it"));
  EXPECT_EQ(ErrorMessage("{}", {.message = "not the metrics of a run"}),
            "not the metrics of a run");
}

TEST_F(JsonFile, IsMissedByName) {
  const std::filesystem::path file = folder_.path() / "gone.json";
  try {
    ReadJson(file, NumberIn, {.key = "number", .message = "x"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file.string() + ": missing from the run folder");
  }
}

TEST_F(JsonFile, LetsOtherErrorsPass) {
  const std::filesystem::path file = folder_.Write("a.json", "{}");
  const auto refuse = [](const ordered_json&) { throw RunError("full"); };
  EXPECT_THROW(VisitJson(file, refuse, {.message = "x"}), RunError);
}

TEST_F(JsonFile, HasTheConesOfItsGates) {
  const auto cones_in = [&](const std::string& plan) {
    return ReadJson(folder_.Write("plan.json", plan), GateCones);
  };
  EXPECT_THAT(cones_in("{}"), testing::IsEmpty());
  EXPECT_THAT(cones_in(R"({"gates": [{"cones_m": [[1, 2], [3, 4.5]]}, {"cones_m": [[-5, 6]]}]})"),
              testing::ElementsAre(Vec2(1.0, 2.0), Vec2(3.0, 4.5), Vec2(-5.0, 6.0)));
  EXPECT_THROW(cones_in(R"({"gates": [{}]})"), InputError);
  EXPECT_THROW(cones_in(R"({"gates": [{"cones_m": [[1]]}]})"), InputError);
}

}  // namespace
}  // namespace trackbed
