#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

namespace trackbed {

/// A point of the unit cube: of each key, its place between the ends of its range.
using UnitPoint = std::vector<double>;

/// A key that is searched.
struct SearchKey {
  std::string key;                                     ///< dotted
  DistributionKind kind = DistributionKind::kUniform;  ///< uniform, log_uniform or integer
  double from = 0.0;
  double to = 1.0;
  double step = 0.0;     ///< values are `from` + k `step`; 0: the key has none
  double nominal = 0.0;  ///< within the range
  int line = 0;          ///< in the study's file
  int column = 0;
};

/// The box in which a study's keys are searched, as the unit cube.
///
/// A place is its share of the range from `from`, of a log_uniform key that of the logarithm.
/// Values are rounded: to whole numbers, to the key's step, otherwise to the decimal step that is a
/// 10 000th to a 1000th of the range, or to five digits where the range is logarithmic; the nominal
/// value and the ends are not.
class SearchSpace {
 public:
  /// `scenario` is that of the study without the keys of `vary`, which tells their nominal values
  /// where the study does not.
  ///
  /// InputError placed in the study: a key without a range (a list of values, a distribution
  /// without ends, a condition), `list`, `repeat` or `bisect`, a nominal value of a key that is not
  /// searched, outside of its range, that is no number, or that nothing tells.
  SearchSpace(const Study& study, const Scenario* scenario);
  /// For tests and programs.
  explicit SearchSpace(std::vector<SearchKey> keys);

  [[nodiscard]] const std::vector<SearchKey>& keys() const { return keys_; }
  [[nodiscard]] const UnitPoint& nominal() const { return nominal_; }

  /// The value of the key `i` at a place in [0, 1].
  [[nodiscard]] double Value(std::size_t i, double place) const;
  /// The nearest point whose values are rounded; Value of it is that of `point`.
  [[nodiscard]] UnitPoint Snap(const UnitPoint& point) const;
  /// The distance between two places of a key whose values differ.
  [[nodiscard]] double Step(std::size_t i) const;
  /// The place below which a share of the key's values lies, in [0, 1): of whole numbers and of
  /// steps all are as likely, the ends among them.
  [[nodiscard]] double PlaceOfShare(std::size_t i, double share) const;
  /// What a scenario there sets.
  [[nodiscard]] std::vector<Setting> Settings(const UnitPoint& point) const;

 private:
  [[nodiscard]] double Place(std::size_t i, double value) const;
  void FindNominal();

  std::vector<SearchKey> keys_;
  UnitPoint nominal_;
};

/// sqrt(sum of squares) of what two points differ by.
double Distance(const UnitPoint& a, const UnitPoint& b);

}  // namespace trackbed
