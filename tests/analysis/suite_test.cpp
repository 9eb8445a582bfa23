#include "trackbed/analysis/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <set>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace suite_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::MatchesRegex;
using testing::StartsWith;

const char* const kCorner =
    "schema: 1\nname: {}\nmission: {{speed: 3, waypoints: [[0, 0], [30, 0], [30, 30]]}}\n"
    "plan: {{method: fillet}}\ndrive: {{plants: [kinematic]}}\nexpect: {{{}}}\n";

std::string Corner(const std::string& name, const std::string& expect) {
  return fmt::format(fmt::runtime(kCorner), name, expect);
}

Scenario Read(const fs::path& file) {
  return ReadScenario(file);
}

/// One file of each kind, in this order.
std::vector<fs::path> FilesOfEveryKind(const TempFolder& folder) {
  return {folder.Write("s/good.yaml", Corner("good", "reach_goal: 0.5")),
          folder.Write("s/far.yaml", Corner("far", "reach_goal: 0, max_cross_track: 0.0001")),
          folder.Write("s/bad.yaml", "schema: 1\nname: bad\nmission: {sped: 3}\n"),
          folder.path() / "s/none.yaml"};
}

TEST(RunSuite, JudgesEachFileWhateverIsWrongWithOthers) {
  const TempFolder folder;
  std::vector<SuiteCase> cases = RunSuite(FilesOfEveryKind(folder), Read, {});
  ASSERT_EQ(cases.size(), 4U);
  EXPECT_EQ(cases[0].status, CaseStatus::kPassed);
  EXPECT_EQ(cases[0].name, "good");
  EXPECT_THAT(cases[0].reasons, testing::IsEmpty());
  EXPECT_GT(cases[0].wall_time, 0.0);
  EXPECT_EQ(cases[1].status, CaseStatus::kFailed);
  EXPECT_THAT(
      cases[1].reasons,
      ElementsAre(MatchesRegex("kinematic: distance to the goal [0-9.e-]+ m exceeds 0 m at .*"),
                  MatchesRegex("kinematic: maximum cross-track error 0\\.[0-9]+ m exceeds "
                               "0\\.0001 m at .*")));
  EXPECT_EQ(cases[2].status, CaseStatus::kBadInput);
  EXPECT_EQ(cases[2].name, "bad");
  EXPECT_THAT(cases[2].reasons, testing::SizeIs(3));  // the reader's errors, one line each
  EXPECT_EQ(cases[3].status, CaseStatus::kBadInput);
  EXPECT_THAT(cases[3].reasons,
              ElementsAre("cannot read " + cases[3].file.string() + ": No such file or directory"));
}

TEST(RunSuite, ABugIsThatOfItsCase) {
  const std::vector<SuiteCase> cases = RunSuite(
      {"a.yaml", "b.yaml"},
      [](const fs::path& file) -> Scenario { throw InternalError("broken by " + file.string()); },
      {});
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[1].status, CaseStatus::kInternalError);
  EXPECT_THAT(cases[1].reasons, ElementsAre("broken by b.yaml"));
  EXPECT_THROW(RunSuite({}, Read, {.jobs = 0}), InternalError);
}

TEST(RunSuite, TellsInTheOrderOfTheFilesForAnyNumberOfJobs) {
  const TempFolder folder;
  std::vector<fs::path> files;
  for (int i = 0; i < 6; ++i) {
    // The first cases take longest.
    const std::string name = fmt::format("c{}", i);
    files.push_back(folder.Write(
        name + ".yaml", fmt::format("schema: 1\nname: {}\nmission: {{duration: {}, speed: 3}}\n"
                                    "control: {{method: constant_steering, steering: 0.1}}\n"
                                    "drive: {{plants: [kinematic]}}\n"
                                    "expect: {{metrics: [{{metric: time, min: 1}}]}}\n",
                                    name, i == 0 ? 500 : 1)));
  }
  for (const int jobs : {1, 4}) {
    std::vector<std::string> told;
    const std::vector<SuiteCase> cases =
        RunSuite(files, Read, {.jobs = jobs, .finished = [&](const SuiteCase& one) {
                                 EXPECT_EQ(one.status, CaseStatus::kPassed)
                                     << testing::PrintToString(one.reasons);
                                 told.push_back(one.name);
                               }});
    EXPECT_THAT(told, ElementsAre("c0", "c1", "c2", "c3", "c4", "c5"));
    EXPECT_EQ(cases.back().name, "c5");
  }
}

TEST(RunSuite, LeavesTheRestInterrupted) {
  const TempFolder folder;
  const std::vector<fs::path> files{folder.Write("a.yaml", Corner("a", "")),
                                    folder.Write("b.yaml", Corner("b", ""))};
  bool stop = false;
  const std::vector<SuiteCase> cases = RunSuite(
      files, Read,
      {.finished = [&](const SuiteCase&) { stop = true; }, .interrupted = [&] { return stop; }});
  EXPECT_EQ(cases[0].status, CaseStatus::kPassed);
  EXPECT_EQ(cases[1].status, CaseStatus::kInterrupted);
  int asked = 0;
  const std::vector<SuiteCase> cut =
      RunSuite(files, Read, {.interrupted = [&] { return ++asked > 100; }});
  EXPECT_EQ(cut[0].status, CaseStatus::kInterrupted);
  EXPECT_EQ(cut[1].status, CaseStatus::kInterrupted);
}

