#include "src/sim/adapt_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "src/sim/mujoco_compat.h"
#include "src/sim/object_name.h"
#include "trackbed/core/error.h"

// Finds the limits of a vehicle in its compiled model.
//   Steering: if both front wheels follow one joint, the joint's range limits the steering angle of
//   the bicycle model. Without such a joint, the ranges of the front wheels are Ackermann angles:
//   cot inner = cot bicycle - track/(2 L) with the wheelbase L.
//   Drive: the vehicle is driven by the actuators that have a moment about a wheel's joint. The
//   torque of an actuator is limited by its forcerange, by ctrlrange times the gain, and by the
//   friction of the tyres.
namespace trackbed::adapt {
namespace {

/// Ranges of steering joints beyond this angle [rad] are no steering limits; such ranges only keep
/// a steering joint from turning over.
constexpr double kLargestLimit = 1.3;
/// Steering ranges below this angle [rad] occur in models whose unit of angles is wrong.
constexpr double kSmallestLimit = 0.05;

/// Returns the smaller one of a joint's ranges to both sides [rad]; infinite for an unlimited
/// joint.
double SmallerSide(const mjModel& m, int joint) {
  const mjtNum* range = m.jnt_range + 2 * joint;
  return m.jnt_limited[joint] != 0 ? std::min(-range[0], range[1])
                                   : std::numeric_limits<double>::infinity();
}

struct Range {
  double limit = std::numeric_limits<double>::infinity();
  std::string evidence;
};

/// Returns the range that the joint `front` has because it is coupled to another joint.
Range RangeOfLeader(const mjModel& m, int front) {
  for (int i = 0; i < m.neq; ++i) {
    if (m.eq_type[i] != mjEQ_JOINT || m.eq_obj2id[i] < 0 ||
        (m.eq_obj1id[i] != front && m.eq_obj2id[i] != front)) {
      continue;
    }
    const int other = m.eq_obj1id[i] == front ? m.eq_obj2id[i] : m.eq_obj1id[i];
    const double slope = std::abs(m.eq_data[mjNEQDATA * i + 1]);
    const double own = SmallerSide(m, other);
    if (std::isfinite(own) && slope > 0.0) {
      const bool follows = m.eq_obj1id[i] == front;
      return {follows ? own * slope : own / slope,
              fmt::format("the range of the joint {}, which {} is coupled to",
                          ObjectName(m, mjOBJ_JOINT, other), ObjectName(m, mjOBJ_JOINT, front))};
    }
  }
  return {};
}

/// Returns the control range of a position servo that acts on the joint.
Range RangeOfServo(const mjModel& m, int joint) {
  for (int i = 0; i < m.nu; ++i) {
    const bool is_servo =
        m.actuator_biastype[i] == mjBIAS_AFFINE && m.actuator_biasprm[mjNBIAS * i + 1] < 0.0;
    if (m.actuator_trntype[i] == mjTRN_JOINT && m.actuator_trnid[2 * i] == joint && is_servo &&
        m.actuator_ctrllimited[i] != 0) {
      const mjtNum* range = m.actuator_ctrlrange + 2 * i;
      const double gear = std::abs(m.actuator_gear[6 * i]);
      return {std::min(-range[0], range[1]) / gear,
              fmt::format("ctrlrange of the actuator {}", ObjectName(m, mjOBJ_ACTUATOR, i))};
    }
  }
  return {};
}

/// Returns the steering angle of the bicycle model at which the inner front wheel has the angle
/// `inner`.
double BicycleAngle(const FoundVehicle& vehicle, double inner) {
  const double half = 0.5 * vehicle.track[0] / vehicle.wheelbase;
  return std::atan(std::tan(inner) / (1.0 + half * std::tan(inner)));
}

/// Returns the range of the bicycle model's steering angle that the model's joints and servos
/// allow.
Range SteeringRange(const mjModel& m, const FoundVehicle& vehicle) {
  const int left = vehicle.wheels[0].steer;
  const int right = vehicle.wheels[1].steer;
  if (left == right) {
    return {SmallerSide(m, left), fmt::format("the range of the joint {}, which turns the axle",
                                              ObjectName(m, mjOBJ_JOINT, left))};
  }
  Range leader;
  for (const int front : {left, right}) {
    if (Range own = RangeOfLeader(m, front);
        own.limit < leader.limit && own.limit > kSmallestLimit) {
      leader = std::move(own);
    }
  }
  // A front wheel may be coupled to the other front wheel instead of a joint between the wheels.
  // If the front wheels are coupled to each other, the joint range is an Ackermann angle of a
  // wheel.
  Range wheel{std::min(SmallerSide(m, left), SmallerSide(m, right)),
              fmt::format("the ranges of the joints {} and {}", ObjectName(m, mjOBJ_JOINT, left),
                          ObjectName(m, mjOBJ_JOINT, right))};
  const bool to_other =
      leader.evidence.find(ObjectName(m, mjOBJ_JOINT, left)) != std::string::npos &&
      leader.evidence.find(ObjectName(m, mjOBJ_JOINT, right)) != std::string::npos;
  if (leader.limit < kLargestLimit && !to_other) {
    return leader;
  }
  for (const int front : {left, right}) {
    if (Range servo = RangeOfServo(m, front); servo.limit < wheel.limit) {
      wheel = std::move(servo);
    }
  }
  if (wheel.limit < kLargestLimit) {
    wheel.evidence += fmt::format(", {:.4g} rad at the inner wheel", wheel.limit);
    wheel.limit = BicycleAngle(vehicle, wheel.limit);
  }
  return wheel;
}

void FindSteering(const FoundModel& found, const FoundVehicle& vehicle, const AdaptOptions& options,
                  FoundLimits& limits, Findings& findings) {
  const Range range = SteeringRange(*found.model, vehicle);
  if (options.steering_limit) {
    limits.steering_limit = *options.steering_limit;
    findings.Guess("steering limit", fmt::format("{:.4g} rad", limits.steering_limit),
                   "--steering-limit");
  } else if (!(range.limit < kLargestLimit)) {
    throw InputError(Problem{
        .file = found.file,
        .key = "steering limit",
        .message = fmt::format(
            "how far do the front wheels steer? {} Give the largest bicycle angle by "
            "--steering-limit RAD; cars have 0.4 to 0.7",
            std::isfinite(range.limit)
                ? fmt::format("{} allow {:.3g} rad, more than a car steers.", range.evidence,
                              range.limit)
                : fmt::format("The joints {} and {} have no range, nor has a servo on them.",
                              ObjectName(*found.model, mjOBJ_JOINT, vehicle.wheels[0].steer),
                              ObjectName(*found.model, mjOBJ_JOINT, vehicle.wheels[1].steer)))});
  } else if (!(range.limit > kSmallestLimit)) {
    throw InputError(Problem{
        .file = found.file,
        .key = "steering limit",
        .message = fmt::format(
            "{} allow a bicycle angle of {:.3g} rad only. Without <compiler angle=\"radian\"/>, "
            "ranges are in degrees; correct the file, or give --steering-limit RAD",
            range.evidence, range.limit)});
  } else {
    limits.steering_limit = range.limit;
    findings.Guess("steering limit", fmt::format("{:.4g} rad", range.limit), range.evidence);
  }
  // Assume that a car with the wheelbase kCarWheelbase steers from lock to lock in one second. For
  // smaller vehicles, this time is scaled with the square root of the length (Froude scaling).
  constexpr double kCarWheelbase = 2.7;  // [m]
  const double lock_to_lock = std::min(std::sqrt(vehicle.wheelbase / kCarWheelbase), 1.0);
  limits.steering_rate = options.steering_rate.value_or(2.0 * limits.steering_limit / lock_to_lock);
  findings.Guess(
      "steering rate", fmt::format("{:.4g} rad/s", limits.steering_rate),
      options.steering_rate
          ? "--steering-rate"
          : fmt::format("assumed: from lock to lock in {:.2g} s; --steering-rate", lock_to_lock));
}

/// Returns the largest force of an actuator, in the unit of its gear; nullopt if the force is
/// unlimited.
std::optional<double> LargestForce(const mjModel& m, int actuator) {
  std::optional<double> force;
  if (m.actuator_forcelimited[actuator] != 0) {
    force = m.actuator_forcerange[2 * actuator + 1];
  }
  const bool is_motor =
      m.actuator_gaintype[actuator] == mjGAIN_FIXED && m.actuator_biastype[actuator] == mjBIAS_NONE;
  if (is_motor && m.actuator_ctrllimited[actuator] != 0) {
    const double own = m.actuator_gainprm[mjNGAIN * actuator] *
                       std::max(std::abs(m.actuator_ctrlrange[2 * actuator]),
                                std::abs(m.actuator_ctrlrange[2 * actuator + 1]));
    force = force ? std::min(*force, std::abs(own)) : std::abs(own);
  }
  return force;
}

/// The actuators that drive the wheels of the model.
struct Motors {
  std::vector<std::string> names;
  double torque = 0.0;  // Largest torque on all wheels together [N m].
  bool unlimited = false;
};

Motors FindMotors(const FoundModel& found, const FoundVehicle& vehicle,
                  std::array<bool, 4>& driven) {
  const mjModel& m = *found.model;
  Motors motors;
  std::array<double, 4> torque{};
  for (int i = 0; i < m.nu; ++i) {
    const std::optional<double> force = LargestForce(m, i);
    bool drives = false;
    for (std::size_t w = 0; w < vehicle.wheels.size(); ++w) {
      const int spin = vehicle.wheels[w].spin;
      const double moment =
          spin < 0 ? 0.0 : std::abs(mj::ActuatorMoment(m, *found.data, i, m.jnt_dofadr[spin]));
      if (moment > 0.0) {
        drives = driven[w] = true;
        torque[w] += moment * force.value_or(0.0);
      }
    }
    if (drives) {
      motors.names.push_back(ObjectName(m, mjOBJ_ACTUATOR, i));
      motors.unlimited = motors.unlimited || !force;
    }
  }
  for (std::size_t w = 0; w < vehicle.wheels.size(); ++w) {
    if (vehicle.wheels[w].spin >= 0) {
      motors.torque +=
          std::min(torque[w], static_cast<double>(mj::JointForceLimit(m, vehicle.wheels[w].spin)));
    }
  }
  return motors;
}

void FindDrive(const FoundModel& found, const FoundVehicle& vehicle, double mass,
               const AdaptOptions& options, FoundLimits& limits, Findings& findings) {
  const Motors motors = FindMotors(found, vehicle, limits.driven);
  const std::string named = fmt::format("{}", fmt::join(motors.names, ", "));
  std::string evidence = "actuators " + named;
  if (motors.names.empty()) {
    // Assume rear-wheel drive. With differential drive, the last two wheels are the driven wheels.
    const std::size_t first = vehicle.wheels.size() - 2;
    limits.driven[first] = limits.driven[first + 1] = true;
    evidence = "assumed: no actuator acts on a wheel";
  }
  std::vector<std::string> wheels;
  for (std::size_t w = 0; w < vehicle.wheels.size(); ++w) {
    if (limits.driven[w]) {
      wheels.push_back(vehicle.wheels[w].name);
    }
  }
  findings.Guess("driven wheels", fmt::format("{}", fmt::join(wheels, ", ")), evidence);

  const double gravity = std::abs(found.model->opt.gravity[2]);
  const double grip = limits.friction * mass * gravity * vehicle.radius;
  double& torque = limits.drive_torque;
  torque = 0.5 * grip;
  evidence = "assumed: half of what the tyres can transmit; --drive-torque";
  if (options.drive_torque) {
    torque = *options.drive_torque;
    evidence = "--drive-torque";
  } else if (!motors.unlimited && motors.torque > grip) {
    torque = grip;
    evidence =
        fmt::format("what the tyres can transmit; {} could exert {:.3g} N m", named, motors.torque);
  } else if (!motors.unlimited && motors.torque > 0.02 * grip) {
    torque = motors.torque;
    evidence = fmt::format("force and control ranges of {}", named);
  }
  findings.Guess("drive torque", fmt::format("{:.4g} N m", torque), evidence);
}

void FindFriction(const FoundModel& found, const FoundVehicle& vehicle, FoundLimits& limits,
                  Findings& findings) {
  const mjModel& m = *found.model;
  double ground = 0.0;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    if (m.geom_type[geom] == mjGEOM_PLANE) {
      ground = std::max(ground, static_cast<double>(m.geom_friction[3 * geom]));
    }
  }
  double tyre = std::numeric_limits<double>::infinity();
  for (const FoundWheel& wheel : vehicle.wheels) {
    if (wheel.round.geom >= 0) {
      tyre = std::min(tyre, static_cast<double>(m.geom_friction[3 * wheel.round.geom]));
    }
  }
  // MuJoCo takes the larger friction of two geoms in contact.
  const double found_friction = std::max(tyre, ground);
  constexpr double kLeast = 0.3;
  constexpr double kMost = 1.2;
  if (found.is_urdf || !std::isfinite(tyre)) {
    limits.friction = 0.9;
    findings.Guess("tyre friction", "0.9", "assumed: rubber on dry ground");
  } else if (found_friction < kLeast || found_friction > kMost) {
    limits.friction = std::clamp(found_friction, kLeast, kMost);
    findings.Guess("tyre friction", fmt::format("{:.3g}", limits.friction),
                   fmt::format("the model has {:.3g}; tyres on a road have {:g} to {:g}",
                               found_friction, kLeast, kMost));
  } else {
    limits.friction = found_friction;
    findings.Guess("tyre friction", fmt::format("{:.3g}", limits.friction),
                   "friction of the wheels' geoms and the ground");
  }
}

}  // namespace

