#pragma once

#include <memory>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Wraps the path-following controller `inner` in a model of the steering actuator. The control law
/// then accounts for the dead time, the lag, the backlash and the calibration curve of
/// SteeringResponse, and for the limits of angle and rate. Both with kModel and with kIgnore:
///   * The angle that `inner` wants is clamped to AllowedSteering (steering_limit.h). `inner` plans
///     with this limit as VehicleParams::steering_limit, or with SteeringAhead if that is more.
///   * The friction coefficients that `inner` receives are those on the road under the car, if the
///     wrapper sees the surroundings.
///   * As long as no measured state had a lateral speed of the rear axle, `inner` receives a car
///     without tyre coefficients: the car is kinematic.
///
/// With kModel, the wrapper predicts the car's state at the time t + T_d at which the next command
/// takes effect. T_d is the dead time of the actuator. The wrapper calls `inner` with the predicted
/// state (a Smith predictor, Smith 1957). The prediction has these steps:
///   1. A SteeringFilter keeps the commands that have not reached the actuator yet.
///   2. The prediction starts at the measured state, with the linear single-track model. Without
///      tyre coefficients, or below 1 m/s, the prediction uses the kinematic model.
///   3. The predicted car drives for T_d at constant speed. The predicted wheel angle is the output
///      of the SteeringFilter plus the measured minus the modeled actuator angle at the time t. The
///      measured angle corrects errors of the actuator model, for example of the steering ratio.
///      A low-pass filter with the time constant T_d smooths this difference.
/// The predicted state has the wheel angle at t + T_d, and the last wanted angle as the angle of
/// the actuator. The predicted station is the station of the path point nearest to the predicted
/// pose. The prediction does not change the times `state.time` and `period`.
///
/// The angle that `inner` returns is converted to a command in these steps:
///   1. Within a dead zone to both sides of the steady turn on the path, the angle of the steady
///      turn is commanded. Without the dead zone, the command would cross the play forever, because
///      errors decay but never vanish. The half-width is a quarter of the backlash, or
///      0.08 (L/R)^2 if that is less, where R is ShortestPreview. A law that steers to a point at
///      the distance R then stays within 0.04 L of its path. Reversals of the wanted angle below a
///      quarter of the half-width are ignored, because noise would otherwise make the command
///      cross the play. When the wanted angle returns from a correction into the dead zone, the
///      wheels always return to the steady turn. Wheels that kept a small correction would turn the
///      car until it leaves the other edge of the dead zone faster, without an end.
///   2. Half of the backlash is added on the side to which the actuator turns.
///   3. A lead divides the lag by 3 and amplifies noise by 3. While the wheels cross the play, the
///      amplification is up to 6.
///   4. The inverse of the calibration curve is applied.
/// The vehicle that `inner` receives has a third of the lag as SteeringResponse::time_constant, and
/// no dead time, backlash or calibration curve.
///
/// With kIgnore, `inner` receives the measured state, and a vehicle with an ideal response and
/// without steering lag. With an ideal response and kModel, the wrapper passes on the measured
/// state and all angles within the limits without any change, bit for bit. Cost per control period:
/// ten steps of the car model for each control period within T_d, about 20 us.
std::unique_ptr<SteeringController> WithActuatorModel(std::unique_ptr<SteeringController> inner,
                                                      ActuatorKnowledge knowledge);

}  // namespace trackbed
