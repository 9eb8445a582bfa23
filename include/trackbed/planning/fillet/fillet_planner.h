#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/optimize/search.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/turn_prediction.h"
#include "trackbed/planning/fillet/fillet.h"

namespace trackbed {

/// Diagnostics of a turn of a plan, stored in PlanDiagnostics::turns.
struct FilletTurnFindings {
  FilletTurn turn;
  std::string search_method;  ///< Name of the method that searched for the turn's radius, if any.
  /// Predicted open-loop error at the middle of the turn, if the turn is isolated.
  std::optional<TurnError> predicted;
};
void Visit(DiagnosticsVisitor& out, const FilletTurnFindings& own);

/// Shifts the stations of a turn that lies beyond a replaced stretch of the path. Adds a note to
/// the diagnostics of a turn that overlaps the replaced stretch of the path.
void ReplaceStretch(FilletTurnFindings& own, const Stations& replaced, double shift);

/// Diagnostics of a fillet plan or of its failure, stored in PlanDiagnostics::planner.
struct FilletDiagnostics {
  std::optional<int> failed_waypoint;  ///< Index of the waypoint at which planning failed.
  double neutral_steering = 0.0;       ///< Neutral steering angle d_0 between turns [rad].
  /// Curvature on which a kinematic car drives with the neutral steering angle d_0 [rad/m].
  double neutral_curvature = 0.0;
  std::string search_method;  ///< Name of the method that searched over all turns together, if any.
  /// Result of the search over all turns together (kDriven).
  std::optional<SearchResult> search{};
};
void Visit(DiagnosticsVisitor& out, const FilletDiagnostics& own);

/// Extracts the radii [m] from the variables `x` of a search over all turns together (kDriven). The
/// argument `x` is the result of the search over all turns, or an entry of that search's history.
std::vector<double> DrivenRadii(const std::vector<double>& x);

/// Returns the planner `fillet`.
PlannerEntry FilletPlanner();

}  // namespace trackbed
