#include "trackbed/sim/trailer_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "src/sim/car_parts.h"
#include "src/sim/scene_xml.h"
#include "src/sim/spring_preload.h"
#include "src/sim/trailer_parts.h"
#include "trackbed/core/error.h"

// Adds a trailer with one axle to the MJCF of its car.
// 1. The body of the trailer has three hinges at the hitch. Positions of its parts are relative to
//    the hitch.
// 2. Wheels, tyres and springs are copies of those of the car's rear axle, with masses and sizes
//    scaled to the trailer.
// 3. The mass, center of gravity and yaw inertia of the body are computed such that the whole
//    trailer has the specified values.
// 4. Stiffness and damping of the trailer's springs are computed from a deflection at rest and a
//    damping ratio.
namespace trackbed {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Deflection of a trailer spring at rest, as a fraction of the wheel's radius. For a wheel radius
/// of 0.31 m, the trailer's natural frequency on its springs is 1.5 Hz.
constexpr double kSpringDeflection = 0.35;
constexpr double kDampingRatio = 0.3;
/// Travel of the suspension in each direction, as a fraction of the wheel's radius.
constexpr double kTravel = 0.25;
/// Ratio of half width to radius for a tyre whose geom in the car's file is not an ellipsoid.
constexpr double kTyreWidth = 0.3;

/// Adds the MJCF of a trailer to that of its car. Positions of the trailer's parts are relative to
/// the hitch.
class TrailerWriter {
 public:
  TrailerWriter(const CarModel& car, const TrailerParams& trailer)
      : car_(car),
        model_(*car.get()),
        trailer_(trailer),
        sprung_(HasSpring(car, kRearLeft)),
        scale_(2.0 * trailer.mass / car.params().mass),
        size_(trailer.wheel_radius / car.params().wheel_radius),
        hub_z_(size_ * car.parts().hub_height[kRearLeft] - trailer.hitch_height) {
    const int wheel = car.parts().wheel[kRearLeft];
    wheel_mass_ = scale_ * model_.body_mass[wheel];
    for (int body = model_.body_parentid[wheel]; body > 0 && body != car.chassis().chassis;
         body = model_.body_parentid[body]) {
      carrier_mass_ += sprung_ ? scale_ * model_.body_mass[body] : 0.0;
    }
  }

  void Write(XMLElement& chassis) {
    XMLElement& body =
        AddBody(chassis, kTrailerBody, {-trailer_.hitch, 0.0, trailer_.hitch_height});
    static constexpr std::array kAxes{"0 0 1", "0 1 0", "1 0 0"};
    for (std::size_t i = 0; i < kHitchJoints.size(); ++i) {
      AddJoint(body, kHitchJoints[i], "hinge", kAxes[i]);
    }
    WriteInertia(body);
    WriteLooks(body);
    WriteShell(body);
    for (std::size_t w = 0; w < kTrailerSides.size(); ++w) {
      WriteWheel(body, kTrailerSides[w], (w == 0 ? 0.5 : -0.5) * trailer_.track);
    }
  }

 private:
  static constexpr std::size_t kRearLeft = 2;
  using Position = std::array<double, 3>;

  static std::string Text(const Position& numbers) {
    return fmt::format("{}", fmt::join(numbers, " "));
  }

  static XMLElement& AddBody(XMLElement& parent, const std::string& name, const Position& at) {
    XMLElement* body = parent.InsertNewChildElement("body");
    body->SetAttribute("name", name.c_str());
    body->SetAttribute("pos", Text(at).c_str());
    return *body;
  }

  /// Adds a joint of the trailer that exerts no forces. All attributes of this joint are set, so
  /// that the defaults in the car's file do not apply.
  static XMLElement& AddJoint(XMLElement& body, const std::string& name, const char* type,
                              const char* axis) {
    XMLElement* joint = body.InsertNewChildElement("joint");
    joint->SetAttribute("name", name.c_str());
    joint->SetAttribute("type", type);
    joint->SetAttribute("axis", axis);
    joint->SetAttribute("pos", "0 0 0");
    for (const char* nothing : {"damping", "stiffness", "armature", "frictionloss", "ref"}) {
      joint->SetAttribute(nothing, 0);
    }
    joint->SetAttribute("limited", false);
    return *joint;
  }

  static void AddInertial(XMLElement& body, double mass, const Position& at,
                          const Position& inertia) {
    XMLElement* inertial = body.InsertNewChildElement("inertial");
    inertial->SetAttribute("pos", Text(at).c_str());
    inertial->SetAttribute("mass", Numbers({mass}).c_str());
    inertial->SetAttribute("diaginertia", Text(inertia).c_str());
  }

  static XMLElement& AddLook(XMLElement& body, const char* type, const Position& size,
                             const Position& at, const char* rgba) {
    XMLElement* geom = body.InsertNewChildElement("geom");
    geom->SetAttribute("type", type);
    geom->SetAttribute("size", Text(size).c_str());
    geom->SetAttribute("pos", Text(at).c_str());
    geom->SetAttribute("contype", 0);
    geom->SetAttribute("conaffinity", 0);
    geom->SetAttribute("group", 1);
    geom->SetAttribute("mass", 0);
    geom->SetAttribute("rgba", rgba);
    return *geom;
  }

