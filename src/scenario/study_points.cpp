#include "trackbed/scenario/study_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "src/scenario/derived_keys.h"
#include "src/scenario/study_settings.h"
#include "src/scenario/yaml_file.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

// Computes the points of a study. The grid of a study is the Cartesian product of the section
// `list` and the value lists of all varied keys. Grid points are numbered by mixed-radix numbers.
// The lowest digit of a point's number is the index in `list`, followed by the value indices of the
// varied keys, from the last key to the first key. Conditions (`when`) can drop varied keys at some
// points of the grid. If grid points are equal because of dropped keys, only one of the equal
// points is kept. At each grid point, the values of keys with distributions are quantiles at the
// coordinates of a sample of the unit cube (sampling.cpp). Keys that take their values from columns
// of the same CSV file share one coordinate of the sample. The values of derived keys
// (derived_keys.cpp) are computed last, from the values of the other keys. The scenario of a point
// is the base scenario with the point's settings as overrides. Each problem of a study point is
// reported at the line of the study file that causes the problem.
namespace trackbed {
namespace {

/// File name that ParseScenario uses in problems of overrides; a study passes its settings to
/// ParseScenario as overrides.
constexpr const char* kOverride = "--set";

/// If a setting of the study caused `problem`, moves the reported position to the line of that
/// setting in the study file.
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

/// Rejects command line overrides of keys that the study varies, because a run can use only one of
/// the two values for a key.
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

/// Returns whether a condition (`when`) holds at a study point with these settings.
bool Holds(const Condition& condition, const Study& study, const std::vector<Setting>& point) {
  const auto is_key = [&](const Setting& setting) { return setting.key == condition.key; };
  auto found = std::find_if(point.begin(), point.end(), is_key);
  if (found == point.end()) {
    found = std::find_if(study.set.begin(), study.set.end(), is_key);
    if (found == study.set.end()) {
      return false;  // the key to which the condition refers was dropped from this study point
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

}  // namespace

Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected) {
  const std::vector<Setting> all = AllSettings(study, settings, bisected);
  std::vector<Override> overrides;
  const auto add = [&](const Setting& setting) {
    overrides.push_back(fmt::format("{}={}", setting.key, setting.value));
  };
  // Apply the settings in this order: settings of the whole study, of the command line, and of this
  // study point.
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
      settings.push_back(SettingOf(
          variation, Quantile(*variation.distribution, unit_sample_(sample, dimensions_[k]))));
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

}  // namespace trackbed
