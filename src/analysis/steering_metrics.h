#pragma once

#include <optional>

#include "trackbed/analysis/metrics.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns the rate of reversals of the steering command [1/s], >= 0 (SAE J2944): how often the
/// command turns back by more than a threshold. The reversal threshold is 1/180 of the largest
/// steering angle: 3 degrees for a steering wheel that turns 540 degrees to each lock.
double SteeringReversals(const RunLog& log, const VehicleParams& vehicle);

/// Finds the largest sustained oscillation of the steering command that neither the path nor the
/// measurement noise explains (src/analysis/oscillation.h). The returned amplitude is 0 if the
/// steering command does not oscillate by more than ToleratedAmplitude. Returns nullopt for a run
/// without path. Jumps of the steering command at changes of plan are ignored. The log after the
/// first contact with an obstacle is ignored.
std::optional<OscillationMetrics> MeasureOscillation(const RunLog& log, const Plan& plan,
                                                     const VehicleParams& vehicle);

/// Returns the largest amplitude [rad] of a steering oscillation that is tolerated. The tolerated
/// amplitude is the smaller of two limits: of the steering rate, and of the car's lateral motion.
/// At the steering rate limit, the oscillation uses a fifth of the maximum steering rate. At the
/// lateral motion limit, the oscillation moves the car at `speed` [m/s] by 5 % of its width to each
/// side. The tolerated amplitude is at least half of the backlash, within which the wheels do not
/// move. `frequency` is in Hz, > 0.
double ToleratedAmplitude(const VehicleParams& vehicle, double frequency, double speed);

}  // namespace trackbed
