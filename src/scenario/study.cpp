#include "trackbed/scenario/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <tuple>

#include "src/scenario/study_settings.h"
#include "src/scenario/yaml_file.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/optimize/search.h"

// Computes the points of a study. The grid is the Cartesian product of `list` and all lists of
// values. Grid points are numbered by mixed-radix numbers: the lowest digit is the index in `list`,
// followed by the value indices of the varied keys, from the last key to the first key. At some
// points, conditions (`when`) can drop keys. If dropped keys make points equal, only one of the
// equal points is kept. At each grid point, the values of keys with distributions are quantiles at
// the coordinates of a sample of the unit cube (sampling.cpp). Keys that take their values from
// columns of the same CSV file share one coordinate of the sample. The values of derived keys
// (derived_keys.cpp) are computed last, from the values of the other keys. The scenario of a point
// is the base scenario with the point's settings as overrides. Each problem of a point is reported
// at the line of the study file that causes the problem.
namespace trackbed {
namespace {

/// File name that ParseScenario uses in problems of overrides; a study passes its settings to
/// ParseScenario as overrides.
constexpr const char* kOverride = "--set";

std::string OverrideKey(const Override& override_text) {
  return override_text.substr(0, override_text.find('='));
}

/// If a setting of the study caused the problem, changes the position of the problem to the line of
/// that setting.
void PlaceInStudy(const Study& study, const std::vector<Setting>& settings, Problem& problem) {
  // If ParseScenario cannot apply an override, problem.key contains the whole text of the override.
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
      // Append the settings of the point to the message if the problem has no position in the study
      // file.
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
    std::vector<Setting> point;  // settings of the first point that has this problem
    std::size_t count = 0;
  };

  const Study& study_;
  std::size_t points_ = 0;
  std::vector<Found> found_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known_;
};

/// Rejects command line overrides of keys that the study varies, because a run can use only one of
/// the two values.
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

/// Returns whether a condition (`when`) holds at a point with these settings.
bool Holds(const Condition& condition, const Study& study, const std::vector<Setting>& point) {
  const auto is_key = [&](const Setting& setting) { return setting.key == condition.key; };
  auto found = std::find_if(point.begin(), point.end(), is_key);
  if (found == point.end()) {
    found = std::find_if(study.set.begin(), study.set.end(), is_key);
    if (found == study.set.end()) {
      return false;  // the key to which the condition refers was dropped from this point
    }
  }
  return std::any_of(
      condition.values.begin(), condition.values.end(),
      [&](const std::string& value) { return CellText(value) == CellText(found->value); });
}

bool ConditionsHold(const Variation& variation, const Study& study,
                    const std::vector<Setting>& point) {
  return std::all_of(variation.when.begin(), variation.when.end(),
                     [&](const Condition& condition) { return Holds(condition, study, point); });
}

Setting At(const Variation& variation, std::string value) {
  return {variation.key, std::move(value), variation.line, variation.column};
}

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
  for (const Variation& variation : study.vary) {
    varied.push_back(At(variation, ""));
  }
  for (const auto& point : study.list) {
    varied.insert(varied.end(), point.begin(), point.end());
  }
  for (const DerivedKey& derived : study.derive) {
    varied.push_back({derived.key, "", derived.line, derived.column});
  }
  if (study.bisect) {
    const BisectSpec& bisect = *study.bisect;
    varied.push_back({bisect.key, "", bisect.line, bisect.column});
  }
  return varied;
}

Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected) {
  const std::vector<Setting> all = AllSettings(study, settings, bisected);
  std::vector<Override> overrides;
  const auto add = [&](const Setting& setting) {
    overrides.push_back(fmt::format("{}={}", setting.key, setting.value));
  };
  // Apply the settings in this order: settings of the whole study, of the command line, and of this
  // point.
  const auto own = all.end() - static_cast<std::ptrdiff_t>(settings.size() + (bisected ? 1 : 0));
  std::for_each(all.begin(), own, add);
  overrides.insert(overrides.end(), study.overrides.begin(), study.overrides.end());
  std::for_each(own, all.end(), add);
  try {
    return ParseScenario(study.scenario_text, study.scenario.string(), study.scenario.parent_path(),
                         overrides, study.metrics, study.asset_folders);
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      PlaceInStudy(study, all, problem);
    }
    throw InputError(problems);
  }
}

StudyPoints::StudyPoints(Study study) : study_(std::move(study)) {
  CheckOverrides(study_);
  std::map<std::string, int> of_files;
  int sampled = 0;
  for (const Variation& variation : study_.vary) {
    if (!variation.distribution) {
      combinations_ *= variation.alternatives.size();
      dimensions_.push_back(-1);
    } else if (variation.rows_of.empty()) {
      dimensions_.push_back(sampled++);
    } else {
      const auto [known, is_new] = of_files.try_emplace(variation.rows_of, sampled);
      sampled += is_new ? 1 : 0;
      dimensions_.push_back(known->second);
    }
  }
  combinations_ *= std::max<std::size_t>(study_.list.size(), 1);
  if (sampled > 0 && !study_.sample) {
    throw InputError(Problem{.file = study_.file,
                             .key = "sample",
                             .message =
                                 "missing; keys of vary have distributions (trackbed falsify "
                                 "searches them without)"});
  }
  if (study_.sample) {
    unit_sample_ = UnitSample(*study_.sample, sampled);
  }
  const bool any_condition =
      std::any_of(study_.vary.begin(), study_.vary.end(), [](const Variation& variation) {
        return !variation.distribution && !variation.when.empty();
      });
  if (any_condition) {
    KeepDistinctPoints();
  }
}

