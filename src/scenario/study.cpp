#include "trackbed/scenario/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <tuple>

#include "src/scenario/study_settings.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

/// Whose problems ParseScenario ascribes to overrides, which a study's settings are for it.
constexpr const char* kOverride = "--set";

std::string OverrideKey(const Override& override_text) {
  return override_text.substr(0, override_text.find('='));
}

/// A problem of what the study sets, with its place there.
void PlaceInStudy(const Study& study, const std::vector<Setting>& settings, Problem& problem) {
  // The key of an override that cannot be applied is its whole text.
  const std::string key = problem.file == kOverride ? OverrideKey(problem.key) : "";
  for (auto setting = settings.rbegin(); setting != settings.rend(); ++setting) {
    if (!key.empty() && Replaces(setting->key, key)) {
      problem.file = study.file;
      problem.line = setting->line;
      problem.column = setting->column;
      problem.key = key;
      return;
    }
  }
}

/// The problems of many points: those that several have in common once.
class Problems {
 public:
  explicit Problems(const Study& study) : study_(study) {}

  void CountPoint() { ++points_; }

  void Add(const std::vector<Setting>& point, const std::vector<Problem>& problems) {
    for (const Problem& problem : problems) {
      const auto identity = std::tuple(problem.file, problem.key, problem.message);
      const auto [entry, is_new] = known_.try_emplace(identity, found_.size());
      if (is_new) {
        found_.push_back({problem, point});
      }
      found_[entry->second].count += 1;
    }
  }

  void ThrowIfAny() {
    if (found_.empty()) {
      return;
    }
    const auto place = [&](const Found& found) {
      const Problem& problem = found.problem;
      return std::tuple(problem.file != study_.file, problem.line, problem.column);
    };
    std::stable_sort(found_.begin(), found_.end(),
                     [&](const Found& a, const Found& b) { return place(a) < place(b); });
    std::vector<Problem> problems;
    for (Found& found : found_) {
      // Where a problem is not placed at what the point sets, it takes the point to understand it.
      if (found.problem.file != study_.file && found.count < points_) {
        std::string where;
        for (const Setting& setting : found.point) {
          where += fmt::format("{}{}={}", where.empty() ? "" : ", ", setting.key, setting.value);
        }
        found.problem.message += fmt::format(" (with {})", where);
      }
      problems.push_back(found.problem);
    }
    throw InputError(problems);
  }

 private:
  struct Found {
    Problem problem;
    std::vector<Setting> point;  // the first that has it
    std::size_t count = 0;
  };

  const Study& study_;
  std::size_t points_ = 0;
  std::vector<Found> found_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known_;
};

/// The command line must not set what the study varies: one of the two would be lost.
void CheckOverrides(const Study& study) {
  std::vector<Problem> problems;
  for (const Override& override_text : study.overrides) {
    const std::string key = OverrideKey(override_text);
    for (const Setting& setting : Varied(study)) {
      if (Replaces(setting.key, key)) {
        problems.push_back(
            {kOverride, 0, 0, key,
             fmt::format("the study varies {} ({}:{})", setting.key, study.file, setting.line)});
        break;
      }
    }
  }
  if (!problems.empty()) {
    throw InputError(problems);
  }
}

/// Reads one point after the other and gathers what is wrong with them.
class PointsReader {
 public:
  explicit PointsReader(const Study& study) : study_(study), problems_(study) {}

  std::vector<StudyPoint> Read(BadPoints bad_points) {
    for (const std::vector<Setting>& settings : ExpandGrid(study_)) {
      points_.push_back({settings, {}});
      if (!study_.bisect) {
        Try(settings, std::nullopt);
        continue;
      }
      const BisectSpec& bisect = *study_.bisect;
      const bool at_from = Try(settings, bisect.from);
      if (Try(settings, bisect.to) && at_from) {
        // No round number: what is to be bisected must take any.
        Try(settings, bisect.from + 0.3819660112501051 * (bisect.to - bisect.from));
      }
    }
    const bool any_good = std::any_of(points_.begin(), points_.end(), [](const StudyPoint& point) {
      return point.refused.empty();
    });
    if (bad_points == BadPoints::kThrow || !any_good) {
      problems_.ThrowIfAny();
    }
    return std::move(points_);
  }

