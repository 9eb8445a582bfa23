#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// A point in the unit cube. Each coordinate is the position of one key between the ends of the
/// key's range.
using UnitPoint = std::vector<double>;

/// A key of the scenario whose value is varied by the search.
struct SearchKey {
  std::string key;  ///< Dotted key.
  /// Distribution of the key: uniform, log_uniform or integer.
  DistributionKind kind = DistributionKind::kUniform;
  double from = 0.0;
  double to = 1.0;
  /// Step between the allowed values `from` + k `step`; 0 if all values of the range are allowed.
  double step = 0.0;
  double nominal = 0.0;  ///< Nominal value of the key, within the range.
  int line = 0;          ///< Line number of the key in the study's file.
  int column = 0;
};

/// The ranges of a study's searched keys, scaled to the unit cube.
///
/// The position of a key is its distance from the lower end `from`, as a fraction of the key's
/// range. The position of a log_uniform key is computed from the logarithms of the values. The
/// value of a key is rounded to an integer, or to the nearest value `from` + k `step`. The value of
/// a key that is not an integer and has no step is rounded to a decimal step between a 10 000th and
/// a 1000th of the range. The value of a key with a logarithmic range is rounded to five digits.
/// The nominal value and the ends of the range are not rounded.
class SearchSpace {
 public:
  /// Makes the search space of a study. `scenario` is the study's scenario without the keys of
  /// `vary`. If the study sets no nominal value for a key, the key's value in `scenario` is its
  /// nominal value.
  ///
  /// Throws InputError, with the line in the study's file, if a key has no range (because it has a
  /// list of values, a distribution without ends, or a condition). Also throws InputError if the
  /// study has `list`, `repeat` or `bisect`. Also throws InputError if the nominal value of a
  /// searched key is not a number, is missing, or lies outside of the key's range. Also throws
  /// InputError if the study sets a nominal value for a key that is not searched.
  SearchSpace(const Study& study, const Scenario* scenario);
  /// Makes a search space from a list of keys, for tests and for programs without a study file.
  explicit SearchSpace(std::vector<SearchKey> keys);

  [[nodiscard]] const std::vector<SearchKey>& keys() const { return keys_; }
  [[nodiscard]] const UnitPoint& nominal() const { return nominal_; }

  /// Returns the rounded value of key `i` at the given position in [0, 1] of the key's range.
  [[nodiscard]] double Value(std::size_t i, double place) const;
  /// Moves each coordinate of a point to the exact position of the key's rounded value. Moving the
  /// coordinates does not change the rounded values of the keys.
  [[nodiscard]] UnitPoint Snap(const UnitPoint& point) const;
  /// Returns the smallest distance between two positions of key `i` that have different rounded
  /// values.
  [[nodiscard]] double Step(std::size_t i) const;
  /// Returns the position of the `share` quantile of the values of key `i`; `share` must be in [0,
  /// 1). In the key's distribution, all integers, or all values `from` + k `step`, are equally
  /// likely, including the ends of the range.
  [[nodiscard]] double PlaceOfShare(std::size_t i, double share) const;
  /// Returns the values of all keys at a point, as settings of the scenario.
  [[nodiscard]] std::vector<Setting> Settings(const UnitPoint& point) const;

 private:
  [[nodiscard]] double Place(std::size_t i, double value) const;
  void FindNominal();

  std::vector<SearchKey> keys_;
  UnitPoint nominal_;
};

/// Returns the Euclidean distance between two points of the unit cube.
double Distance(const UnitPoint& a, const UnitPoint& b);

}  // namespace trackbed
