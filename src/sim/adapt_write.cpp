#include "src/sim/adapt_write.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "src/sim/scene_xml.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/linkage.h"

// Writes the file of an adapted car, with the names and conventions of docs/models.md.
// 1. Each function returns the MJCF text of one part of the file: head, defaults, assets, chassis,
//    wheels, steering linkage, numbers, actuators.
// 2. Numbers that the adapted model does not state are computed from its masses and sizes. The
//    steering servo is critically damped. The bearing friction is a thousandth of the weight on the
//    wheels.
// 3. Comments in the written file state the source of each number.
namespace trackbed::adapt {
namespace {

/// Time constant of the steering servo [s]. For critical damping of the servo, kp = 4 I/tau^2 and
/// damping = 4 I/tau, with the turned inertia I and the time constant tau.
constexpr double kServoTime = 0.01;
/// Magic Formula coefficients of rubber on dry ground, for forces relative to the wheel load.
constexpr const char* kTyreCoefficients =
    R"(    <numeric name="p_cx1" data="1.6"/>
    <numeric name="p_kx1" data="12"/>
    <numeric name="p_cy1" data="1.4"/>
    <numeric name="p_ky1" data="-8"/>
)";

std::string Comment(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) {
    text.replace(at, 2, "- -");  // XML does not allow "--" inside a comment
  }
  return text;
}

std::string Text(const Vector& v) {
  return Numbers({v.x(), v.y(), v.z()});
}

std::string Inertial(const MassSum& part, const Vector& origin) {
  const Matrix& i = part.inertia;
  const double off = std::max({std::abs(i(0, 1)), std::abs(i(0, 2)), std::abs(i(1, 2))});
  const std::string moments =
      off < 1e-9 * i.trace()
          ? fmt::format("diaginertia=\"{}\"", Numbers({i(0, 0), i(1, 1), i(2, 2)}))
          : fmt::format("fullinertia=\"{}\"",
                        Numbers({i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)}));
  return fmt::format("<inertial pos=\"{}\" mass=\"{}\" {}/>", Text(part.center - origin), part.mass,
                     moments);
}

std::string Numeric(const char* name, double value, const std::string& comment) {
  return fmt::format("    <!-- {} -->\n    <numeric name=\"{}\" data=\"{:.6g}\"/>\n",
                     Comment(comment), name, value);
}

std::string Head(const FoundVehicle& vehicle, const Proposal& proposal, const Findings& findings) {
  std::string text = fmt::format(
      "<mujoco model=\"{}\">\n  <!--\n    Proposed by `trackbed model` from {}. SI "
      "units, radians, kg; names and frame as in docs/models.md.\n",
      proposal.name, Comment(proposal.source));
  for (const AdaptGuess& guess : findings.guesses) {
    text += Comment(fmt::format("    {}: {} ({})\n", guess.what, guess.value, guess.evidence));
  }
  const double length = proposal.footprint.front - proposal.footprint.rear;
  text += fmt::format(
      "  -->\n  <compiler angle=\"radian\"/>\n"
      "  <option timestep=\"0.002\" integrator=\"Euler\" cone=\"elliptic\" impratio=\"10\" "
      "solver=\"Newton\" tolerance=\"1e-10\" gravity=\"0 0 {}\"/>\n"
      "  <statistic center=\"{:.4g} 0 {:.4g}\" extent=\"{:.4g}\"/>\n"
      "  <visual>\n    <global offwidth=\"1920\" offheight=\"1080\"/>\n"
      "    <map znear=\"0.01\" zfar=\"200\"/>\n  </visual>\n",
      -proposal.gravity, 0.5 * vehicle.wheelbase, vehicle.radius, 1.5 * length);
  return text;
}

std::string Defaults(const FoundVehicle& vehicle, const Proposal& proposal) {
  return fmt::format(
      "  <default>\n"
      "    <default class=\"look\">\n"
      "      <geom contype=\"0\" conaffinity=\"0\" group=\"1\" mass=\"0\"/>\n    </default>\n"
      "    <!-- An ellipsoid touches the ground at one point. -->\n"
      "    <default class=\"tyre\">\n"
      "      <geom type=\"ellipsoid\" size=\"{0} {1:.5g} {0}\" group=\"3\" rgba=\"0.3 0.6 0.9 "
      "0.4\" mass=\"0\" priority=\"1\" condim=\"3\" friction=\"{2:.4g} 0.0005 0.00001\" "
      "solref=\"0.005 1\" solimp=\"0.995 0.995 0.001\"/>\n    </default>\n"
      "    <default class=\"spin\">\n"
      "      <joint type=\"hinge\" axis=\"0 1 0\" frictionloss=\"{3:.3g}\" solreffriction=\"0.004 "
      "1\" solimpfriction=\"0.9999 0.9999 0.001\"/>\n    </default>\n  </default>\n",
      vehicle.radius, 0.5 * vehicle.width, proposal.limits.friction,
      // The bearing friction force is a thousandth of the weight on the wheels.
      0.001 * proposal.masses.total.mass * proposal.gravity * vehicle.radius /
          static_cast<double>(vehicle.wheels.size()));
}