 private:
  bool Try(const std::vector<Setting>& settings, std::optional<double> bisected) {
    problems_.CountPoint();
    StudyPoint& point = points_.back();
    try {
      Scenario scenario = ReadPoint(study_, settings, bisected);
      if (!bisected || *bisected == study_.bisect->from) {
        point.scenario = std::move(scenario);
      }
      return true;
    } catch (const InputError& error) {
      point.refused = error.problems().front().WithoutPlace();
      std::vector<Setting> own = settings;
      if (bisected) {
        own.push_back({study_.bisect->key, ShortestText(*bisected)});
      }
      problems_.Add(own, error.problems());
      return false;
    }
  }

  const Study& study_;
  Problems problems_;
  std::vector<StudyPoint> points_;
};

}  // namespace

bool Replaces(const std::string& later, const std::string& earlier) {
  const char next = earlier.size() > later.size() ? earlier[later.size()] : '.';
  return earlier.starts_with(later) && (next == '.' || next == '[');
}

std::vector<Setting> AllSettings(const Study& study, const std::vector<Setting>& point,
                                 std::optional<double> bisected) {
  std::vector<Setting> all;
  std::copy_if(
      study.set.begin(), study.set.end(), std::back_inserter(all), [&](const Setting& setting) {
        return std::none_of(
            study.overrides.begin(), study.overrides.end(),
            [&](const Override& text) { return Replaces(OverrideKey(text), setting.key); });
      });
  all.insert(all.end(), point.begin(), point.end());
  if (bisected) {
    const BisectSpec& bisect = *study.bisect;
    all.push_back({bisect.key, ShortestText(*bisected), bisect.line, bisect.column});
  }
  return all;
}

std::vector<Setting> Varied(const Study& study) {
  std::vector<Setting> varied;
  for (const auto& alternatives : study.vary) {
    varied.push_back(alternatives.front());
  }
  for (const auto& point : study.list) {
    varied.insert(varied.end(), point.begin(), point.end());
  }
  if (study.bisect) {
    const BisectSpec& bisect = *study.bisect;
    varied.push_back({bisect.key, "", bisect.line, bisect.column});
  }
  return varied;
}

std::vector<std::vector<Setting>> ExpandGrid(const Study& study) {
  std::vector<std::vector<Setting>> grid(1);
  // Every point so far, with every alternative of what comes next.
  const auto multiply = [&grid](std::size_t alternatives, const auto& add) {
    std::vector<std::vector<Setting>> product;
    for (const std::vector<Setting>& point : grid) {
      for (std::size_t i = 0; i < alternatives; ++i) {
        product.push_back(point);
        add(i, product.back());
      }
    }
    grid = std::move(product);
  };
  for (const auto& alternatives : study.vary) {
    multiply(alternatives.size(),
             [&](std::size_t i, std::vector<Setting>& point) { point.push_back(alternatives[i]); });
  }
  if (!study.list.empty()) {
    multiply(study.list.size(), [&](std::size_t i, std::vector<Setting>& point) {
      point.insert(point.end(), study.list[i].begin(), study.list[i].end());
    });
  }
  return grid;
}

Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected) {
  const std::vector<Setting> all = AllSettings(study, settings, bisected);
  std::vector<Override> overrides;
  const auto add = [&](const Setting& setting) {
    overrides.push_back(fmt::format("{}={}", setting.key, setting.value));
  };
  // What the study sets throughout, then the command line, then what is this point's own.
  const auto own = all.end() - static_cast<std::ptrdiff_t>(settings.size() + (bisected ? 1 : 0));
  std::for_each(all.begin(), own, add);
  overrides.insert(overrides.end(), study.overrides.begin(), study.overrides.end());
  std::for_each(own, all.end(), add);
  try {
    return ParseScenario(study.scenario_text, study.scenario.string(), study.scenario.parent_path(),
                         overrides, study.cameras, study.metrics, study.asset_folders);
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      PlaceInStudy(study, all, problem);
    }
    throw InputError(problems);
  }
}

std::vector<StudyPoint> ReadPoints(const Study& study, BadPoints bad_points) {
  CheckOverrides(study);
  return PointsReader(study).Read(bad_points);
}

std::string CellText(const std::string& value) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc{} && end == value.data() + value.size() ? ShortestText(number) : value;
}

}  // namespace trackbed
