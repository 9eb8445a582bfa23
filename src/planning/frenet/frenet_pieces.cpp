#include "src/planning/frenet/frenet_pieces.h"

#include <fmt/format.h>

namespace trackbed {
namespace {

/// Distance below which a motion gets no lateral polynomial d(s) [m].
constexpr double kShort = 0.05;

}  // namespace

LineMotion LongitudinalMotion(const FrenetState& state) {
  return {state.s, state.s_rate, state.s_acceleration};
}

bool AddOverStation(const FrenetState& start, double offset, FrenetPiece& piece) {
  const double way = piece.s.At(piece.duration) - start.s;
  piece.over_station = true;
  if (!(way > -kShort)) {
    return false;
  }
  piece.d = way < kShort
                ? Polynomial{{start.d, start.d_slope, 0.5 * start.d_bend}}
                : QuinticBetween({start.d, start.d_slope, start.d_bend}, {offset, 0.0, 0.0}, way);
  return true;
}

void AddOverTime(const FrenetState& start, double offset, FrenetPiece& piece) {
  piece.over_station = false;
  piece.d = QuinticBetween({start.d, start.d_rate(), start.d_acceleration()}, {offset, 0.0, 0.0},
                           piece.duration);
}

std::string ExplainFailure(const FrenetPlan& plan, const char* of_what, int budget) {
  if (plan.candidates == 0) {
    return fmt::format("there are no {}", of_what);
  }
  if (plan.checked >= budget && plan.checked < plan.candidates) {
    return fmt::format("none of the first {} of {} {} is feasible{}{}", plan.checked,
                       plan.candidates, of_what, plan.checked > 0 ? ": " : "",
                       plan.rejected.ToString());
  }
  return fmt::format("none of {} {} is feasible: {}", plan.candidates, of_what,
                     plan.rejected.ToString());
}

}  // namespace trackbed