  [[nodiscard]] double unsprung() const { return 2.0 * (wheel_mass_ + carrier_mass_); }

  /// Inertia of a wheel: transverse, spin, transverse [kg m^2].
  [[nodiscard]] Position WheelInertia() const {
    const int wheel = car_.parts().wheel[kRearLeft];
    const mjtNum* own = model_.body_inertia + 3 * wheel;
    const double factor = scale_ * size_ * size_;
    const double spin = factor * car_.parts().spin_inertia[kRearLeft];
    const double transverse = 0.5 * (factor * (own[0] + own[1] + own[2]) - spin);
    return {transverse, spin, transverse};
  }

  /// Inertia of the body that carries a wheel, about each of its axes; 0 without springs [kg m^2].
  [[nodiscard]] double CarrierInertia() const {
    return carrier_mass_ * trailer_.wheel_radius * trailer_.wheel_radius / 8.0;
  }

  /// Sets mass, center of gravity and inertia of the body such that the whole trailer has the
  /// specified values.
  void WriteInertia(XMLElement& body) const {
    const double mass = trailer_.mass - unsprung();
    const double axle = -trailer_.tongue;
    const double cg = axle + trailer_.cg_ahead;
    const double x = (trailer_.mass * cg - unsprung() * axle) / mass;
    const double z =
        (trailer_.mass * (trailer_.cg_height - trailer_.hitch_height) - unsprung() * hub_z_) / mass;
    const double half_track = 0.5 * trailer_.track;
    const double of_wheels =
        2.0 * (WheelInertia()[0] + CarrierInertia()) +
        unsprung() * (trailer_.cg_ahead * trailer_.cg_ahead + half_track * half_track);
    const double yaw = trailer_.yaw_inertia - of_wheels - mass * (x - cg) * (x - cg);
    if (!(yaw > 0.0)) {
      throw InputError(
          Problem{.key = "vehicle.trailer.yaw_inertia",
                  .message = fmt::format("{:.4g} kg m^2 is not more than what wheels and center of "
                                         "gravity have; must be above {:.4g} kg m^2",
                                         trailer_.yaw_inertia, trailer_.yaw_inertia - yaw)});
    }
    // roll and pitch inertia of a uniform box with the size of the body and this yaw inertia
    const double l = trailer_.length;
    const double w = trailer_.width;
    const double h = trailer_.height;
    const double unit = yaw / (l * l + w * w);
    AddInertial(body, mass, {x, 0.0, z}, {unit * (w * w + h * h), unit * (l * l + h * h), yaw});
  }

  void WriteLooks(XMLElement& body) const {
    const double bottom = hub_z_;
    const double top = trailer_.height - trailer_.hitch_height;
    const double middle = -(trailer_.tongue - trailer_.body_ahead);
    AddLook(body, "box",
            {0.5 * trailer_.length, 0.5 * trailer_.width, 0.5 * std::abs(top - bottom)},
            {middle, 0.0, 0.5 * (top + bottom)}, "0.78 0.79 0.80 1");
    const double thick = 0.1 * trailer_.wheel_radius;
    const double front = trailer_.body_front();
    AddLook(body, "box", {0.5 * front, thick, thick}, {-0.5 * front, 0.0, 0.0}, "0.2 0.2 0.22 1");
  }

  /// Adds the box that touches obstacles, like the shell of the car (WithObstacles).
  void WriteShell(XMLElement& body) const {
    const double half_height = 0.45 * trailer_.height;
    XMLElement& shell =
        AddLook(body, "box", {0.5 * trailer_.length, 0.5 * trailer_.width, half_height},
                {trailer_.body_ahead - trailer_.tongue, 0.0,
                 trailer_.height - half_height - trailer_.hitch_height},
                "0 0 0 0");
    shell.SetAttribute("name", "trailer_shell");
    shell.SetAttribute("contype", 2);
    shell.SetAttribute("group", 4);
  }

  void WriteWheel(XMLElement& body, const std::string& side, double y) const {
    XMLElement* parent = &body;
    Position at{-trailer_.tongue, y, hub_z_};
    if (sprung_) {
      XMLElement& carrier = AddBody(body, "carrier_" + side, at);
      const double part = CarrierInertia();
      AddInertial(carrier, carrier_mass_, {}, {part, part, part});
      WriteSpring(carrier, side);
      parent = &carrier;
      at = {};
    }
    XMLElement& wheel = AddBody(*parent, "wheel_" + side, at);
    AddInertial(wheel, wheel_mass_, {}, WheelInertia());
    AddJoint(wheel, "spin_" + side, "hinge", "0 1 0");
    WriteTyre(wheel, "tyre_" + side);
  }

