#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "src/planning/racing/ggv_cuts.h"
#include "src/planning/racing/lap_model.h"
#include "src/planning/racing/line_shape.h"
#include "trackbed/optimize/sparse_quadratic_program.h"

/// Quadratic programs whose solutions reduce the lap time.
namespace trackbed {

/// Trust region of a quadratic program, given as the largest permitted changes in a step.
struct LapTrust {
  double offset = 1.0;   ///< Largest change of the offset d at a station [m].
  double squared = 0.3;  ///< Largest relative change of the squared speed at a station.
};

/// Builds the quadratic program linearized about each lap of the search.
///
/// The first variables are the changes of the line's spline coefficients [m]. The remaining
/// variables are the relative changes of the squared speeds. The tyres limit the curvature to kappa
/// <= a/w, where a is the largest lateral acceleration and w the squared speed. If the tyre limit
/// is active, the program replaces a/w by its linearization about w_0: kappa <= a/w_0 (1 - (w -
/// w_0)/w_0). As this linearization never exceeds a/w, a step satisfies the tyre limit, except for
/// the linearization error of the curvature.
class LapProgram {
 public:
  LapProgram(const LapModel& model, const ClosedSplineBasis& basis,
             std::vector<OffsetBounds> bounds);

  [[nodiscard]] Eigen::Index coefficients() const {
    return static_cast<Eigen::Index>(basis_.count());
  }

  /// Builds the quadratic program that is linearized about a lap along `line`. Where the curvature
  /// exceeds LapLimits::curvature_max, the program does not let the curvature grow. The program
  /// always has solutions, because the lap itself meets all constraints.
  SparseQuadraticProgram About(const TrackLine& line, const Lap& lap, const LapTrust& trust);

  /// Stores the Lagrange multipliers of the last quadratic program. The next quadratic program uses
  /// these multipliers as weights for the curvature of the g-g-v boundary, which tangents neglect.
  void TakeMultipliers(const Eigen::VectorXd& multipliers);

 private:
  /// A linear function of the variables of the program.
  struct Form {
    std::vector<std::pair<Eigen::Index, double>> terms{};
    void Add(Eigen::Index variable, double factor) { terms.emplace_back(variable, factor); }
    void Add(const Form& other, double factor);
  };

  /// Decreases of the lap time per unit of additional tyre force in an interval. The first index
  /// selects the end of the interval whose limits apply; the second index selects driving or
  /// braking.
  using Prices = std::array<std::array<double, 2>, 2>;
  /// Row of a quadratic program that represents a tangent to the g-g-v boundary.
  struct TangentRow {
    Eigen::Index row = 0;
    std::size_t interval = 0;
    std::size_t end = 0;
    GgvSide side{};
  };

  [[nodiscard]] Eigen::Index SpeedVariable(std::size_t i) const {
    return coefficients() + static_cast<Eigen::Index>(i);
  }
  [[nodiscard]] Form OffsetForm(std::size_t i, const Eigen::Vector3d& by) const;
  void Linearize(const Lap& lap);
  void AddRow(const Form& form, double lower, double upper);
  void AddTime(const Lap& lap);
  void AddBounds(const TrackLine& line, const Lap& lap, const LapTrust& trust);
  void AddCurvatures(const Lap& lap);
  void AddSteering(const Lap& lap, std::size_t i);
  void AddLateral(const Lap& lap, std::size_t i);
  void AddTyres(const Lap& lap, std::size_t i, GgvSide side);
  void AddForces(const Lap& lap, std::size_t i, GgvSide side);
  bool AddCut(const Lap& lap, std::size_t at, std::size_t interval, const GgvCut& cut,
              double bound_rate, double keep);
  void AddBend(const Lap& lap, std::size_t at, std::size_t interval, const GgvCut& cut,
               double weight);

  const LapModel& model_;
  const ClosedSplineBasis& basis_;
  std::vector<OffsetBounds> bounds_;
  std::vector<ClosedSplineBasis::Local> locals_;

  // Lagrange multipliers of the previous program, one set per interval.
  std::vector<Prices> prices_;

  // The following members hold the linearization about one lap.
  // Change of the curvature at each station as a function of the variables.
  std::vector<Form> curvature_;
  std::vector<Form> stretch_;  // Change of the stretch dl/ds at each station, by the variables.
  // Change of the acceleration in each interval as a function of the variables.
  std::vector<Form> acceleration_;
  std::vector<double> accelerations_;
  std::vector<Eigen::Triplet<double>> rows_;
  std::vector<TangentRow> tangents_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<Eigen::Triplet<double>> squares_;
  Eigen::VectorXd linear_;
};

}  // namespace trackbed