void MassSum::Add(const MassSum& other, double sign) {
  const double sum = mass + sign * other.mass;
  if (!(sum > 0.0)) {
    *this = {};
    return;
  }
  const Vector middle = (mass * center + sign * other.mass * other.center) / sum;
  const auto about = [&](const MassSum& part) -> Matrix {
    const Vector r = part.center - middle;
    return part.inertia + part.mass * (r.squaredNorm() * Matrix::Identity() - r * r.transpose());
  };
  inertia = (about(*this) + sign * about(other)).eval();
  center = middle;
  mass = sum;
}

MassSum MassOfBody(const FoundModel& found, const FoundVehicle& vehicle, int body) {
  const mjModel& m = *found.model;
  const Matrix axes = vehicle.turn.transpose() * ToMatrix(found.data->ximat + 9 * body);
  return {.mass = m.body_mass[body],
          .center = vehicle.ToVehicle(ToVector(found.data->xipos + 3 * body)),
          .inertia = axes * ToVector(m.body_inertia + 3 * body).asDiagonal() * axes.transpose()};
}

FoundLimits FindLimits(const FoundModel& found, const FoundVehicle& vehicle, double mass,
                       const AdaptOptions& options, Findings& findings) {
  FoundLimits limits;
  FindFriction(found, vehicle, limits, findings);
  if (vehicle.kind == VehicleKind::kSteered) {
    FindSteering(found, vehicle, options, limits, findings);
  }
  FindDrive(found, vehicle, mass, options, limits, findings);
  return limits;
}

}  // namespace trackbed::adapt
