#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/vehicle/reference_car.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/mppi.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/single_track_car.h"

namespace trackbed {

/// The reference car with a Prius's tyres, understeering by 0.002 rad per m/s^2.
inline VehicleParams ReferenceCarWithTyres() {
  VehicleParams car = ReferenceCar();
  car.yaw_inertia = 2200.0;
  car.cornering_stiffness_front = 90000.0;
  car.cornering_stiffness_rear = 110000.0;
  car.steering_lag = 0.01;
  return car;
}

/// Returns the entry with fewer roll-outs of mppi, which general properties do not need.
inline ControllerEntry WithFewSamples(ControllerEntry entry) {
  if (entry.defaults.Is<MppiOptions>()) {
    entry.defaults = MppiOptions{.samples = 16};
  }
  return entry;
}

/// Returns all registered controllers, with fewer roll-outs of mppi.
inline std::vector<ControllerEntry> ControllersWithFewSamples() {
  std::vector<ControllerEntry> all = Controllers();
  std::transform(all.begin(), all.end(), all.begin(), WithFewSamples);
  return all;
}

/// Returns the controllers that steer by feedback along a path, with fewer roll-outs of mppi.
inline std::vector<ControllerEntry> FollowersWithFewSamples() {
  std::vector<ControllerEntry> followers = ControllersWithFewSamples();
  std::erase_if(followers, [](const ControllerEntry& entry) {
    return !entry.needs_plan || entry.station != StationSource::kProjection;
  });
  return followers;
}

struct LoopSetup {
  VehicleParams vehicle = ReferenceCar();
  Path path;
  Pose2 start;
  double speed = 3.0;  ///< [m/s]; negative in reverse
  double duration = 20.0;
  double period = 0.02;
};

struct LoopRow {
  Projection tracking;
  double wanted = 0.0;
  VehicleState state;
};

/// Simulates a controller and a car at constant speed. The car is SingleTrackCar if `setup.vehicle`
/// has cornering stiffnesses, otherwise KinematicCar.
inline std::vector<LoopRow> Loop(const ControllerOptions& options, const LoopSetup& setup) {
  const auto controller = MakeSteeringController(options);
  const KinematicState start{.pose = setup.start, .speed = setup.speed};
  KinematicCar kinematic(setup.vehicle, ReferencePoint::kRearAxle, start);
  std::vector<SingleTrackCar> single_track;
  if (setup.vehicle.cornering_stiffness_front > 0.0) {
    single_track.emplace_back(setup.vehicle, RollingWithoutSlip(setup.vehicle, start));
  }
  const Reference reference{setup.path, SpeedProfile({{0.0, std::abs(setup.speed)}})};
  std::vector<LoopRow> rows;
  double station = 0.0;
  for (double t = 0.0; t < setup.duration; t += setup.period) {
    LoopRow row;
    row.state = single_track.empty() ? kinematic.FullState() : single_track[0].FullState();
    row.tracking = setup.path.Project(row.state.pose, {station - 2.0, station + 4.0});
    station = row.tracking.s;
    row.wanted = controller->Steer({.vehicle = setup.vehicle,
                                    .reference = reference,
                                    .schedule = {},
                                    .state = row.state,
                                    .station = station,
                                    .period = setup.period});
    const Command command{
        .steering = row.wanted, .acceleration = 0.0, .gear = setup.speed < 0.0 ? -1 : 1};
    single_track.empty() ? kinematic.Step(command, setup.period)
                         : single_track[0].Step(command, setup.period);
    rows.push_back(row);
  }
  return rows;
}

/// Largest cross-track error [m] from row `from` on.
inline double LargestOffset(const std::vector<LoopRow>& rows, std::size_t from = 0) {
  double largest = 0.0;
  for (std::size_t i = from; i < rows.size(); ++i) {
    largest = std::max(largest, std::abs(rows[i].tracking.cross_track));
  }
  return largest;
}

}  // namespace trackbed
