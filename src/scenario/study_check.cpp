#include "trackbed/scenario/study_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "src/scenario/study_settings.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

/// Collects the problems of many points of a study and reports each problem only once.
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
      // Append the settings of the study point to the message if the problem has no position in the
      // study file.
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
    std::vector<Setting> point;  // settings of the first study point that has the problem
    std::size_t count = 0;
  };

  const Study& study_;
  std::size_t points_ = 0;
  std::vector<Found> found_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known_;
};

}  // namespace

std::vector<std::size_t> PointsToCheck(const StudyPoints& points) {
  constexpr std::size_t kMaxCheckedPoints = 1000;
  const std::size_t count = std::min(points.size(), kMaxCheckedPoints);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    chosen.push_back(count == 1 ? 0 : k * (points.size() - 1) / (count - 1));
  }
  return chosen;
}

void CheckPoints(const StudyPoints& points, bool all) {
  const Study& study = points.study();
  Problems problems(study);
  bool any_valid = false;
  // Returns whether the scenario of the study is valid with the given settings.
  const auto is_valid = [&](const std::vector<Setting>& settings, std::optional<double> bisected) {
    problems.CountPoint();
    try {
      ReadPoint(study, settings, bisected);
      return true;
    } catch (const InputError& error) {
      std::vector<Setting> own = settings;
      if (bisected) {
        own.push_back({study.bisect->key, ShortestText(*bisected)});
      }
      problems.Add(own, error.problems());
      return false;
    }
  };
  for (const std::size_t i : PointsToCheck(points)) {
    std::vector<Setting> settings;
    try {
      settings = points.Settings(i);
    } catch (const InputError& error) {
      problems.CountPoint();
      problems.Add({}, error.problems());
      continue;
    }
    bool good = false;
    if (!study.bisect) {
      good = is_valid(settings, std::nullopt);
    } else {
      const BisectSpec& bisect = *study.bisect;
      const bool at_from = is_valid(settings, bisect.from);
      // Check also a value with many digits between the bounds of the bisected key, because the
      // bisection tries arbitrary values.
      good = is_valid(settings, bisect.to) && at_from &&
             is_valid(settings, bisect.from + 0.3819660112501051 * (bisect.to - bisect.from));
    }
    any_valid = any_valid || good;
  }
  if (all || !any_valid) {
    problems.ThrowIfAny();
  }
}

}  // namespace trackbed