/// Reads a JUnit file.
class JUnit {
 public:
  explicit JUnit(const std::vector<SuiteCase>& cases) {
    const std::string text = ToJUnit(cases);
    EXPECT_THAT(text, StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>"));
    EXPECT_EQ(document_.Parse(text.data(), text.size()), tinyxml2::XML_SUCCESS);
  }

  [[nodiscard]] const tinyxml2::XMLElement& suites() const { return *document_.RootElement(); }
  [[nodiscard]] const tinyxml2::XMLElement& suite() const {
    return *suites().FirstChildElement("testsuite");
  }
  [[nodiscard]] const tinyxml2::XMLElement& test(int i) const {
    const tinyxml2::XMLElement* one = suite().FirstChildElement("testcase");
    for (; i > 0; --i) {
      one = one->NextSiblingElement("testcase");
    }
    return *one;
  }

 private:
  tinyxml2::XMLDocument document_;
};

std::set<std::string> AttributeNames(const tinyxml2::XMLElement& element) {
  std::set<std::string> names;
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    names.insert(a->Name());
  }
  return names;
}

std::vector<SuiteCase> CasesOfEveryKind() {
  return {{.file = "/abs/dir.d/good.yaml",
           .name = "good",
           .status = CaseStatus::kPassed,
           .notes = {"steering limited", "wind < 3"},
           .wall_time = 1.25},
          {.file = "s/far.yaml",
           .name = "far",
           .status = CaseStatus::kFailed,
           .reasons = {"kinematic: \"x\" & <y> at most 1", "second"},
           .wall_time = 0.5},
          {.file = "s/bad.yaml",
           .name = "bad",
           .status = CaseStatus::kBadInput,
           .reasons = {"key \x01 caf\xC3\xA9 \xE2\x82 \xFF\xC3\xA9."}},
          {.file = "../bug.yaml",
           .name = "bug",
           .status = CaseStatus::kInternalError,
           .reasons = {"broken"}},
          {.file = "rest.yaml", .name = "rest"}};
}

TEST(JUnit, HasTheAttributesThatJenkinsAndGitLabRead) {
  const JUnit xml(CasesOfEveryKind());
  EXPECT_STREQ(xml.suites().Name(), "testsuites");
  EXPECT_EQ(xml.suite().NextSiblingElement(), nullptr);
  for (const tinyxml2::XMLElement* whole : {&xml.suites(), &xml.suite()}) {
    EXPECT_EQ(AttributeNames(*whole),
              (std::set<std::string>{"name", "tests", "failures", "errors", "skipped", "time"}));
    EXPECT_STREQ(whole->Attribute("name"), "trackbed");
    EXPECT_STREQ(whole->Attribute("time"), "1.750");
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(AttributeNames(xml.test(i)),
              (std::set<std::string>{"name", "classname", "file", "time"}));
  }
  EXPECT_STREQ(xml.test(0).Attribute("name"), "good");
  EXPECT_STREQ(xml.test(0).Attribute("classname"), "abs.dir.d");
  EXPECT_STREQ(xml.test(0).Attribute("file"), "/abs/dir.d/good.yaml");
  EXPECT_STREQ(xml.test(0).Attribute("time"), "1.250");
  EXPECT_STREQ(xml.test(1).Attribute("classname"), "s");
  EXPECT_STREQ(xml.test(3).Attribute("classname"), "scenarios");
  EXPECT_STREQ(xml.test(4).Attribute("classname"), "scenarios");
}

TEST(JUnit, CountsWhatItHolds) {
  const JUnit xml(CasesOfEveryKind());
  int tests = 0;
  int failures = 0;
  int errors = 0;
  int skipped = 0;
  for (const auto* test = xml.suite().FirstChildElement("testcase"); test != nullptr;
       test = test->NextSiblingElement("testcase")) {
    ++tests;
    failures += test->FirstChildElement("failure") != nullptr ? 1 : 0;
    errors += test->FirstChildElement("error") != nullptr ? 1 : 0;
    skipped += test->FirstChildElement("skipped") != nullptr ? 1 : 0;
  }
  EXPECT_EQ(tests, 5);
  for (const tinyxml2::XMLElement* whole : {&xml.suites(), &xml.suite()}) {
    EXPECT_EQ(whole->IntAttribute("tests"), tests);
    EXPECT_EQ(whole->IntAttribute("failures"), failures);
    EXPECT_EQ(whole->IntAttribute("errors"), errors);
    EXPECT_EQ(whole->IntAttribute("skipped"), skipped);
  }
  EXPECT_EQ(failures, 1);
  EXPECT_EQ(errors, 2);
  EXPECT_EQ(skipped, 1);
}

TEST(JUnit, SaysWhy) {
  const JUnit xml(CasesOfEveryKind());
  EXPECT_STREQ(xml.test(0).FirstChildElement()->Name(), "system-out");
  EXPECT_STREQ(xml.test(0).FirstChildElement()->GetText(), "steering limited\nwind < 3");
  const auto* failure = xml.test(1).FirstChildElement("failure");
  EXPECT_STREQ(failure->Attribute("message"), "kinematic: \"x\" & <y> at most 1");
  EXPECT_STREQ(failure->Attribute("type"), "expectation");
  EXPECT_STREQ(failure->GetText(), "kinematic: \"x\" & <y> at most 1\nsecond");
  EXPECT_EQ(failure->NextSiblingElement(), nullptr);
  const auto* error = xml.test(2).FirstChildElement("error");
  // A control character, a truncated character and an invalid start byte are each replaced by one
  // '?'.
  EXPECT_STREQ(error->Attribute("message"), "key ? caf\xC3\xA9 ? ?\xC3\xA9.");
  EXPECT_STREQ(error->Attribute("type"), "input");
  EXPECT_STREQ(xml.test(3).FirstChildElement("error")->Attribute("type"), "internal");
  EXPECT_STREQ(xml.test(4).FirstChildElement("skipped")->Attribute("message"), "interrupted");
}

}  // namespace suite_test
}  // namespace trackbed