  /// Adds the spring and the damper of a wheel, in equilibrium at rest.
  void WriteSpring(XMLElement& carrier, const std::string& side) const {
    const double gravity = std::abs(model_.opt.gravity[2]);
    const double load = 0.5 * trailer_.mass * (1.0 - trailer_.nose_share());  // [kg]
    const double stiffness = load * gravity / (kSpringDeflection * trailer_.wheel_radius);
    const double carried = (load - 0.5 * unsprung()) * gravity;
    const double travel = kTravel * trailer_.wheel_radius;
    XMLElement& joint = AddJoint(carrier, "suspension_" + side, "slide", "0 0 1");
    joint.SetAttribute("stiffness", Numbers({stiffness}).c_str());
    joint.SetAttribute("damping",
                       Numbers({2.0 * kDampingRatio * std::sqrt(stiffness * load)}).c_str());
    joint.SetAttribute("springref", Numbers({-carried / stiffness}).c_str());
    joint.SetAttribute("limited", true);
    joint.SetAttribute("range", Numbers({-travel, travel}).c_str());
    joint.SetAttribute("solreflimit", "0.02 1");
    joint.SetAttribute("solimplimit", "0.9 0.95 0.01");
  }

  /// Adds the collision geom of a tyre, with the contact parameters of the car's rear tyre.
  void WriteTyre(XMLElement& wheel, const std::string& name) const {
    const int like = car_.parts().tyre[kRearLeft];
    const double radius = trailer_.wheel_radius;
    const double half_width = model_.geom_type[like] == mjGEOM_ELLIPSOID
                                  ? size_ * model_.geom_size[3 * like + 1]
                                  : kTyreWidth * radius;
    const auto numbers = [](const mjtNum* values, int count) {
      return fmt::format("{}", fmt::join(values, values + count, " "));
    };
    XMLElement& geom =
        AddLook(wheel, "ellipsoid", {radius, half_width, radius}, {}, "0.3 0.6 0.9 0.4");
    geom.SetAttribute("name", name.c_str());
    geom.SetAttribute("group", 3);
    geom.SetAttribute("contype", model_.geom_contype[like]);
    geom.SetAttribute("conaffinity", model_.geom_conaffinity[like]);
    geom.SetAttribute("condim", model_.geom_condim[like]);
    geom.SetAttribute("priority", model_.geom_priority[like]);
    geom.SetAttribute("friction", numbers(model_.geom_friction + 3 * like, 3).c_str());
    geom.SetAttribute("solref", numbers(model_.geom_solref + mjNREF * like, mjNREF).c_str());
    geom.SetAttribute("solimp", numbers(model_.geom_solimp + mjNIMP * like, mjNIMP).c_str());
    geom.SetAttribute("solmix", model_.geom_solmix[like]);
    geom.SetAttribute("margin", model_.geom_margin[like]);
    geom.SetAttribute("gap", model_.geom_gap[like]);
    XMLElement& look =
        AddLook(wheel, "cylinder", {0.98 * radius, 0.95 * half_width, 0.0}, {}, "0.09 0.09 0.10 1");
    look.SetAttribute("quat", "0.7071067811865476 0.7071067811865476 0 0");
  }

  const CarModel& car_;
  const mjModel& model_;
  TrailerParams trailer_;
  bool sprung_;
  double scale_;               // Unsprung mass per trailer wheel, divided by that per rear wheel of
                               // the car.
  double size_;                // Radius of a trailer wheel, divided by that of the car's rear
                               // wheel.
  double hub_z_;               // Height of the wheel centers above the hitch [m].
  double wheel_mass_ = 0.0;    // [kg]
  double carrier_mass_ = 0.0;  // Mass of the body that carries a wheel [kg].
};

}  // namespace

Scene WithTrailer(const CarModel& car, const TrailerParams& trailer) {
  static_cast<void>(SteeredParts(car, "vehicle.trailer"));
  XMLDocument document;
  ParseComposed(car.scene().xml, document);
  XMLElement& root = *document.RootElement();
  if (FindInWorld(root, "body", kTrailerBody) != nullptr) {
    throw InputError(Problem{
        .file = car.file(),
        .key = "vehicle.trailer",
        .message = "the model already has a body 'trailer'; remove this or rename the body"});
  }
  XMLElement* chassis = FindInWorld(root, "body", "chassis");
  TRACKBED_CHECK(chassis != nullptr, "the car has no body 'chassis'");
  TrailerWriter(car, trailer).Write(*chassis);
  XMLElement* numeric = root.InsertNewChildElement("custom")->InsertNewChildElement("numeric");
  numeric->SetAttribute("name", kTrailerNumeric);
  numeric->SetAttribute("data", fmt::format("{}", fmt::join(TrailerNumbers(trailer), " ")).c_str());
  const auto [front, rear] =
      NoseLoads(trailer, car.params().wheelbase, std::abs(car.get()->opt.gravity[2]));
  PreloadSprings(car, root, {0.5 * front, 0.5 * front, 0.5 * rear, 0.5 * rear}, "vehicle.trailer");
  Scene scene = car.scene();
  scene.xml = Print(document);
  scene.lines.clear();
  return scene;
}

}  // namespace trackbed
