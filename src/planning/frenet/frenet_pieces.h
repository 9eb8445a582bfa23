#pragma once

#include <optional>

#include "trackbed/planning/frenet/frenet.h"

namespace trackbed {

/// The motion along the path that a state begins with.
LineMotion LongitudinalMotion(const FrenetState& state);

/// Adds to s(t) of a piece the lateral motion over the station, from `start` to rest at `offset`.
/// Over a few centimeters the offset goes on as it was going instead. False where s does not grow.
bool AddOverStation(const FrenetState& start, double offset, FrenetPiece& piece);

/// Adds to s(t) of a piece the lateral motion over time.
void AddOverTime(const FrenetState& start, double offset, FrenetPiece& piece);

/// "none of 525 candidates can be driven: 500 collision, 25 speed".
std::string ExplainFailure(const FrenetPlan& plan, const char* of_what, int budget);

}  // namespace trackbed
