#include "trackbed/sim/adapt.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "src/sim/adapt_faults.h"
#include "src/sim/adapt_write.h"
#include "src/sim/object_name.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/mujoco_error.h"

// Proposes a car file: reads the model (adapt_read), finds the vehicle (adapt_find) and its limits
// (adapt_limits), splits its mass among the parts (adapt_parts), and writes the file (adapt_write).
namespace trackbed {
namespace adapt {
namespace {

void NoteWheels(const FoundVehicle& vehicle, Findings& findings) {
  static constexpr std::array<const char*, 2> kSides{"left", "right"};
  const bool is_car = vehicle.kind == VehicleKind::kSteered;
  for (std::size_t w = 0; w < vehicle.wheels.size(); ++w) {
    const FoundWheel& wheel = vehicle.wheels[w];
    const Vector at = vehicle.ToVehicle(wheel.round.center);
    findings.Guess(
        fmt::format("wheel {}", is_car ? kWheels[w] : kSides[w]), wheel.name,
        wheel.spin < 0
            ? fmt::format("a round geom on the ground, at x {:.3f} y {:.3f} m; assumed: it turns",
                          at.x(), at.y())
        : wheel.round.geom < 0
            ? fmt::format("a hinge with a horizontal axis, at x {:.3f} y {:.3f} m", at.x(), at.y())
            : fmt::format("a round geom about a horizontal hinge, at x {:.3f} y {:.3f} m", at.x(),
                          at.y()));
  }
}

/// Returns the points on which a vehicle with differential drive stands, except for its driven
/// wheels.
std::vector<Vector> FindSupports(const FoundModel& found, const FoundVehicle& vehicle) {
  const mjModel& m = *found.model;
  std::vector<Vector> supports;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int body = m.geom_bodyid[geom];
    const bool collides = (m.geom_contype[geom] | m.geom_conaffinity[geom]) != 0;
    const bool is_wheel =
        std::any_of(vehicle.wheels.begin(), vehicle.wheels.end(), [&](const FoundWheel& wheel) {
          return m.body_weldid[body] == m.body_weldid[wheel.body] || wheel.round.geom == geom;
        });
    const auto below = ReachAlong(m, *found.data, geom, -Vector::UnitZ());
    if (m.body_rootid[body] != vehicle.root || !collides || is_wheel || !below ||
        -*below - vehicle.origin.z() > 0.25 * vehicle.radius) {
      continue;
    }
    const Vector at = vehicle.ToVehicle(ToVector(found.data->geom_xpos + 3 * geom));
    const double up = *ReachAlong(m, *found.data, geom, Vector::UnitZ()) - vehicle.origin.z();
    supports.emplace_back(at.x(), at.y(), std::min(0.5 * up, vehicle.radius));
  }
  return supports;
}

void FindWheelSpeed(const FoundModel& found, const FoundVehicle& vehicle, FoundLimits& limits,
                    Findings& findings) {
  const mjModel& m = *found.model;
  for (int i = 0; i < m.nu; ++i) {
    const bool is_servo =
        m.actuator_biasprm[mjNBIAS * i + 2] < 0.0 && m.actuator_biasprm[mjNBIAS * i + 1] == 0.0;
    if (is_servo && m.actuator_ctrllimited[i] != 0 && m.actuator_trntype[i] == mjTRN_JOINT &&
        m.actuator_trnid[2 * i] == vehicle.wheels[0].spin) {
      limits.wheel_speed =
          m.actuator_ctrlrange[2 * i + 1] / std::abs(static_cast<double>(m.actuator_gear[6 * i]));
      findings.Guess("wheel speed", fmt::format("{:.4g} rad/s", limits.wheel_speed),
                     "ctrlrange of the actuator " + ObjectName(m, mjOBJ_ACTUATOR, i));
      return;
    }
  }
  const double gravity = std::abs(m.opt.gravity[2]);
  limits.wheel_speed = 1.5 * std::sqrt(gravity * vehicle.track[1]) / vehicle.radius;
  findings.Guess(
      "wheel speed", fmt::format("{:.4g} rad/s", limits.wheel_speed),
      fmt::format("assumed: {:.3g} m/s, 1.5 sqrt(g track)", limits.wheel_speed * vehicle.radius));
}

bool HasSprings(const FoundVehicle& vehicle) {
  return vehicle.wheels.size() == 4 &&
         std::all_of(vehicle.wheels.begin(), vehicle.wheels.end(),
                     [](const FoundWheel& wheel) { return wheel.slide >= 0; });
}

void NoteMasses(const FoundVehicle& vehicle, const Proposal& proposal, const std::string& file,
                Findings& findings) {
  const MassSum& total = proposal.masses.total;
  const bool is_car = vehicle.kind == VehicleKind::kSteered;
  const bool between = !is_car || (total.center.x() > 0.0 && total.center.x() < vehicle.wheelbase);
  if (!(total.mass > 0.0) || !(proposal.masses.chassis.mass > 0.0) || !between) {
    throw InputError(Problem{
        .file = file,
        .key = "mass",
        .message = fmt::format("the mass of the vehicle is {:.4g} kg, with its center of gravity "
                               "{:.3g} m ahead of the rear axle; it must be above 0, and between "
                               "the axles. Give the bodies of the model their masses by <inertial>",
                               total.mass, total.center.x())});
  }
  const Footprint& box = proposal.footprint;
  const double density =
      total.mass / ((box.front - box.rear) * 2.0 * box.half_width * std::max(box.height, 1e-6));
  findings.Guess("mass", fmt::format("{:.5g} kg", total.mass),
                 fmt::format("all bodies of the model; center of gravity {:.3f} m ahead of the "
                             "{} axle, {:.3f} m high",
                             total.center.x(), is_car ? "rear" : "driven", total.center.z()));
  if (density > 1500.0 || density < 10.0) {
    findings.notes.push_back(fmt::format(
        "the mass is {:.3g} kg/m^3 of the vehicle's box, which is unusual; {}; correct the "
        "masses in the file",
        density,
        total.mass < 0.01 ? "links without <inertial> have almost no mass"
                          : "bodies of MJCF without <inertial> get 1000 kg/m^3 by MuJoCo"));
  }
}

}  // namespace

AdaptedModel Adapt(const FoundModel& found, const std::filesystem::path& file,
                   const AdaptOptions& options) {
  const MujocoErrorScope errors;
  Findings findings{.guesses = {}, .notes = found.notes};
  const FoundVehicle vehicle = FindVehicle(found, options, findings);
  NoteWheels(vehicle, findings);
  NoteFaults(found, vehicle, findings);
  Proposal proposal{.name = FileNameOf(file.stem().string()),
                    .source = FileNameOf(file.filename().string()),
                    .limits = {},
                    .masses = {},
                    .footprint = FindFootprint(found, vehicle),
                    .looks = {},
                    .gravity = std::abs(found.model->opt.gravity[2]),
                    .has_springs = HasSprings(vehicle),
                    .supports = {}};
  proposal.masses = SplitMasses(found, vehicle, proposal.has_springs, findings);
  NoteMasses(vehicle, proposal, found.file, findings);
  proposal.limits = FindLimits(found, vehicle, proposal.masses.total.mass, options, findings);
  const bool is_car = vehicle.kind == VehicleKind::kSteered;
  if (!is_car) {
    FindWheelSpeed(found, vehicle, proposal.limits, findings);
    proposal.supports = FindSupports(found, vehicle);
    if (proposal.supports.empty()) {
      throw InputError(Problem{
          .file = found.file,
          .key = "wheels",
          .message = "a robot with differential drive, and nothing but its two wheels touches the "
                     "ground. Give it a caster or skid: a colliding geom that reaches the ground"});
    }
    findings.Guess("supports", fmt::format("{} balls", proposal.supports.size()),
                   "geoms of the vehicle that reach the ground");
  } else {
    findings.Guess("suspension", proposal.has_springs ? "springs of the model" : "none",
                   proposal.has_springs ? "a slide joint with stiffness at each wheel"
                                        : "no vertical slide joint with stiffness at each wheel");
  }
  AdaptedModel adapted{.kind = vehicle.kind, .xml = "", .guesses = {}, .notes = {}};
  for (const bool as_boxes : {false, true}) {
    proposal.looks = CopyLooks(found, vehicle, as_boxes);
    adapted.xml = is_car ? WriteCar(found, vehicle, proposal, findings)
                         : WriteWheelPair(vehicle, proposal, findings);
    try {
      const CarModel check(Scene{.xml = adapted.xml, .assets = {}, .lines = {}}, found.file);
      break;
    } catch (const InputError&) {
      if (as_boxes || proposal.looks.meshes.empty()) {
        throw;
      }
    }
  }
  adapted.guesses = std::move(findings.guesses);
  adapted.notes = std::move(findings.notes);
  return adapted;
}

}  // namespace adapt

AdaptedModel AdaptModel(const std::filesystem::path& file, const AdaptOptions& options) {
  return adapt::Adapt(adapt::ReadFound(file, options), file, options);
}

}  // namespace trackbed
