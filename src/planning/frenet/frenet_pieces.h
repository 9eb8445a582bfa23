#pragma once

#include <optional>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// Initial motion, along the path, of a car with the given Frenet state.
LineMotion LongitudinalMotion(const FrenetState& state);

/// Adds the lateral motion d(s) from `start` to rest at `offset` to the longitudinal motion s(t) of
/// a piece. If the piece is shorter than 5 cm, extrapolates the offset instead. Returns false if
/// the piece moves backward by 5 cm or more.
bool AddOverStation(const FrenetState& start, double offset, FrenetPiece& piece);

/// Adds the lateral motion d(t) to the longitudinal motion s(t) of a piece.
void AddOverTime(const FrenetState& start, double offset, FrenetPiece& piece);

/// Describes a failure, for example "none of 525 candidates is feasible: 500 collision, 25 speed".
std::string ExplainFailure(const FrenetPlan& plan, const char* of_what, int budget);

}  // namespace trackbed
