#include "trackbed/analysis/suite.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <chrono>
#include <mutex>
#include <sstream>

#include "trackbed/analysis/parallel.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

void Drive(const std::function<Scenario(const fs::path&)>& read,
           const std::function<bool()>& interrupted, CarCache& cars, SuiteCase& one) {
  const Scenario scenario = read(one.file);
  one.name = scenario.name;
  const RunResult run = RunScenario(scenario, cars, {.drive = [&](const std::string&) {
                                      return DriveHooks{.interrupted = interrupted};
                                    }});
  one.status = run.interrupted       ? CaseStatus::kInterrupted
               : !run.verdict.judged ? CaseStatus::kNotJudged
               : run.verdict.passed  ? CaseStatus::kPassed
                                     : CaseStatus::kFailed;
  if (!run.interrupted) {
    one.reasons = run.verdict.failures;
    one.notes = run.verdict.notes;
  }
}

void RunCase(const std::function<Scenario(const fs::path&)>& read,
             const std::function<bool()>& interrupted, CarCache& cars, SuiteCase& one) {
  const auto start = std::chrono::steady_clock::now();
  const auto went_wrong = [&](CaseStatus status, const std::exception& error) {
    one.status = status;
    one.reasons = Lines(error.what());
  };
  try {
    Drive(read, interrupted, cars, one);
  } catch (const InputError& error) {
    went_wrong(CaseStatus::kBadInput, error);
  } catch (const RunError& error) {
    went_wrong(CaseStatus::kBadInput, error);
  } catch (const std::exception& error) {
    went_wrong(CaseStatus::kInternalError, error);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  one.wall_time = took.count();
}

/// Reports the results of test cases in the order of the scenario files. A case is reported as soon
/// as that case and all earlier cases have finished.
class OrderedCases {
 public:
  OrderedCases(const std::vector<SuiteCase>& cases,
               const std::function<void(const SuiteCase&)>& report)
      : cases_(cases), report_(report), finished_(cases.size(), false) {}

  void Finished(std::size_t i) {
    const std::lock_guard lock(mutex_);
    finished_[i] = true;
    for (; next_ < cases_.size() && finished_[next_]; ++next_) {
      if (report_) {
        report_(cases_[next_]);
      }
    }
  }

 private:
  const std::vector<SuiteCase>& cases_;
  const std::function<void(const SuiteCase&)>& report_;
  std::mutex mutex_;
  std::vector<bool> finished_;
  std::size_t next_ = 0;
};

/// Replaces characters that XML 1.0 does not allow: most control characters, and invalid UTF-8.
std::string XmlText(const std::string& text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  std::string clean;
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = at;
    const boost::locale::utf::code_point c = Utf8::decode(at, text.end());
    const bool broken = c == boost::locale::utf::illegal || c == boost::locale::utf::incomplete;
    const bool control = c < 0x20 && c != '\t' && c != '\n';
    if (broken) {
      // Skip the remaining bytes of an invalid multibyte character.
      at = std::find_if(begin + 1, text.end(), [](char byte) {
        return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
      });
    }
    if (broken || control || c == 0xFFFE || c == 0xFFFF) {
      clean += '?';
    } else {
      clean.append(begin, at);
    }
  }
  return clean;
}

void SetText(tinyxml2::XMLElement& element, const char* attribute, const std::string& text) {
  element.SetAttribute(attribute, XmlText(text).c_str());
}

std::string Seconds(double time) {
  return fmt::format("{:.3f}", time);
}