void StudyPoints::KeepDistinctPoints() {
  std::set<std::string> known;
  for (std::size_t i = 0; i < combinations_; ++i) {
    std::string text;
    for (const Setting& setting : OfGrid(i)) {
      text += fmt::format("{}={}\n", setting.key, setting.value);
    }
    if (known.insert(std::move(text)).second) {
      distinct_.push_back(i);
    }
  }
  combinations_ = distinct_.size();
}

std::size_t StudyPoints::samples() const {
  return study_.sample ? static_cast<std::size_t>(study_.sample->count) : 1;
}

std::vector<Setting> StudyPoints::OfGrid(std::size_t combination) const {
  const auto digit = [&](std::size_t base) {
    const std::size_t value = combination % base;
    combination /= base;
    return value;
  };
  std::vector<Setting> listed;
  if (!study_.list.empty()) {
    listed = study_.list[digit(study_.list.size())];
  }
  // Read the digits of the point number from the last varied key to the first key, because the last
  // key has the lowest digit. The conditions are evaluated in the order of the keys, because a
  // condition of a key can depend only on earlier keys.
  std::vector<std::size_t> chosen(study_.vary.size());
  for (std::size_t k = study_.vary.size(); k-- > 0;) {
    if (!study_.vary[k].distribution) {
      chosen[k] = digit(study_.vary[k].alternatives.size());
    }
  }
  std::vector<Setting> settings;
  for (std::size_t k = 0; k < study_.vary.size(); ++k) {
    const Variation& variation = study_.vary[k];
    if (variation.distribution) {
      continue;
    }
    std::vector<Setting> so_far = settings;
    so_far.insert(so_far.end(), listed.begin(), listed.end());
    if (ConditionsHold(variation, study_, so_far)) {
      settings.push_back(variation.alternatives[chosen[k]]);
    }
  }
  settings.insert(settings.end(), listed.begin(), listed.end());
  return settings;
}

std::vector<Setting> StudyPoints::Settings(std::size_t i) const {
  TRACKBED_REQUIRE(i < size(), "StudyPoints: point {} of {}", i, size());
  const std::size_t combination = i / samples();
  const auto sample = static_cast<Eigen::Index>(i % samples());
  std::vector<Setting> settings = OfGrid(distinct_.empty() ? combination : distinct_[combination]);
  for (std::size_t k = 0; k < study_.vary.size(); ++k) {
    const Variation& variation = study_.vary[k];
    if (variation.distribution && ConditionsHold(variation, study_, settings)) {
      settings.push_back(
          At(variation, Quantile(*variation.distribution, unit_sample_(sample, dimensions_[k]))));
    }
  }
  AddDerived(study_, settings);
  return settings;
}

StudyPoint StudyPoints::Read(std::size_t i) const {
  StudyPoint point;
  try {
    point.settings = Settings(i);
    point.scenario = ReadPoint(study_, point.settings,
                               study_.bisect ? std::optional(study_.bisect->from) : std::nullopt);
  } catch (const InputError& error) {
    point.refused = error.problems().front().WithoutPlace();
  }
  return point;
}

StudyPoint PointWith(const Study& study, std::vector<Setting> settings) {
  StudyPoint point{.settings = std::move(settings), .scenario = {}};
  try {
    AddDerived(study, point.settings);
    point.scenario = ReadPoint(study, point.settings);
  } catch (const InputError& error) {
    point.refused = error.problems().front().WithoutPlace();
  }
  return point;
}

std::optional<double> NumberAt(const Scenario& scenario, const std::string& key) {
  const YAML::Node node = NodeAt(LoadYaml(ResolvedYaml(scenario), "resolved scenario"), key);
  return node.IsScalar() ? NumberOf(node.Scalar()) : std::nullopt;
}

const std::vector<std::string>& StudySearches() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const SampleMethod method :
         {SampleMethod::kRandom, SampleMethod::kLatinHypercube, SampleMethod::kSobol}) {
      all.emplace_back(ToString(method));
    }
    all.emplace_back("surrogate");
    for (const SearchEntry& entry : Searches()) {
      // Leave out SLSQP, which needs gradients: finite differences between runs are too inaccurate
      // for gradients.
      if (entry.method != SearchMethod::kSlsqp) {
        all.emplace_back(entry.name);
      }
    }
    return all;
  }();
  return names;
}

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
  // Returns whether the scenario with these settings is valid.
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
      // Check also a value with many digits between the two bounds, because the bisection tries
      // arbitrary values.
      good = is_valid(settings, bisect.to) && at_from &&
             is_valid(settings, bisect.from + 0.3819660112501051 * (bisect.to - bisect.from));
    }
    any_valid = any_valid || good;
  }
  if (all || !any_valid) {
    problems.ThrowIfAny();
  }
}

std::optional<double> NumberOf(const std::string& value) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc{} && end == value.data() + value.size() ? std::optional(number)
                                                                    : std::nullopt;
}

std::string ToString(const KeepSpec& keep) {
  switch (keep.rows) {
    case KeepSpec::Rows::kNone:
      break;
    case KeepSpec::Rows::kFailed:
      return "failed";
    case KeepSpec::Rows::kAll:
      return "all";
    case KeepSpec::Rows::kHighest:
      return fmt::format("worst {} by {}", keep.count, keep.by);
    case KeepSpec::Rows::kLowest:
      return fmt::format("lowest {} by {}", keep.count, keep.by);
  }
  return "none";
}

std::string CellText(const std::string& value) {
  const std::optional<double> number = NumberOf(value);
  return number ? ShortestText(*number) : value;
}

}  // namespace trackbed
