#pragma once

#include <optional>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Returns the longitudinal part of a Frenet state: station, speed and acceleration along the path.
LineMotion LongitudinalMotion(const FrenetState& state);

/// Adds the lateral motion d(s) from `start` to a constant `offset` to a piece that already has a
/// longitudinal motion s(t). If the piece is shorter than 5 cm, extrapolates the offset from
/// `start` instead. Returns false if the piece moves backward by 5 cm or more.
bool AddOverStation(const FrenetState& start, double offset, FrenetPiece& piece);

/// Adds the lateral motion d(t) from `start` to a constant `offset` to a piece that already has a
/// longitudinal motion s(t).
void AddOverTime(const FrenetState& start, double offset, FrenetPiece& piece);

/// Returns the description of a failure, for example "none of 525 candidates is feasible: 500
/// collision, 25 speed".
std::string ExplainFailure(const FrenetPlan& plan, const char* of_what, int budget);

}  // namespace trackbed