/// Adds an XML element that describes why a test case did not pass; adds nothing if the test case
/// passed.
void AddOutcome(tinyxml2::XMLElement& element, const SuiteCase& one) {
  struct Kind {
    const char* element;
    const char* type;
  };
  const Kind kind = [&]() -> Kind {
    switch (one.status) {
      case CaseStatus::kPassed:
        break;
      case CaseStatus::kFailed:
        return {"failure", "expectation"};
      case CaseStatus::kBadInput:
        return {"error", "input"};
      case CaseStatus::kInternalError:
        return {"error", "internal"};
      case CaseStatus::kNotJudged:
      case CaseStatus::kInterrupted:
        return {"skipped", nullptr};
    }
    return {nullptr, nullptr};
  }();
  if (kind.element == nullptr) {
    return;
  }
  tinyxml2::XMLElement& outcome = *element.InsertNewChildElement(kind.element);
  if (one.status == CaseStatus::kInterrupted || one.status == CaseStatus::kNotJudged) {
    SetText(outcome, "message",
            one.status == CaseStatus::kInterrupted ? "interrupted" : "no expectations");
    return;
  }
  SetText(outcome, "message", one.reasons.empty() ? "" : one.reasons.front());
  SetText(outcome, "type", kind.type);
  outcome.SetText(XmlText(fmt::format("{}", fmt::join(one.reasons, "\n"))).c_str());
}

/// Returns the class name by which JUnit reports group test cases, such as "scenarios.studies" for
/// scenarios/studies/x.yaml.
std::string ClassName(const fs::path& file) {
  std::string name;
  for (const fs::path& part : file.lexically_normal().parent_path().relative_path()) {
    if (part != "..") {
      name += name.empty() ? "" : ".";
      name += part.string();
    }
  }
  return name.empty() ? "scenarios" : name;
}

}  // namespace

std::vector<SuiteCase> RunSuite(const std::vector<fs::path>& files,
                                const std::function<Scenario(const fs::path&)>& read,
                                const SuiteOptions& options) {
  TRACKBED_CHECK(options.jobs > 0, "{} jobs", options.jobs);
  std::vector<SuiteCase> cases;
  for (const fs::path& file : files) {
    cases.push_back({.file = file, .name = file.stem().string()});
  }
  OrderedCases ordered(cases, options.finished);
  CarCache cars;
  ForEachIndex(cases.size(), options.jobs, [&](std::size_t i) {
    if (options.interrupted && options.interrupted()) {
      return false;
    }
    RunCase(read, options.interrupted, cars, cases[i]);
    if (cases[i].status == CaseStatus::kInterrupted) {
      return false;
    }
    ordered.Finished(i);
    return true;
  });
  return cases;
}

std::string ToJUnit(const std::vector<SuiteCase>& cases) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration(R"(xml version="1.0" encoding="UTF-8")"));
  tinyxml2::XMLElement& suites = *document.NewElement("testsuites");
  document.InsertEndChild(&suites);
  tinyxml2::XMLElement& suite = *suites.InsertNewChildElement("testsuite");
  const auto count = [&](const std::vector<CaseStatus>& statuses) {
    return static_cast<std::int64_t>(
        std::count_if(cases.begin(), cases.end(), [&](const SuiteCase& one) {
          return std::find(statuses.begin(), statuses.end(), one.status) != statuses.end();
        }));
  };
  double time = 0.0;
  for (const SuiteCase& one : cases) {
    time += one.wall_time;
  }
  for (tinyxml2::XMLElement* whole : {&suites, &suite}) {
    SetText(*whole, "name", "trackbed");
    whole->SetAttribute("tests", static_cast<std::int64_t>(cases.size()));
    whole->SetAttribute("failures", count({CaseStatus::kFailed}));
    whole->SetAttribute("errors", count({CaseStatus::kBadInput, CaseStatus::kInternalError}));
    whole->SetAttribute("skipped", count({CaseStatus::kInterrupted, CaseStatus::kNotJudged}));
    SetText(*whole, "time", Seconds(time));
  }
  for (const SuiteCase& one : cases) {
    tinyxml2::XMLElement& element = *suite.InsertNewChildElement("testcase");
    SetText(element, "name", one.name);
    SetText(element, "classname", ClassName(one.file));
    SetText(element, "file", one.file.string());
    SetText(element, "time", Seconds(one.wall_time));
    AddOutcome(element, one);
    if (!one.notes.empty()) {
      element.InsertNewChildElement("system-out")
          ->SetText(XmlText(fmt::format("{}", fmt::join(one.notes, "\n"))).c_str());
    }
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string JUnitBegin() {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"trackbed\"";
}

}  // namespace trackbed
