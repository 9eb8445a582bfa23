#include "src/sim/adapt_find.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "src/sim/adapt_wheels.h"
#include "src/sim/object_name.h"
#include "trackbed/core/error.h"

// Finds a vehicle in a compiled model by geometry:
//   1. FindWheels finds the wheels (adapt_wheels).
//   2. The vehicle is the body that contains the wheels. Wheels that swivel are casters.
//   3. In the vehicle frame, the mean wheel axis points left, and the steered axle is in front.
namespace trackbed::adapt {
namespace {

constexpr double kVertical = 0.7;  // Smallest vertical component of a steering axis's unit vector.
constexpr double kSameAxis = 0.9;  // Smallest cosine of the angle between the axes of two wheels of
                                   // a vehicle.

[[noreturn]] void Ask(const FoundModel& found, std::string key, std::string message) {
  throw InputError(
      Problem{.file = found.file, .key = std::move(key), .message = std::move(message)});
}

std::string Listed(const std::vector<FoundWheel>& wheels) {
  std::vector<std::string> names;
  for (const FoundWheel& wheel : wheels) {
    names.push_back(wheel.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

bool Contains(const mjModel& model, int body, int part) {
  while (part > body) {
    part = model.body_parentid[part];
  }
  return part == body;
}

/// Keeps only the wheels of one vehicle.
void ChooseVehicle(const FoundModel& found, const AdaptOptions& options,
                   std::vector<FoundWheel>& wheels) {
  const mjModel& m = *found.model;
  if (!options.body.empty()) {
    const int body = mj_name2id(&m, mjOBJ_BODY, options.body.c_str());
    if (body < 0) {
      Ask(found, "--body", fmt::format("the model has no body '{}'", options.body));
    }
    std::erase_if(wheels, [&](const FoundWheel& wheel) { return !Contains(m, body, wheel.body); });
  }
  std::map<int, int> counts;
  for (const FoundWheel& wheel : wheels) {
    ++counts[m.body_rootid[wheel.body]];
  }
  // A single round part on the ground, such as an obstacle, does not count as a vehicle.
  std::erase_if(counts, [](const auto& count) { return count.second < 2; });
  if (counts.size() > 1) {
    std::vector<std::string> names;
    for (const auto& [root, count] : counts) {
      names.push_back(fmt::format("{} ({} wheels)", ObjectName(m, mjOBJ_BODY, root), count));
    }
    Ask(found, "body",
        fmt::format("which vehicle? The model has {}: {}. Name one by --body NAME", counts.size(),
                    fmt::join(names, ", ")));
  }
  std::erase_if(wheels, [&](const FoundWheel& wheel) {
    return counts.empty() || m.body_rootid[wheel.body] != counts.begin()->first;
  });
}

/// Finds the deepest body that contains all wheels but does not turn with any wheel.
int FindBase(const mjModel& m, const std::vector<FoundWheel>& wheels) {
  const auto above = [&](const FoundWheel& wheel) {
    return wheel.spin >= 0 ? m.body_parentid[wheel.body] : wheel.body;
  };
  int base = above(wheels.front());
  for (const FoundWheel& wheel : wheels) {
    while (base > 0 && !Contains(m, base, above(wheel))) {
      base = m.body_parentid[base];
    }
  }
  return base;
}

/// Finds the steering joint and the spring of each wheel among the joints between the wheel and the
/// base body.
void FindCarriers(const FoundModel& found, int base, std::vector<FoundWheel>& wheels) {
  const mjModel& m = *found.model;
  for (FoundWheel& wheel : wheels) {
    for (int body = wheel.body; body > base; body = m.body_parentid[body]) {
      for (int joint = m.body_jntadr[body]; joint < m.body_jntadr[body] + m.body_jntnum[body];
           ++joint) {
        if (std::abs(found.data->xaxis[3 * joint + 2]) < kVertical) {
          continue;
        }
        if (m.jnt_type[joint] == mjJNT_HINGE && joint != wheel.spin && wheel.steer < 0) {
          wheel.steer = joint;
        } else if (m.jnt_type[joint] == mjJNT_SLIDE && m.jnt_stiffness[joint] > 0.0 &&
                   wheel.slide < 0) {
          wheel.slide = joint;
        }
      }
    }
  }
}

/// Returns whether a wheel swivels behind its steering axis, as a caster does. A caster's steering
/// joint is not limited. A caster has its steering axis ahead of the wheel by more than a fifth of
/// the wheel radius.
bool IsCaster(const FoundModel& found, const FoundWheel& wheel) {
  if (wheel.steer < 0 || found.model->jnt_limited[wheel.steer] != 0) {
    return false;
  }
  Vector from = wheel.round.center - ToVector(found.data->xanchor + 3 * wheel.steer);
  from.z() = 0.0;
  return std::abs(from.dot(wheel.axis.cross(Vector::UnitZ()))) > 0.2 * wheel.round.radius;
}

void RequireParallel(const FoundModel& found, const std::vector<FoundWheel>& wheels) {
  const Vector first = wheels.front().axis;
  for (const FoundWheel& wheel : wheels) {
    if (std::abs(wheel.axis.dot(first)) < kSameAxis) {
      Ask(found, "wheels",
          fmt::format("the axles of {} and {} are {:.3g} degrees apart: a robot with mecanum or "
                      "omnidirectional wheels, which Trackbed does not drive; it drives cars with "
                      "steered wheels and vehicles with two driven wheels",
                      wheels.front().name, wheel.name,
                      std::acos(std::abs(wheel.axis.dot(first))) * 180.0 / std::numbers::pi));
    }
  }
}

/// Sets the axes of the vehicle frame V: z up, y along the wheel axes, and x forward or backward.
/// Sorts the wheels from the rear to the front.
void AlignFrame(std::vector<FoundWheel>& wheels, FoundVehicle& vehicle) {
  Vector left = Vector::Zero();
  for (const FoundWheel& wheel : wheels) {
    left += wheel.axis.dot(wheels.front().axis) < 0.0 ? -wheel.axis : wheel.axis;
  }
  left.z() = 0.0;
  vehicle.turn.col(2) = Vector::UnitZ();
  vehicle.turn.col(1) = left.normalized();
  vehicle.turn.col(0) = vehicle.turn.col(1).cross(Vector::UnitZ());
}

void Reverse(FoundVehicle& vehicle) {
  vehicle.turn.col(0) *= -1.0;
  vehicle.turn.col(1) *= -1.0;
}

double Along(const FoundVehicle& vehicle, const FoundWheel& wheel, int axis) {
  return vehicle.turn.col(axis).dot(wheel.round.center);
}

/// Sorts two wheels of an axle: left first.
void SortAxle(const FoundVehicle& vehicle, FoundWheel* wheels) {
  if (Along(vehicle, wheels[0], 1) < Along(vehicle, wheels[1], 1)) {
    std::swap(wheels[0], wheels[1]);
  }
}

/// Returns the direction of the base body's x axis along the x axis of the vehicle frame V: 1, -1,
/// or 0 if the body's x axis points in another direction.
int BodyDirection(const FoundModel& found, const FoundVehicle& vehicle) {
  const double along =
      ToMatrix(found.data->xmat + 9 * vehicle.base).col(0).dot(vehicle.turn.col(0));
  return std::abs(along) < kVertical ? 0 : along > 0.0 ? 1 : -1;
}

/// Returns the names of the hinges between the wheels and the base that are not vertical. An error
/// message names these hinges if no steering joint was found.
std::string OtherHinges(const FoundModel& found, const FoundVehicle& vehicle) {
  const mjModel& m = *found.model;
  std::vector<std::string> names;
  for (const FoundWheel& wheel : vehicle.wheels) {
    for (int body = wheel.body; body > vehicle.base; body = m.body_parentid[body]) {
      for (int joint = m.body_jntadr[body]; joint < m.body_jntadr[body] + m.body_jntnum[body];
           ++joint) {
        if (joint != wheel.spin && m.jnt_type[joint] == mjJNT_HINGE) {
          const mjtNum* axis = found.data->xaxis + 3 * joint;
          names.push_back(fmt::format("{} (axis {:.2f} {:.2f} {:.2f})",
                                      ObjectName(m, mjOBJ_JOINT, joint), axis[0], axis[1],
                                      axis[2]));
        }
      }
    }
  }
  return names.empty() ? ""
                       : fmt::format(
                             ". If it steers by {}: a steering axis must be vertical, along "
                             "z of the world",
                             fmt::join(names, ", "));
}

/// For a vehicle with four wheels, turns the vehicle frame V such that the steered axle is in
/// front. Removes the steering of the rear axle if `options.steers_front_only` is true.
void OrientCar(const FoundModel& found, const AdaptOptions& options, FoundVehicle& vehicle,
               Findings& findings) {
  auto& wheels = vehicle.wheels;
  const auto sort = [&] {
    std::sort(wheels.begin(), wheels.end(), [&](const FoundWheel& a, const FoundWheel& b) {
      return Along(vehicle, a, 0) > Along(vehicle, b, 0);
    });
    SortAxle(vehicle, wheels.data());
    SortAxle(vehicle, wheels.data() + 2);
  };
  sort();
  const auto steers = [&](std::size_t first) {
    return wheels[first].steer >= 0 && wheels[first + 1].steer >= 0;
  };
  const int body = BodyDirection(found, vehicle);
  if (steers(0) && steers(2)) {
    if (!options.steers_front_only) {
      Ask(found, "steering",
          fmt::format("all four wheels are steered ({}); Trackbed drives cars that steer in front. "
                      "Lock the rear wheels straight ahead by --front-steering",
                      Listed(wheels)));
    }
    if (body < 0) {
      Reverse(vehicle);
      sort();
    }
    wheels[2].steer = wheels[3].steer = -1;
    findings.Guess("forward",
                   "the x axis of the body " + ObjectName(*found.model, mjOBJ_BODY, vehicle.base),
                   "assumed: both axles steer; --front-steering locks the rear one");
    return;
  }
  if (!steers(0) && steers(2)) {
    Reverse(vehicle);
    sort();
  }
  if (!steers(0)) {
    std::vector<FoundWheel> steered;
    std::copy_if(wheels.begin(), wheels.end(), std::back_inserter(steered),
                 [](const FoundWheel& wheel) { return wheel.steer >= 0; });
    Ask(found, "steering",
        steered.empty()
            ? fmt::format(
                  "a skid-steer robot: none of the four wheels ({}) turns about a vertical hinge. "
                  "Trackbed drives cars with steered wheels, and differential drive with two "
                  "wheels and casters; give the front wheels steering joints, or replace one axle "
                  "by a caster{}",
                  Listed(wheels), OtherHinges(found, vehicle))
            : fmt::format("only {} of the wheels turns about a vertical hinge; both wheels of the "
                          "front axle must steer",
                          Listed(steered)));
  }
  const int direction = BodyDirection(found, vehicle);
  findings.Guess("forward",
                 direction > 0   ? "along x of the body"
                 : direction < 0 ? "against x of the body"
                                 : "across x of the body",
                 fmt::format("the joints {} and {} steer the wheels on this side",
                             ObjectName(*found.model, mjOBJ_JOINT, wheels[0].steer),
                             ObjectName(*found.model, mjOBJ_JOINT, wheels[1].steer)));
}

/// Whether the wheels stand on at most two axles, of which one has more than two wheels.
bool CrowdAnAxle(const std::vector<FoundWheel>& wheels) {
  const Vector forward = wheels.front().axis.cross(Vector::UnitZ());
  std::vector<double> axles;
  for (const FoundWheel& wheel : wheels) {
    const double at = wheel.round.center.dot(forward);
    if (std::none_of(axles.begin(), axles.end(),
                     [&](double axle) { return std::abs(axle - at) < 0.5 * wheel.round.radius; })) {
      axles.push_back(at);
    }
  }
  return wheels.size() > 4 && axles.size() <= 2;
}

/// Throws InputError that describes an arrangement of wheels that is neither a car nor a
/// differential drive.
[[noreturn]] void RefuseCount(const FoundModel& found, const std::vector<FoundWheel>& wheels) {
  if (wheels.empty()) {
    Ask(found, "wheels",
        std::string(
            "no wheels found: a wheel is a hinge joint with a horizontal axis and a cylinder, "
            "ellipsoid, ball or mesh that is round about this axis. If the wheels have no "
            "geometry, "
            "give their radius by --wheel-radius R [m].") +
            WhyNoWheels(found));
  }
  const char* called = wheels.size() == 3    ? "a tricycle"
                       : wheels.size() == 1  ? "a unicycle"
                       : CrowdAnAxle(wheels) ? "a vehicle with more than two wheels on an axle"
                       : wheels.size() > 4   ? "a vehicle with tracks or more than two axles"
                                             : "a motorcycle or bicycle";
  Ask(found, "wheels",
      fmt::format("{} wheels on the ground ({}): {}, which Trackbed does not drive; it drives cars "
                  "with four wheels, and differential drive with two wheels and casters{}",
                  wheels.size(), Listed(wheels), called,
                  CrowdAnAxle(wheels) ? "; remove the other wheels from the file" : ""));
}

/// Sets the vehicle's wheel radius, the origin of its frame, and the distances between its wheels.
void Measure(const FoundModel& found, const AdaptOptions& options, FoundVehicle& vehicle,
             Findings& findings) {
  const auto& wheels = vehicle.wheels;
  const auto [least, most] = std::minmax_element(
      wheels.begin(), wheels.end(),
      [](const FoundWheel& a, const FoundWheel& b) { return a.round.radius < b.round.radius; });
  const double smallest = least->round.radius;
  const double largest = most->round.radius;
  if (options.wheel_radius) {
    vehicle.radius = *options.wheel_radius;
    findings.Guess("wheel radius", fmt::format("{:.5g} m", vehicle.radius), "--wheel-radius");
  } else if (largest > 1.02 * smallest) {
    Ask(found, "wheel radius",
        fmt::format("the wheels {} and {} have the radii {:.4g} and {:.4g} m; all wheels must have "
                    "the same. Give one for all by --wheel-radius R",
                    least->name, most->name, smallest, largest));
  } else {
    vehicle.radius = 0.5 * (smallest + largest);
    findings.Guess("wheel radius", fmt::format("{:.5g} m", vehicle.radius),
                   "the round geoms of the wheels");
  }
  double bottom = 0.0;
  double highest = -1e300;
  double lowest = 1e300;
  for (const FoundWheel& wheel : wheels) {
    vehicle.width = std::max(vehicle.width, wheel.round.width);
    const double own = wheel.round.center.z() - vehicle.radius;
    bottom += own / static_cast<double>(wheels.size());
    highest = std::max(highest, own);
    lowest = std::min(lowest, own);
  }
  // Limit the tyre width to the wheel's radius: a wheel modeled as a ball has its diameter as
  // width, but a tyre is narrower.
  vehicle.width = std::min(vehicle.width, vehicle.radius);
  const std::size_t rear = wheels.size() - 2;
  const Vector middle = 0.5 * (wheels[rear].round.center + wheels[rear + 1].round.center);
  vehicle.origin = {middle.x(), middle.y(), bottom};
  if (highest - lowest > 0.02 * vehicle.radius) {
    findings.notes.push_back(fmt::format(
        "the lowest points of the tyres are up to {:.3g} m apart in height; the car stands level",
        highest - lowest));
  }
  const auto track = [&](std::size_t first) {
    return Along(vehicle, wheels[first], 1) - Along(vehicle, wheels[first + 1], 1);
  };
  vehicle.track = {track(0), track(rear)};
  if (wheels.size() == 4) {
    vehicle.wheelbase = 0.5 * (Along(vehicle, wheels[0], 0) + Along(vehicle, wheels[1], 0) -
                               Along(vehicle, wheels[2], 0) - Along(vehicle, wheels[3], 0));
    const double apart = std::abs(Along(vehicle, wheels[0], 0) - Along(vehicle, wheels[1], 0)) +
                         std::abs(Along(vehicle, wheels[2], 0) - Along(vehicle, wheels[3], 0));
    if (std::min(vehicle.track[0], vehicle.track[1]) < vehicle.width ||
        vehicle.wheelbase < vehicle.radius || apart > 0.5 * vehicle.wheelbase) {
      Ask(found, "wheels",
          fmt::format("the four wheels ({}) do not form two axles with a left and a right wheel "
                      "each: tracks of {:.3g} and {:.3g} m, wheelbase {:.3g} m",
                      Listed(wheels), vehicle.track[0], vehicle.track[1], vehicle.wheelbase));
    }
  }
}

}  // namespace

FoundVehicle FindVehicle(const FoundModel& found, const AdaptOptions& options, Findings& findings) {
  const mjModel& m = *found.model;
  if (!(m.opt.gravity[2] < 0.0 && std::hypot(m.opt.gravity[0], m.opt.gravity[1]) == 0.0)) {
    Ask(found, "option",
        fmt::format("gravity {:g} {:g} {:g} must point down, along -z", m.opt.gravity[0],
                    m.opt.gravity[1], m.opt.gravity[2]));
  }
  FoundVehicle vehicle;
  vehicle.wheels = FindWheels(found, options);
  ChooseVehicle(found, options, vehicle.wheels);
  if (vehicle.wheels.size() < 2) {
    RefuseCount(found, vehicle.wheels);
  }
  const int base = FindBase(m, vehicle.wheels);
  FindCarriers(found, base, vehicle.wheels);
  std::vector<FoundWheel> casters;
  std::erase_if(vehicle.wheels, [&](const FoundWheel& wheel) {
    const bool is_caster = IsCaster(found, wheel);
    if (is_caster) {
      casters.push_back(wheel);
    }
    return is_caster;
  });
  if (vehicle.wheels.empty()) {
    RefuseCount(found, casters);
  }
  vehicle.base = base;
  vehicle.root = m.body_rootid[base];
  RequireParallel(found, vehicle.wheels);
  AlignFrame(vehicle.wheels, vehicle);
  const std::size_t count = vehicle.wheels.size();
  const bool steers = std::any_of(vehicle.wheels.begin(), vehicle.wheels.end(),
                                  [](const FoundWheel& wheel) { return wheel.steer >= 0; });
  if (count == 2 && !steers) {
    vehicle.kind = VehicleKind::kDifferential;
    SortAxle(vehicle, vehicle.wheels.data());
    if (Along(vehicle, vehicle.wheels[0], 1) - Along(vehicle, vehicle.wheels[1], 1) <
        vehicle.wheels[0].round.radius) {
      RefuseCount(found, vehicle.wheels);
    }
    if (BodyDirection(found, vehicle) < 0) {
      Reverse(vehicle);
      SortAxle(vehicle, vehicle.wheels.data());
    }
  } else if (count == 4) {
    OrientCar(found, options, vehicle, findings);
  } else {
    RefuseCount(found, vehicle.wheels);
  }
  Measure(found, options, vehicle, findings);
  return vehicle;
}

}  // namespace trackbed::adapt
