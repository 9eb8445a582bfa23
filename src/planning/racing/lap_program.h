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

/// Quadratic programs whose solutions shorten a lap's time.
namespace trackbed {

/// Trust region: bounds of a step.
struct LapTrust {
  double offset = 1.0;   ///< change of d at a station [m]
  double squared = 0.3;  ///< relative change of the squared speed there
};

/// Builds the quadratic program about each lap of the search.
///
/// Variables: the changes of the line's coefficients [m], then the relative changes of the squared
/// speeds. Where the tyres' lateral limit is active, kappa <= a/w, with w the squared speed, is
/// replaced by kappa <= a/w_0 (1 - (w - w_0)/w_0). This is never larger, so with exact curvatures a
/// step keeps the limit.
class LapProgram {
 public:
  LapProgram(const LapModel& model, const ClosedSplineBasis& basis,
             std::vector<OffsetBounds> bounds);

  [[nodiscard]] Eigen::Index coefficients() const {
    return static_cast<Eigen::Index>(basis_.count());
  }

  /// The program about a lap along `line`. Where the curvature exceeds LapLimits::curvature_max,
  /// the excess must fall by the fraction `share`.
  SparseQuadraticProgram About(const TrackLine& line, const Lap& lap, const LapTrust& trust,
                               double share);

  /// Stores the multipliers of the last program. The next program uses them to weight the curvature
  /// of the boundary, which tangents neglect.
  void TakeMultipliers(const Eigen::VectorXd& multipliers);

 private:
  /// A linear function of the variables.
  struct Form {
    std::vector<std::pair<Eigen::Index, double>> terms{};
    void Add(Eigen::Index variable, double factor) { terms.emplace_back(variable, factor); }
    void Add(const Form& other, double factor);
  };

  /// Decrease of the lap time per unit of tyre force in an interval, by the limits at its first and
  /// at its second end, for driving and for braking.
  using Prices = std::array<std::array<double, 2>, 2>;
  /// A row of a program that is a tangent.
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
  void AddCurvatures(const Lap& lap, double share);
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

  std::vector<Prices> prices_;  // of the previous program

  // Linearization about one lap:
  std::vector<Form> curvature_;     // change of the curvature at the stations
  std::vector<Form> stretch_;       // change of dl/ds at the stations
  std::vector<Form> acceleration_;  // change of the acceleration of each interval
  std::vector<double> accelerations_;
  std::vector<Eigen::Triplet<double>> rows_;
  std::vector<TangentRow> tangents_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<Eigen::Triplet<double>> squares_;
  Eigen::VectorXd linear_;
};

}  // namespace trackbed
