#include "trackbed/falsify/shrink.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

class Shrinker {
 public:
  Shrinker(const SearchSpace& space, double tolerance, const EvaluatePoint& evaluate)
      : space_(space), nominal_(space.nominal()), tolerance_(tolerance), evaluate_(evaluate) {}

  ShrinkResult Run(const UnitPoint& violation) {
    result_.keys.resize(nominal_.size());
    try {
      const Evaluation start = Evaluate(violation);
      TRACKBED_CHECK(start.violated, "the point to shrink does not violate");
      result_.point = violation;
      result_.robustness = start.robustness.value_or(0.0);
      TRACKBED_CHECK(!Evaluate(nominal_).violated, "the nominal point violates");
      do {
        MakeSmaller();
      } while (!MeasureHolds());
      MeasureSensitivity();
      MeasureSingleKeys();
      result_.complete = true;
    } catch (const BudgetExhausted&) {
      // If the budget of runs is exhausted, return the counterexample found so far.
    }
    if (result_.point.empty()) {
      result_.point = violation;
    }
    result_.distance = Distance(result_.point, nominal_);
    return result_;
  }

 private:
  struct BudgetExhausted {};

  Evaluation Evaluate(const UnitPoint& point) {
    const std::optional<Evaluation> evaluation = evaluate_(point);
    if (!evaluation) {
      throw BudgetExhausted();
    }
    return *evaluation;
  }

  /// Runs the scenario at a point. If the run violates an expectation, Take() stores the point as
  /// the new counterexample and returns true.
  bool Take(const UnitPoint& point) {
    const Evaluation evaluation = Evaluate(point);
    if (evaluation.violated) {
      result_.point = point;
      result_.robustness = evaluation.robustness.value_or(0.0);
    }
    return evaluation.violated;
  }

  /// Moves the counterexample toward the point `to`. Bisection on the straight line to `to` finds a
  /// violation as near to `to` as possible.
  void MoveToward(const UnitPoint& to) {
    if (Take(to)) {
      return;
    }
    const UnitPoint from = result_.point;
    const double length = Distance(from, to);
    double violates = 0.0;
    double passes = 1.0;
    while ((passes - violates) * length > tolerance_) {
      const double middle = 0.5 * (violates + passes);
      UnitPoint point(from.size());
      for (std::size_t i = 0; i < from.size(); ++i) {
        point[i] = from[i] == to[i] ? from[i] : from[i] + middle * (to[i] - from[i]);
      }
      (Take(space_.Snap(point)) ? violates : passes) = middle;
    }
  }

  [[nodiscard]] UnitPoint With(std::size_t i, double place) const {
    UnitPoint point = result_.point;
    point[i] = place;
    return point;
  }

  void MakeSmaller() {
    double before = 0.0;
    do {
      before = Distance(result_.point, nominal_);
      MoveToward(nominal_);
      for (std::size_t i = 0; i < nominal_.size(); ++i) {
        if (result_.point[i] != nominal_[i]) {
          MoveToward(With(i, nominal_[i]));
        }
      }
    } while (before - Distance(result_.point, nominal_) > tolerance_);
  }

  [[nodiscard]] double StepOf(std::size_t i) const { return std::max(tolerance_, space_.Step(i)); }

  /// Tests for each key whether the run passes if the key moves one step toward its nominal value.
  /// If the run still violates an expectation after a key has moved, MeasureHolds keeps the moved
  /// value and returns false.
  bool MeasureHolds() {
    for (std::size_t i = 0; i < nominal_.size(); ++i) {
      const double place = result_.point[i];
      if (place == nominal_[i]) {
        continue;
      }
      const double step = std::min(StepOf(i), std::abs(place - nominal_[i]));
      UnitPoint nearer = With(i, place + (place > nominal_[i] ? -step : step));
      nearer = space_.Snap(nearer);
      if (nearer[i] == place || std::abs(nearer[i] - nominal_[i]) < 1e-9) {
        nearer[i] = nominal_[i];
      }
      if (Take(nearer)) {
        return false;
      }
      result_.keys[i].holds_to = nearer[i];
    }
    return true;
  }

  void MeasureSensitivity() {
    for (std::size_t i = 0; i < nominal_.size(); ++i) {
      const double place = result_.point[i];
      const UnitPoint below = space_.Snap(With(i, std::max(0.0, place - StepOf(i))));
      const UnitPoint above = space_.Snap(With(i, std::min(1.0, place + StepOf(i))));
      const std::optional<double> low = Evaluate(below).robustness;
      const std::optional<double> high = Evaluate(above).robustness;
      if (low && high && above[i] > below[i]) {
        result_.keys[i].sensitivity = (*high - *low) / (above[i] - below[i]);
      }
    }
  }

  void MeasureSingleKeys() {
    for (std::size_t i = 0; i < nominal_.size(); ++i) {
      if (nominal_[i] > 0.0) {
        result_.keys[i].down = ReachOf(i, 0.0);
      }
      if (nominal_[i] < 1.0) {
        result_.keys[i].up = ReachOf(i, 1.0);
      }
    }
  }

  SingleKeyReach ReachOf(std::size_t i, double end) {
    const auto passes_at = [&](double place) {
      UnitPoint point = nominal_;
      point[i] = place;
      const Evaluation evaluation = Evaluate(space_.Snap(point));
      return evaluation.robustness && !evaluation.violated;
    };
    if (passes_at(end)) {
      return {.passes = end, .whole_range = true};
    }
    double passes = nominal_[i];
    double fails = end;
    while (std::abs(fails - passes) > tolerance_) {
      const double middle = 0.5 * (passes + fails);
      (passes_at(middle) ? passes : fails) = middle;
    }
    return {.passes = passes, .whole_range = false};
  }

  const SearchSpace& space_;
  const UnitPoint nominal_;
  const double tolerance_;
  const EvaluatePoint& evaluate_;
  ShrinkResult result_;
};

}  // namespace

ShrinkResult Shrink(const SearchSpace& space, const UnitPoint& violation, double tolerance,
                    const EvaluatePoint& evaluate) {
  TRACKBED_REQUIRE(tolerance > 0.0, "Shrink: tolerance {}", tolerance);
  return Shrinker(space, tolerance, evaluate).Run(violation);
}

}  // namespace trackbed
