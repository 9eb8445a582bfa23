#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// A point of the unit cube: the position of each key between the ends of its range.
using UnitPoint = std::vector<double>;

/// A key that is searched.
struct SearchKey {
  std::string key;                                     ///< dotted
  DistributionKind kind = DistributionKind::kUniform;  ///< uniform, log_uniform or integer
  double from = 0.0;
  double to = 1.0;
  double step = 0.0;     ///< values are `from` + k `step`; 0: no step
  double nominal = 0.0;  ///< within the range
  int line = 0;          ///< in the study's file
  int column = 0;
};

/// The box in which a study's keys are searched, as the unit cube.
///
/// A position is the fraction of the range from `from`; for a log_uniform key, of the range of the
/// logarithm. Values are rounded: to integers, to the key's step, else to a decimal step between a
/// 10 000th and a 1000th of the range, or to five digits for logarithmic ranges. The nominal value
/// and the ends are not rounded.
class SearchSpace {
 public:
  /// `scenario` is that of the study without the keys of `vary`. It provides the nominal values
  /// that the study does not set.
  ///
  /// InputError placed in the study for a key without a range (a list of values, a distribution
  /// without ends, a condition); for `list`, `repeat` or `bisect`; and for a nominal value that
  /// belongs to a key that is not searched, lies outside of its range, is not a number, or is set
  /// nowhere.
  SearchSpace(const Study& study, const Scenario* scenario);
  /// For tests and programs.
  explicit SearchSpace(std::vector<SearchKey> keys);

  [[nodiscard]] const std::vector<SearchKey>& keys() const { return keys_; }
  [[nodiscard]] const UnitPoint& nominal() const { return nominal_; }

  /// The value of the key `i` at a position in [0, 1].
  [[nodiscard]] double Value(std::size_t i, double place) const;
  /// The nearest point with rounded values; its Value equals that of `point`.
  [[nodiscard]] UnitPoint Snap(const UnitPoint& point) const;
  /// The distance between two adjacent positions of a key whose values differ.
  [[nodiscard]] double Step(std::size_t i) const;
  /// The position below which a fraction `share`, in [0, 1), of the key's values lies. Integers and
  /// steps, including the ends of the range, are equally likely.
  [[nodiscard]] double PlaceOfShare(std::size_t i, double share) const;
  /// The scenario's settings (keys with values) at a point.
  [[nodiscard]] std::vector<Setting> Settings(const UnitPoint& point) const;

 private:
  [[nodiscard]] double Place(std::size_t i, double value) const;
  void FindNominal();

  std::vector<SearchKey> keys_;
  UnitPoint nominal_;
};

/// The Euclidean distance between two points.
double Distance(const UnitPoint& a, const UnitPoint& b);

}  // namespace trackbed