std::string Assets(const Proposal& proposal) {
  return proposal.looks.meshes.empty() ? ""
                                       : "  <asset>\n" + proposal.looks.meshes + "  </asset>\n";
}

std::string FootprintSite(const Footprint& box) {
  return fmt::format(
      "      <site name=\"footprint\" type=\"box\" group=\"4\" pos=\"{:.6g} 0 {:.6g}\" "
      "size=\"{:.6g} {:.6g} {:.6g}\" rgba=\"0.2 0.6 1 0.15\"/>\n",
      0.5 * (box.front + box.rear), 0.5 * box.height, 0.5 * (box.front - box.rear), box.half_width,
      0.5 * box.height);
}

std::string Chassis(const Proposal& proposal) {
  return "  <worldbody>\n"
         "    <geom name=\"ground\" type=\"plane\" size=\"0 0 1\" rgba=\"0.6 0.63 0.61 1\"/>\n"
         "    <body name=\"chassis\">\n      <joint name=\"chassis\" type=\"free\"/>\n      " +
         Inertial(proposal.masses.chassis, Vector::Zero()) +
         "\n      <light mode=\"trackcom\" directional=\"true\" pos=\"-0.2 0.4 0.9\" dir=\"0.3 "
         "-0.4 "
         "-0.8\"/>\n" +
         FootprintSite(proposal.footprint) + proposal.looks.chassis;
}

std::string Wheel(const Proposal& proposal, std::size_t w, const std::string& name,
                  const Vector& at, const Vector& hub) {
  return fmt::format(
      "<body name=\"wheel_{0}\" pos=\"{1}\">\n          {2}\n          <joint name=\"spin_{0}\" "
      "class=\"spin\"/>\n          <geom name=\"tyre_{0}\" class=\"tyre\"/>\n{3}        </body>\n",
      name, Text(at), Inertial(proposal.masses.wheels[w], hub), proposal.looks.wheels[w]);
}

/// Parameters of the car on which the steering linkage depends.
VehicleParams LinkageParams(const FoundVehicle& vehicle, const Proposal& proposal) {
  VehicleParams params;
  params.wheelbase = vehicle.wheelbase;
  params.track_front = vehicle.track[0];
  params.track_rear = vehicle.track[1];
  params.steering_limit = proposal.limits.steering_limit;
  return params;
}

/// Returns the slide joint of a suspension with the spring of the model. The preload of the springs
/// carries the sprung mass at qpos0.
std::string Spring(const FoundModel& found, const FoundVehicle& vehicle, const Proposal& proposal,
                   std::size_t w) {
  const mjModel& m = *found.model;
  const int slide = vehicle.wheels[w].slide;
  const PartMasses& masses = proposal.masses;
  const double moment =
      masses.chassis.mass * masses.chassis.center.x() + masses.rack.mass * masses.rack.center.x();
  const double front = moment / vehicle.wheelbase;
  const double sprung = masses.chassis.mass + masses.rack.mass;
  const double load = 0.5 * proposal.gravity * (w < 2 ? front : sprung - front);
  const double stiffness = m.jnt_stiffness[slide];
  const double travel = 0.5 * vehicle.radius;
  return fmt::format(
      "        <joint name=\"suspension_{}\" type=\"slide\" axis=\"0 0 1\" limited=\"true\" "
      "range=\"{:.5g} {:.5g}\" stiffness=\"{:.6g}\" damping=\"{:.6g}\" springref=\"{:.8g}\"/>\n",
      kWheels[w], -travel, travel, stiffness, m.dof_damping[m.jnt_dofadr[slide]],
      -load / stiffness);
}

std::string Corner(const FoundModel& found, const FoundVehicle& vehicle, const Proposal& proposal,
                   std::size_t w) {
  const Vector hub = HubOf(vehicle, w);
  const MassSum& knuckle = proposal.masses.knuckles[w];
  if (knuckle.mass <= 0.0) {
    return "      " + Wheel(proposal, w, kWheels[w], hub, hub);
  }
  const FrontAngles most =
      AckermannAngles(LinkageParams(vehicle, proposal), proposal.limits.steering_limit);
  std::string joints = proposal.has_springs ? Spring(found, vehicle, proposal, w) : "";
  if (w < 2) {
    const double range = 0.05 + most.left;
    joints += fmt::format(
        "        <joint name=\"steer_{}\" type=\"hinge\" axis=\"0 0 1\" limited=\"true\" "
        "range=\"{:.5g} {:.5g}\"/>\n",
        kWheels[w], -range, range);
  }
  return fmt::format(
      "      <body name=\"knuckle_{}\" pos=\"{}\">\n        {}\n{}        {}      "
      "</body>\n",
      kWheels[w], Text(hub), Inertial(knuckle, hub), joints,
      Wheel(proposal, w, kWheels[w], Vector::Zero(), hub));
}

