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

/// Quadratic programs for a faster lap near a given one.
namespace trackbed {

/// How far a step may lead.
struct LapTrust {
  double offset = 1.0;   ///< change of d at a station [m]
  double squared = 0.3;  ///< relative change of the square of the speed there
};

/// The programs about one lap after the other.
///
/// Variables: the changes of the line's coefficients [m], then of the squares of the speeds,
/// relative to those of the lap. About a place where the tyres' lateral limit holds, kappa <= a/w,
/// w the square of the speed, is replaced by kappa <= a/w_0 (1 - (w - w_0)/w_0), which is never
/// more: with exact curvatures a step there keeps the limit.
class LapProgram {
 public:
  LapProgram(const LapModel& model, const ClosedSplineBasis& basis,
             std::vector<OffsetBounds> bounds);

  [[nodiscard]] Eigen::Index coefficients() const {
    return static_cast<Eigen::Index>(basis_.count());
  }

  /// The program about a lap along `line`. Curvatures beyond LapLimits::curvature_max are to be
  /// less by `share` of what they are beyond it.
  SparseQuadraticProgram About(const TrackLine& line, const Lap& lap, const LapTrust& trust,
                               double share);

  /// Tells what the multipliers of the last program were. They are taken for the next one's, to
  /// know what the curvature of the boundary costs that its tangents do not have.
  void TakeMultipliers(const Eigen::VectorXd& multipliers);

 private:
  /// A linear function of the variables.
  struct Form {
    std::vector<std::pair<Eigen::Index, double>> terms{};
    void Add(Eigen::Index variable, double factor) { terms.emplace_back(variable, factor); }
    void Add(const Form& other, double factor);
  };

  /// How much the lap time falls with what the tyres hold in an interval, by what is possible at
  /// its first and at its second end, when driving and when braking.
  using Prices = std::array<std::array<double, 2>, 2>;
  /// A tangent among the rows of a program.
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

  std::vector<Prices> prices_;  // of the last program

  // About one lap:
  std::vector<Form> curvature_;     // its change at the stations
  std::vector<Form> stretch_;       // likewise of dl/ds
  std::vector<Form> acceleration_;  // of each interval
  std::vector<double> accelerations_;
  std::vector<Eigen::Triplet<double>> rows_;
  std::vector<TangentRow> tangents_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<Eigen::Triplet<double>> squares_;
  Eigen::VectorXd linear_;
};

}  // namespace trackbed
