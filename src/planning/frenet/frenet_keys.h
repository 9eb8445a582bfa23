#pragma once

#include "trackbed/planning/frenet/frenet.h"

/// Option keys that all planners of motions along a path share.
namespace trackbed {

inline constexpr Key kEndOffsets{"end_offsets", "m", "candidate lateral offsets from the route"};
inline constexpr Key kSpeedFactors{"speed_factors", "", "candidate fractions of the target speed"};
inline constexpr Range kOffsetRange{.min = -100.0, .max = 100.0};
inline constexpr Range kFactorRange{.min = 0.0, .max = 1.0};

void VisitLimits(KeyVisitor& keys, FrenetLimits& limits);

}  // namespace trackbed