std::string CarNumerics(const FoundVehicle& vehicle, const Proposal& proposal) {
  const MassSum& total = proposal.masses.total;
  const double friction = proposal.limits.friction;
  const double brakes = 0.5 * friction * total.mass * proposal.gravity * vehicle.radius;
  const double share =
      std::clamp((total.center.x() + friction * total.center.z()) / vehicle.wheelbase, 0.4, 0.8);
  const double tyre = 0.25 * total.mass * proposal.gravity / (0.06 * vehicle.radius);
  return "  <custom>\n" +
         Numeric("steering_ratio", vehicle.wheelbase > 2.0 ? 15.0 : 1.0,
                 "assumed: steering wheel or servo angle over road-wheel angle") +
         Numeric("brake_torque_front", share * brakes,
                 "assumed: the brakes use the friction of the tyres, front and rear alike") +
         Numeric("brake_torque_rear", (1.0 - share) * brakes, "assumed") +
         "    <!-- assumed: rubber on dry ground, with the friction of the contacts -->\n" +
         kTyreCoefficients +
         fmt::format(
             "    <numeric name=\"p_dx1\" data=\"{0:.4g}\"/>\n    <numeric name=\"p_dy1\" "
             "data=\"{0:.4g}\"/>\n",
             friction) +
         Numeric("relaxation_length", vehicle.radius, "assumed: a wheel radius") +
         Numeric("tyre_vertical_stiffness", tyre,
                 "assumed: 6 % of the radius under a quarter of the weight") +
         Numeric("tyre_vertical_damping", 0.6 * std::sqrt(0.25 * tyre * total.mass),
                 "assumed: 0.3 of critical damping") +
         "  </custom>\n";
}

std::string CarActuators(const FoundVehicle& vehicle, const Proposal& proposal, double stiffness) {
  int driven = 0;
  for (std::size_t w = 0; w < 4; ++w) {
    driven += proposal.limits.driven[w] ? 1 : 0;
  }
  std::string text = "  <tendon>\n    <fixed name=\"differential\">\n";
  for (std::size_t w = 0; w < 4; ++w) {
    if (proposal.limits.driven[w]) {
      text +=
          fmt::format("      <joint joint=\"spin_{}\" coef=\"{}\"/>\n", kWheels[w], 1.0 / driven);
    }
  }
  const LinkagePolynomials fit = FitLinkage(LinkageParams(vehicle, proposal));
  text += "    </fixed>\n  </tendon>\n  <equality>\n";
  for (const auto& [side, numbers] : {std::pair("fl", fit.left), std::pair("fr", fit.right)}) {
    text += fmt::format(
        "    <joint name=\"ackermann_{0}\" joint1=\"steer_{0}\" joint2=\"rack\" "
        "polycoef=\"{1}\" solref=\"0.004 1\" solimp=\"0.99 0.999 0.001\"/>\n",
        side, fmt::format("{:.6g}", fmt::join(numbers, " ")));
  }
  text += fmt::format(
      "  </equality>\n  <actuator>\n"
      "    <motor name=\"drive\" tendon=\"differential\" gear=\"1\" ctrllimited=\"true\" "
      "ctrlrange=\"-{0:.5g} {0:.5g}\"/>\n"
      "    <intvelocity name=\"steer\" joint=\"rack\" kp=\"{1:.6g}\" ctrllimited=\"true\" "
      "ctrlrange=\"-{2:.5g} {2:.5g}\" actrange=\"-{3:.6g} {3:.6g}\"/>\n  </actuator>\n",
      proposal.limits.drive_torque, stiffness, proposal.limits.steering_rate,
      proposal.limits.steering_limit);
  return text;
}

}  // namespace

