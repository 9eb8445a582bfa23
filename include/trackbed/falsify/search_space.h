#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// A point of the unit cube: the position of each key between the ends of its range.
using UnitPoint = std::vector<double>;

/// A key whose value the search varies.
struct SearchKey {
  std::string key;  ///< Dotted key.
  /// Distribution: uniform, log_uniform or integer.
  DistributionKind kind = DistributionKind::kUniform;
  double from = 0.0;
  double to = 1.0;
  double step = 0.0;     ///< Step of the values `from` + k `step`; 0: no step.
  double nominal = 0.0;  ///< Nominal value, within the range.
  int line = 0;          ///< Line in the study's file.
  int column = 0;
};

/// The ranges of a study's searched keys, mapped to the unit cube.
///
/// The position of a key is the fraction of its range, counted from `from`. For a log_uniform key,
/// the position is the fraction of the range of the logarithm. Values are rounded to integers or to
/// the key's step. Values of other keys are rounded to a decimal step between a 10 000th and a
/// 1000th of the range, or to five digits for logarithmic ranges. The nominal value and the ends
/// are not rounded.
class SearchSpace {
 public:
  /// Makes the search space of a study. `scenario` is the study's scenario without the keys of
  /// `vary`. If the study does not set a nominal value, the value of `scenario` is used.
  ///
  /// InputError with a place in the study's file for a key without a range (a list of values, a
  /// distribution without ends, a condition), and for `list`, `repeat` or `bisect`. InputError for
  /// a nominal value that is not a number, is set nowhere, lies outside of the range, or belongs to
  /// a key that is not searched.
  SearchSpace(const Study& study, const Scenario* scenario);
  /// Makes a search space from keys, for tests and programs.
  explicit SearchSpace(std::vector<SearchKey> keys);

  [[nodiscard]] const std::vector<SearchKey>& keys() const { return keys_; }
  [[nodiscard]] const UnitPoint& nominal() const { return nominal_; }

  /// Returns the value of key `i` at a position in [0, 1].
  [[nodiscard]] double Value(std::size_t i, double place) const;
  /// Moves each key of a point to the position of its rounded value. The values of the keys do not
  /// change.
  [[nodiscard]] UnitPoint Snap(const UnitPoint& point) const;
  /// Returns the distance between adjacent positions of key `i` whose rounded values differ.
  [[nodiscard]] double Step(std::size_t i) const;
  /// Returns the position below which a fraction `share`, in [0, 1), of the values of key `i` lies.
  /// All integers and all steps, including the ends of the range, are equally likely.
  [[nodiscard]] double PlaceOfShare(std::size_t i, double share) const;
  /// The keys with their values at a point, as settings of the scenario.
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
