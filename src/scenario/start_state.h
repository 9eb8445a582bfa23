#pragma once

#include <optional>

#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// The speed at the start [m/s] where something else than mission.speed gives it: in this order
/// mission.start.speed, a recording that has speeds, a record, a path whose own speeds are
/// followed, or control.speed.over_time.
std::optional<double> StartSpeedBesideMission(const Scenario& scenario);

}  // namespace trackbed
