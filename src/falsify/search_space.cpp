#include "trackbed/falsify/search_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/study_points.h"

namespace trackbed {
namespace {

/// Rounds `value` to the nearest multiple of the key's step, counted from the start of the key's
/// range, within the range.
double NearestStep(const SearchKey& key, double value) {
  return SteppedValue(key.from, key.step, std::round((value - key.from) / key.step));
}

/// Reads the searched keys of a study and collects problems with their positions in the file.
class SpaceReader {
 public:
  SpaceReader(const Study& study, const Scenario* scenario) : study_(study), scenario_(scenario) {}

  std::vector<SearchKey> Read() {
    if (!study_.list.empty()) {
      AddError(study_.list.front().front(), "a search has no points; leave out `list`");
    }
    if (study_.repeat > 1) {
      problems_.push_back({.file = study_.file,
                           .key = "repeat",
                           .message = "a search runs each point once; leave it out"});
    }
    if (study_.bisect) {
      AddError({"bisect", "", study_.bisect->line, study_.bisect->column},
               "a search has its own limits of the keys; leave it out");
    }
    std::vector<SearchKey> keys;
    for (const Variation& variation : study_.vary) {
      keys.push_back(ReadKey(variation));
    }
    CheckNominalKeys();
    if (!problems_.empty()) {
      throw InputError(problems_);
    }
    return keys;
  }

 private:
  void AddError(const Setting& at, std::string message) {
    problems_.push_back({study_.file, at.line, at.column, at.key, std::move(message)});
  }

  SearchKey ReadKey(const Variation& variation) {
    const Setting at{"vary." + variation.key, "", variation.line, variation.column};
    SearchKey key{.key = variation.key, .line = variation.line, .column = variation.column};
    if (!variation.when.empty()) {
      AddError(at, "a search sets each key at each point; leave out `when`");
    }
    const std::optional<Distribution>& distribution = variation.distribution;
    const bool has_range = distribution && (distribution->kind == DistributionKind::kUniform ||
                                            distribution->kind == DistributionKind::kLogUniform ||
                                            distribution->kind == DistributionKind::kInteger);
    if (!has_range) {
      AddError(at,
               "a search needs a range: {distribution: uniform, from: A, to: B}, log_uniform or "
               "integer");
      return key;
    }
    key.kind = distribution->kind;
    key.from = distribution->from;
    key.to = distribution->to;
    key.step = distribution->step;
    SetNominal(at, key);
    return key;
  }

  void SetNominal(const Setting& at, SearchKey& key) {
    const auto own = std::find_if(study_.nominal.begin(), study_.nominal.end(),
                                  [&](const Setting& setting) { return setting.key == key.key; });
    std::optional<double> value;
    Setting place = at;
    if (own != study_.nominal.end()) {
      place = *own;
      place.key = "nominal." + key.key;
      value = CellNumber(own->value);
      if (!value) {
        AddError(place, fmt::format("'{}' is no number", own->value));
        return;
      }
    } else if (scenario_ != nullptr) {
      value = NumberAt(*scenario_, key.key);
    }
    const char* advice =
        own == study_.nominal.end() ? "; it is the scenario's: give another under `nominal`" : "";
    if (!value) {
      AddError(at, fmt::format("the scenario has no value of {} to start from; give one under "
                               "`nominal`",
                               key.key));
    } else if (!(*value >= key.from && *value <= key.to)) {
      AddError(place, fmt::format("the nominal value {} is outside of the range, {} to {}{}",
                                  *value, key.from, key.to, advice));
    } else if (key.kind == DistributionKind::kInteger && *value != std::floor(*value)) {
      AddError(place, fmt::format("the nominal value {} is no whole number", *value));
    } else if (key.step > 0.0 && *value != NearestStep(key, *value)) {
      AddError(place, fmt::format("the nominal value {} is not {} plus a multiple of the step, {}; "
                                  "the nearest is {}{}",
                                  *value, key.from, key.step, NearestStep(key, *value), advice));
    } else {
      key.nominal = *value;
    }
  }

  void CheckNominalKeys() {
    Names names;
    for (const Variation& variation : study_.vary) {
      names.push_back(variation.key);
    }
    for (const Setting& setting : study_.nominal) {
      if (std::find(names.begin(), names.end(), setting.key) == names.end()) {
        AddError(setting, "is not searched: " + UnknownName(setting.key, names));
      }
    }
  }

