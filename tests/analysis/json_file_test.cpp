#include "trackbed/analysis/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <tuple>

#include "tests/support/temp_folder.h"

namespace trackbed {
namespace {

/// The error of reading a file with this text, without the name of the file in front.
class JsonFile : public testing::Test {
 protected:
  std::string ErrorMessage(
      const std::string& text,
      const std::function<void(const JsonValue&)>& read = [](const JsonValue&) {}) {
    const std::filesystem::path file = folder_.Write("a.json", text);
    try {
      read(ReadJson(file));
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

TEST_F(JsonFile, GivesItsValuesWithTheirTypes) {
  const JsonValue json = ReadJson(folder_.Write(
      "a.json",
      R"({"n": 7, "x": -1.5, "t": "a", "f": true, "nothing": null, "l": ["b", "c"], "s": {"k": 2}})"));
  EXPECT_EQ(json.At("n").Count(), 7U);
  EXPECT_EQ(json.At("n").Number(), 7.0);
  EXPECT_EQ(json.At("x").Number(), -1.5);
  EXPECT_EQ(json.At("t").Text(), "a");
  EXPECT_EQ(json.At("t").OneOf({"b", "a"}), "a");
  EXPECT_TRUE(json.At("f").Flag());
  EXPECT_TRUE(json.At("nothing").IsNull());
  EXPECT_EQ(json.At("nothing").NumberOrNull(), std::nullopt);
  EXPECT_EQ(json.At("x").NumberOrNull(), -1.5);
  EXPECT_THAT(json.At("l").Texts(), testing::ElementsAre("b", "c"));
  EXPECT_EQ(json.At("l").Elements(2)[1].Text(), "c");
  EXPECT_EQ(json.At("s").At("k").Scalar(), 2);
  EXPECT_EQ(json.At("s").Scalars(), nlohmann::ordered_json({{"k", 2}}));
  EXPECT_FALSE(json.Find("absent"));
}

TEST_F(JsonFile, KeepsTheOrderOfItsKeys) {
  std::vector<std::string> keys;
  for (const auto& [key, value] :
       ReadJson(folder_.Write("a.json", R"({"b": 1, "a": 2})")).Members()) {
    keys.push_back(key);
  }
  EXPECT_THAT(keys, testing::ElementsAre("b", "a"));
}

TEST_F(JsonFile, NamesTheKeyTheValueAndWhatIsAllowed) {
  const auto deep = [](const JsonValue& json) {
    std::ignore = json.At("pairs").Elements().at(0).At("max");
  };
  const std::string end = "; not as Trackbed writes it";
  EXPECT_EQ(ErrorMessage("{}", deep), "pairs: missing" + end);
  EXPECT_EQ(ErrorMessage(R"({"pairs": [{}]})", deep), "pairs[0].max: missing" + end);
  EXPECT_EQ(ErrorMessage(R"({"pairs": {}})", deep),
            "pairs: expected a list, found a section" + end);
  EXPECT_EQ(ErrorMessage(R"({"pairs": [[1, 2]]})", deep),
            "pairs[0]: expected a section, found a list of 2" + end);
  const auto message = [&](const std::string& value, const auto& read) {
    return ErrorMessage("{\"k\": " + value + "}",
                        [&](const JsonValue& json) { read(json.At("k")); });
  };
  EXPECT_EQ(message("\"x\"", [](const JsonValue& k) { std::ignore = k.Number(); }),
            "k: expected a number, found \"x\"" + end);
  EXPECT_EQ(message("true", [](const JsonValue& k) { std::ignore = k.NumberOrNull(); }),
            "k: expected a number or null, found true" + end);
  EXPECT_EQ(message("null", [](const JsonValue& k) { std::ignore = k.Text(); }),
            "k: expected a text, found null" + end);
  EXPECT_EQ(message("1", [](const JsonValue& k) { std::ignore = k.Flag(); }),
            "k: expected true or false, found 1" + end);
  EXPECT_EQ(message("[]", [](const JsonValue& k) { std::ignore = k.Scalar(); }),
            "k: expected a single value, found a list of 0" + end);
  EXPECT_EQ(message("[\"a\", 2]", [](const JsonValue& k) { std::ignore = k.Texts(); }),
            "k[1]: expected a text, found 2" + end);
  EXPECT_EQ(message("{\"a\": {}}", [](const JsonValue& k) { std::ignore = k.Scalars(); }),
            "k.a: expected a single value, found a section" + end);
  EXPECT_EQ(message("\"z\"",
                    [](const JsonValue& k) {
                      std::ignore = k.OneOf({"x", "y"});
                    }),
            "k: expected one of x, y, found \"z\"" + end);
  EXPECT_EQ(message("[1]", [](const JsonValue& k) { std::ignore = k.Elements(2); }),
            "k: expected a list of 2, found a list of 1" + end);
}

TEST_F(JsonFile, CountsWholeNumbersOnly) {
  const auto message = [&](const std::string& value) {
    return ErrorMessage("{\"k\": " + value + "}",
                        [](const JsonValue& json) { std::ignore = json.At("k").Count(100); });
  };
  EXPECT_EQ(message("0"), "no error");
  EXPECT_EQ(message("100"), "no error");
  for (const char* value :
       {"101", "-1", "1.5", "1e300", "-1e300", "18446744073709551615", "-9223372036854775808",
        "18446744073709551616", "2.0", "\"7\"", "null", "[7]"}) {
    EXPECT_THAT(message(value), testing::HasSubstr("expected a whole number from 0 to 100, found "))
        << value;
  }
}

TEST_F(JsonFile, CutsLongTexts) {
  const std::string message =
      ErrorMessage("{\"k\": \"" + std::string(1000, 'a') + "\"}",
                   [](const JsonValue& json) { std::ignore = json.At("k").Number(); });
  EXPECT_LT(message.size(), 200U);
}

TEST_F(JsonFile, PlacesWhatIsNotJson) {
  EXPECT_THAT(ErrorMessage("{"), testing::StartsWith("1:2: not JSON: syntax error"));
  EXPECT_THAT(ErrorMessage("{\"a\": 1,\n\"b\": x}"),
              testing::StartsWith("2:6: not JSON: syntax error while parsing value"));
  EXPECT_THAT(ErrorMessage("{\"a\": \"\xff\"}"), testing::HasSubstr("ill-formed UTF-8"));
  EXPECT_THAT(ErrorMessage(""), testing::HasSubstr("not JSON"));
  EXPECT_THAT(ErrorMessage("{\"a\": NaN}"), testing::HasSubstr("not JSON"));
  EXPECT_THAT(ErrorMessage("{\"a\": 1e999}"), testing::HasSubstr("not JSON"));
}

// A parser that calls itself for each level would overflow the stack.
TEST_F(JsonFile, RefusesWhatIsNestedDeeply) {
  EXPECT_EQ(ErrorMessage(std::string(1'000'000, '[')), "nested deeper than 64 levels");
  EXPECT_EQ(ErrorMessage("{\"number\": 1, \"deep\": " + std::string(63, '[') +
                         std::string(63, ']') + "}"),
            "no error");
}

TEST_F(JsonFile, IsMissedByName) {
  const std::filesystem::path file = folder_.path() / "gone.json";
  try {
    ReadJson(file);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file.string() + ": missing from the run folder");
  }
}

TEST_F(JsonFile, OutlivesItsRoot) {
  std::optional<JsonValue> value;
  { value = ReadJson(folder_.Write("a.json", R"({"a": [{"b": "text"}]})")).At("a").Elements()[0]; }
  EXPECT_EQ(value->At("b").Text(), "text");
}

TEST_F(JsonFile, HasTheConesOfItsGates) {
  const auto cones_in = [&](const std::string& plan) {
    return GateCones(ReadJson(folder_.Write("plan.json", plan)));
  };
  EXPECT_THAT(cones_in("{}"), testing::IsEmpty());
  EXPECT_THAT(cones_in(R"({"gates": [{"cones_m": [[1, 2], [3, 4.5]]}, {"cones_m": [[-5, 6]]}]})"),
              testing::ElementsAre(testing::ElementsAre(Vec2(1.0, 2.0), Vec2(3.0, 4.5)),
                                   testing::ElementsAre(Vec2(-5.0, 6.0))));
  EXPECT_THROW(cones_in(R"({"gates": [{}]})"), InputError);
  EXPECT_THROW(cones_in(R"({"gates": {}})"), InputError);
  EXPECT_THROW(cones_in(R"({"gates": [{"cones_m": [[1]]}]})"), InputError);
  EXPECT_THROW(cones_in(R"({"gates": [{"cones_m": [[1, "2"]]}]})"), InputError);
}

}  // namespace
}  // namespace trackbed