std::string WriteCar(const FoundModel& found, const FoundVehicle& vehicle, const Proposal& proposal,
                     const Findings& findings) {
  const PartMasses& masses = proposal.masses;
  // Inertia of the rack and of the front wheels about their steering axes [kg m^2].
  double turned = masses.rack.inertia(2, 2);
  for (std::size_t w = 0; w < 2; ++w) {
    turned += masses.wheels[w].inertia(2, 2) + masses.knuckles[w].inertia(2, 2);
  }
  // The full lateral force of the front axle, with a trail of 0.1 wheel radii, deflects the
  // steering servo by at most 0.005 rad.
  const double least =
      10.0 * proposal.limits.friction * masses.total.mass * proposal.gravity * vehicle.radius;
  const double inertia = std::max(1.5 * turned, 0.25 * least * kServoTime * kServoTime);
  const double stiffness = 4.0 * inertia / (kServoTime * kServoTime);
  std::string text = Head(vehicle, proposal, findings) + CarNumerics(vehicle, proposal) +
                     Defaults(vehicle, proposal) + Assets(proposal) + Chassis(proposal);
  text += fmt::format(
      "      <!-- The servo: its angle is the bicycle angle. Critically damped, 10 ms of lag. -->\n"
      "      <body name=\"rack\" pos=\"{}\">\n        {}\n        <joint name=\"rack\" "
      "type=\"hinge\" axis=\"0 0 1\" damping=\"{:.6g}\" armature=\"{:.6g}\"/>\n      </body>\n",
      Text(masses.rack.center), Inertial(masses.rack, masses.rack.center),
      4.0 * inertia / kServoTime, inertia - turned);
  for (std::size_t w = 0; w < 4; ++w) {
    text += Corner(found, vehicle, proposal, w);
  }
  return text + "    </body>\n  </worldbody>\n" + CarActuators(vehicle, proposal, stiffness) +
         "</mujoco>\n";
}

std::string WriteWheelPair(const FoundVehicle& vehicle, const Proposal& proposal,
                           const Findings& findings) {
  const MassSum& total = proposal.masses.total;
  const double radius = vehicle.radius;
  const double track = vehicle.track[1];
  const double torque = 0.5 * proposal.limits.drive_torque;
  // The inertia of a wheel motor is an eighth of the vehicle's mass times the squared wheel radius.
  // While a wheel slips, its servo responds within two steps of 2 ms. The servos' integral term is
  // critically damped against the yaw inertia.
  const double own = 0.125 * total.mass * radius * radius;
  const double armature = std::max(0.0, own - proposal.masses.wheels[0].inertia(1, 1));
  const double gain = std::max(own / 0.004, 4.0 * torque / proposal.limits.wheel_speed);
  const double felt =
      own + 2.0 * (total.inertia(2, 2) + total.mass * total.center.x() * total.center.x()) *
                radius * radius / (track * track);
  std::string text =
      Head(vehicle, proposal, findings) + "  <custom>\n" +
      Numeric("turning_radius", 2.0 / 3.0 * track, "assumed: two thirds of the track") +
      Numeric("steering_rate", 1.0, "assumed: rate of atan((v_R - v_L)/v)") +
      Numeric("integral_time", 4.0 * felt / gain, "critical damping of the servos") +
      Numeric("brake_torque",
              0.5 * proposal.limits.friction * total.mass * proposal.gravity * radius,
              "assumed: the friction of the tyres") +
      "  </custom>\n" + Defaults(vehicle, proposal) + Assets(proposal) + Chassis(proposal);
  for (const Vector& at : proposal.supports) {
    text += fmt::format(
        "      <geom type=\"sphere\" pos=\"{0:.6g} {1:.6g} {2:.6g}\" size=\"{2:.6g}\" group=\"3\" "
        "mass=\"0\" priority=\"2\" condim=\"1\" solref=\"0.01 1\" solimp=\"0.995 0.995 0.001\"/>\n",
        at.x(), at.y(), at.z());
  }
  constexpr std::array<const char*, 2> kSides{"left", "right"};
  for (std::size_t w = 0; w < 2; ++w) {
    const Vector hub = HubOf(vehicle, w);
    text += "      " + Wheel(proposal, w, kSides[w], hub, hub);
  }
  text += "    </body>\n  </worldbody>\n  <actuator>\n";
  for (const char* side : kSides) {
    text += fmt::format(
        "    <velocity name=\"drive_{0}\" joint=\"spin_{0}\" kv=\"{1:.6g}\" ctrllimited=\"true\" "
        "ctrlrange=\"-{2:.6g} {2:.6g}\" forcelimited=\"true\" forcerange=\"-{3:.6g} {3:.6g}\"/>\n",
        side, gain, proposal.limits.wheel_speed, torque);
  }
  const std::string spin = "class=\"spin\"/>";
  for (std::size_t at = 0; (at = text.find(spin, at)) != std::string::npos;) {
    const std::string with = fmt::format("class=\"spin\" armature=\"{:.6g}\"/>", armature);
    text.replace(at, spin.size(), with);
    at += with.size();
  }
  return text + "  </actuator>\n</mujoco>\n";
}

}  // namespace trackbed::adapt