  const Study& study_;
  const Scenario* scenario_;
  std::vector<Problem> problems_;
};

/// Returns the exponent e of the step 10^e to which values of a key are rounded.
int DecimalExponent(const SearchKey& key) {
  return static_cast<int>(std::floor(std::log10(1e-3 * (key.to - key.from))));
}

}  // namespace

SearchSpace::SearchSpace(const Study& study, const Scenario* scenario)
    : keys_(SpaceReader(study, scenario).Read()) {
  FindNominal();
}

SearchSpace::SearchSpace(std::vector<SearchKey> keys) : keys_(std::move(keys)) {
  for (const SearchKey& key : keys_) {
    TRACKBED_REQUIRE(key.from < key.to && key.nominal >= key.from && key.nominal <= key.to &&
                         (key.kind != DistributionKind::kLogUniform || key.from > 0.0),
                     "SearchSpace: {} from {} to {}, nominal {}", key.key, key.from, key.to,
                     key.nominal);
  }
  FindNominal();
}

void SearchSpace::FindNominal() {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    nominal_.push_back(Place(i, keys_[i].nominal));
  }
}

double SearchSpace::Place(std::size_t i, double value) const {
  const SearchKey& key = keys_[i];
  const double place = key.kind == DistributionKind::kLogUniform
                           ? std::log(value / key.from) / std::log(key.to / key.from)
                           : (value - key.from) / (key.to - key.from);
  return std::clamp(place, 0.0, 1.0);
}

double SearchSpace::Value(std::size_t i, double place) const {
  const SearchKey& key = keys_[i];
  if (i < nominal_.size() && place == nominal_[i]) {
    return key.nominal;
  }
  if (place <= 0.0 || place >= 1.0) {
    return place <= 0.0 ? key.from : key.to;
  }
  double value = key.from + place * (key.to - key.from);
  if (key.kind == DistributionKind::kInteger) {
    value = std::round(value);
  } else if (key.step > 0.0) {
    value = NearestStep(key, value);
  } else if (key.kind == DistributionKind::kLogUniform) {
    value = key.from * std::pow(key.to / key.from, place);
    value = CellNumber(fmt::format("{:.4e}", value)).value_or(value);
  } else {
    const int exponent = DecimalExponent(key);
    const double coarse = exponent > 0 ? std::pow(10.0, exponent) : 1.0;
    value = coarse * std::round(value / coarse * std::pow(10.0, std::max(0, -exponent))) /
            std::pow(10.0, std::max(0, -exponent));
    value = CellNumber(fmt::format("{:.{}f}", value, std::max(0, -exponent))).value_or(value);
  }
  return std::clamp(value, key.from, key.to);
}

UnitPoint SearchSpace::Snap(const UnitPoint& point) const {
  UnitPoint snapped(point.size());
  for (std::size_t i = 0; i < point.size(); ++i) {
    snapped[i] = Place(i, Value(i, point[i]));
  }
  return snapped;
}

double SearchSpace::Step(std::size_t i) const {
  const SearchKey& key = keys_[i];
  switch (key.kind) {
    case DistributionKind::kInteger:
      return 1.0 / (key.to - key.from);
    case DistributionKind::kLogUniform:
      // Values of a log-uniform key are rounded to about five digits.
      return 1e-4 / std::log(key.to / key.from);
    default:
      if (key.step > 0.0) {
        return key.step / (key.to - key.from);
      }
      return std::pow(10.0, DecimalExponent(key)) / (key.to - key.from);
  }
}

double SearchSpace::PlaceOfShare(std::size_t i, double share) const {
  const SearchKey& key = keys_[i];
  if (key.kind != DistributionKind::kInteger && key.step <= 0.0) {
    return share;
  }
  const double last = std::round(1.0 / Step(i));
  return std::min(std::floor(share * (last + 1.0)), last) / last;
}

std::vector<Setting> SearchSpace::Settings(const UnitPoint& point) const {
  std::vector<Setting> settings;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    settings.push_back(
        {keys_[i].key, ShortestText(Value(i, point[i])), keys_[i].line, keys_[i].column});
  }
  return settings;
}

double Distance(const UnitPoint& a, const UnitPoint& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(sum);
}

}  // namespace trackbed
