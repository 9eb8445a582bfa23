#include "trackbed/sim/car_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "src/sim/scene_xml.h"
#include "src/sim/spring_preload.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

// Reads car parameters by name from a compiled model, and writes new values into the model's scene.
//
// A parameter is an entry of <custom><numeric>, a range of an actuator, or a property of the whole
// vehicle. To change a property of the whole vehicle, such as the mass, the mass, center of gravity
// or inertia of the chassis is changed. The chassis gets the values with which the chassis and all
// other bodies together have the wanted property (parallel axis theorem). The spring preload is
// adapted to the changed wheel loads, so the ride height at rest does not change.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

[[noreturn]] void Fail(const CarModel& car, const std::string& name, std::string message) {
  throw InputError(Problem{.file = car.file(), .key = name, .message = std::move(message)});
}

/// Names of the properties of the whole vehicle, which are set by changing the mass, center of
/// gravity or inertia of the chassis.
enum class Mass { kMass, kCgToRear, kCgHeight, kYawInertia };

/// A car parameter that is stored as the control or activation range of an actuator. The
/// parameter's value is the upper end of the actuator's range, which may be symmetric about 0.
struct ActuatorRange {
  const char* actuator;
  const char* attribute;
  const mjtNum* (*range)(const CarModel& car);
};

const std::map<std::string, Mass>& Masses() {
  static const std::map<std::string, Mass> table{{"mass", Mass::kMass},
                                                 {"cg_to_rear", Mass::kCgToRear},
                                                 {"cg_height", Mass::kCgHeight},
                                                 {"yaw_inertia", Mass::kYawInertia}};
  return table;
}

const std::map<std::string, ActuatorRange>& Ranges() {
  static const std::map<std::string, ActuatorRange> table{
      {"steering_rate",
       {"steer", "ctrlrange",
        [](const CarModel& car) -> const mjtNum* {
          return car.get()->actuator_ctrlrange +
                 2 * static_cast<std::ptrdiff_t>(car.parts().steer_actuator);
        }}},
      {"steering_limit",
       {"steer", "actrange",
        [](const CarModel& car) -> const mjtNum* {
          return car.get()->actuator_actrange +
                 2 * static_cast<std::ptrdiff_t>(car.parts().steer_actuator);
        }}},
      {"drive_torque", {"drive", "ctrlrange", [](const CarModel& car) -> const mjtNum* {
                          return car.get()->actuator_ctrlrange +
                                 2 * static_cast<std::ptrdiff_t>(car.parts().drive_actuator);
                        }}}};
  return table;
}

/// Name of a <numeric> element and index of one of its numbers, as in "steering_curve[3]".
struct NumericName {
  std::string name;
  std::size_t index = 0;
};

NumericName ParseNumeric(const std::string& name) {
  const std::size_t bracket = name.find('[');
  if (bracket == std::string::npos || name.back() != ']') {
    return {name};
  }
  std::size_t index = 0;
  const char* end = name.data() + name.size() - 1;
  const auto [at, error] = std::from_chars(name.data() + bracket + 1, end, index);
  return error == std::errc() && at == end ? NumericName{name.substr(0, bracket), index}
                                           : NumericName{name};
}

/// Returns the numbers of a <numeric> element; empty if the model has no such element. Every car
/// has a steering offset, which is 0 if the model has no such element.
std::vector<double> NumericData(const CarModel& car, const std::string& name) {
  const mjModel& model = *car.get();
  const int id = mj_name2id(&model, mjOBJ_NUMERIC, name.c_str());
  if (id < 0) {
    return name == kSteeringOffset ? std::vector<double>{0.0} : std::vector<double>{};
  }
  const mjtNum* data = model.numeric_data + model.numeric_adr[id];
  return {data, data + model.numeric_size[id]};
}

/// Returns the name of the <numeric> element that stores the parameter `name`. If the model has no
/// <numeric> of this name, the suffix "_front" or "_rear" is removed, which yields the name of the
/// value for both axles.
std::string NumericInModel(const CarModel& car, const std::string& name) {
  if (!NumericData(car, name).empty()) {
    return name;
  }
  for (const std::string suffix : {"_front", "_rear"}) {
    if (name.ends_with(suffix)) {
      const std::string both = name.substr(0, name.size() - suffix.size());
      if (!NumericData(car, both).empty()) {
        return both;
      }
    }
  }
  std::vector<std::string> known;
  const mjModel& model = *car.get();
  for (int i = 0; i < model.nnumeric; ++i) {
    known.emplace_back(mj_id2name(&model, mjOBJ_NUMERIC, i));
  }
  for (const auto& [own, mass] : Masses()) {
    known.push_back(own);
  }
  for (const auto& [own, range] : Ranges()) {
    known.push_back(own);
  }
  known.emplace_back(kSteeringOffset);
  Fail(car, name,
       "no such number in the model: " + UnknownName(name, known) +
           "; a numeric must stand under <custom> with its value of now");
}

void CheckIndex(const CarModel& car, const std::string& name, std::size_t index,
                const std::vector<double>& data) {
  if (index >= data.size()) {
    Fail(car, name, fmt::format("the numeric has {} numbers, counted from 0", data.size()));
  }
}

double MassOf(const CarModel& car, Mass which) {
  const VehicleParams& vehicle = car.unladen();
  switch (which) {
    case Mass::kMass:
      return vehicle.mass;
    case Mass::kCgToRear:
      return vehicle.cg_to_rear;
    case Mass::kCgHeight:
      return car.chassis().cg_height;
    case Mass::kYawInertia:
      return vehicle.yaw_inertia;
  }
  throw InternalError("no such mass property");
}

XMLElement& Custom(XMLElement& root) {
  XMLElement* custom = root.FirstChildElement("custom");
  return custom != nullptr ? *custom : *root.InsertNewChildElement("custom");
}

XMLElement* FindNamed(XMLElement& root, const char* section, const std::string& name) {
  for (XMLElement* part = root.FirstChildElement(section); part != nullptr;
       part = part->NextSiblingElement(section)) {
    for (XMLElement* child = part->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const char* own = child->Attribute("name");
      if (own != nullptr && own == name) {
        return child;
      }
    }
  }
  return nullptr;
}

/// Returns the numbers of an XML attribute, up to the first word that is not a number.
std::vector<double> ParseNumbers(const char* attribute) {
  std::vector<double> numbers;
  std::string_view rest = attribute == nullptr ? "" : attribute;
  for (;;) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc()) {
      return numbers;
    }
    numbers.push_back(value);
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  }
}

std::string Text(const std::vector<double>& values) {
  return fmt::format("{}", fmt::join(values, " "));
}

/// Inserts an XML comment before an element.
void AddComment(XMLElement& element, const std::string& text) {
  if (text.empty()) {
    return;
  }
  std::string safe = text;
  for (std::size_t at = 0; (at = safe.find("--", at)) != std::string::npos;) {
    safe.replace(at, 2, "- -");  // XML does not allow "--" inside a comment
  }
  tinyxml2::XMLDocument& document = *element.GetDocument();
  tinyxml2::XMLNode* comment = document.NewComment((" " + safe + " ").c_str());
  tinyxml2::XMLNode* parent = element.Parent();
  tinyxml2::XMLNode* before = element.PreviousSibling();
  if (before != nullptr) {
    parent->InsertAfterChild(before, comment);
  } else {
    parent->InsertFirstChild(comment);
  }
}

void SetNumeric(const CarModel& car, XMLElement& root, const CarParameter& parameter) {
  const auto [name, index] = ParseNumeric(parameter.name);
  const std::string source = NumericInModel(car, name);
  XMLElement* element = FindNamed(root, "custom", name);
  std::vector<double> data;
  if (element == nullptr) {
    data = NumericData(car, source);
    element = Custom(root).InsertNewChildElement("numeric");
    element->SetAttribute("name", name.c_str());
  } else {
    // an earlier parameter may already have changed numbers of this <numeric>
    data = ParseNumbers(element->Attribute("data"));
    data.resize(NumericData(car, name).size());
  }
  CheckIndex(car, parameter.name, index, data);
  data[index] = parameter.value;
  element->SetAttribute("data", Text(data).c_str());
  AddComment(*element, parameter.origin.empty() ? "" : parameter.name + ": " + parameter.origin);
}

void SetRange(XMLElement& root, const ActuatorRange& range, const CarParameter& parameter) {
  XMLElement* element = FindNamed(root, "actuator", range.actuator);
  TRACKBED_CHECK(element != nullptr, "a car without the actuator {}", range.actuator);
  element->SetAttribute(range.attribute, Numbers({-parameter.value, parameter.value}).c_str());
  AddComment(*element, parameter.origin.empty() ? "" : parameter.name + ": " + parameter.origin);
}

/// Sets the <inertial> element of the chassis such that the whole vehicle has the wanted
/// properties.
void SetMasses(const CarModel& car, XMLElement& root, const std::map<Mass, double>& wanted,
               const std::string& origin) {
  XMLElement* chassis = FindInWorld(root, "body", "chassis");
  TRACKBED_CHECK(chassis != nullptr, "a vehicle without the body chassis");
  XMLElement* inertial = chassis->FirstChildElement("inertial");
  if (inertial == nullptr || inertial->Attribute("diaginertia") == nullptr ||
      inertial->Attribute("quat") != nullptr || inertial->Attribute("euler") != nullptr) {
    Fail(car, "mass",
         "the body chassis has no <inertial> with diaginertia along its axes, whose mass could be "
         "changed");
  }
  const auto value = [&](Mass which) {
    const auto found = wanted.find(which);
    return found != wanted.end() ? found->second : MassOf(car, which);
  };
  const mjModel& model = *car.get();
  const int id = car.chassis().chassis;
  std::vector<double> inertia = ParseNumbers(inertial->Attribute("diaginertia"));
  inertia.resize(3);
  std::array<double, 3> position{};
  std::copy_n(model.body_ipos + 3 * static_cast<std::ptrdiff_t>(id), 3, position.begin());
  const double own = model.body_mass[id];
  const double old_mass = MassOf(car, Mass::kMass);
  const double old_x = MassOf(car, Mass::kCgToRear);
  const double old_z = MassOf(car, Mass::kCgHeight);
  const double rest = old_mass - own;
  // sum of mass times position over all bodies except the chassis
  const double rest_x = old_mass * old_x - own * position[0];
  const double rest_z = old_mass * old_z - own * position[2];
  const double mass = value(Mass::kMass);
  const double x = value(Mass::kCgToRear);
  const double new_chassis_mass = mass - rest;
  if (!(new_chassis_mass > 0.0)) {
    Fail(car, "mass",
         fmt::format("{} kg is less than what wheels and knuckles have, {} kg", mass, rest));
  }
  const double new_x = (mass * x - rest_x) / new_chassis_mass;
  const double new_z = (mass * value(Mass::kCgHeight) - rest_z) / new_chassis_mass;
  // Yaw inertia of all bodies except the chassis, first about the vehicle's old center of gravity,
  // then about the new one.
  const double y2 = position[1] * position[1];
  const double rest_yaw = MassOf(car, Mass::kYawInertia) - inertia[2] -
                          own * ((position[0] - old_x) * (position[0] - old_x) + y2);
  const double moved_yaw = rest_yaw + (old_x - x) * (2.0 * rest_x - rest * (old_x + x));
  const double new_yaw =
      value(Mass::kYawInertia) - moved_yaw - new_chassis_mass * ((new_x - x) * (new_x - x) + y2);
  if (!(new_yaw > 0.0)) {
    Fail(car, "yaw_inertia",
         fmt::format("{} kg m^2 is less than what wheels, knuckles and the place of the chassis "
                     "have, {:.4g} kg m^2",
                     value(Mass::kYawInertia), value(Mass::kYawInertia) - new_yaw));
  }
  inertial->SetAttribute("mass", new_chassis_mass);
  inertial->SetAttribute("pos", Numbers({new_x, position[1], new_z}).c_str());
  // The chassis's roll and pitch inertia are scaled in proportion to the mass of the chassis. If
  // necessary, roll and pitch inertia are increased, since each principal moment of inertia of a
  // body is at most the sum of the other two.
  const double heavier = new_chassis_mass / own;
  double roll = inertia[0] * heavier;
  double pitch = inertia[1] * heavier;
  const double lacking = std::max(0.0, new_yaw - (roll + pitch));
  roll += 0.5 * lacking;
  pitch += 0.5 * lacking;
  inertial->SetAttribute("diaginertia", Numbers({roll, pitch, new_yaw}).c_str());
  AddComment(*inertial, origin);

  const double gravity = std::abs(model.opt.gravity[2]);
  const double wheelbase = car.unladen().wheelbase;
  const double front = gravity * (mass * x - old_mass * old_x) / wheelbase;
  const double rear = gravity * (mass - old_mass) - front;
  PreloadSprings(car, root, {0.5 * front, 0.5 * front, 0.5 * rear, 0.5 * rear}, "mass");
}

}  // namespace

double CarParameterValue(const CarModel& car, const std::string& name) {
  if (const auto mass = Masses().find(name); mass != Masses().end()) {
    return MassOf(car, mass->second);
  }
  if (const auto range = Ranges().find(name); range != Ranges().end()) {
    return range->second.range(car)[1];
  }
  const NumericName numeric = ParseNumeric(name);
  const std::vector<double> data = NumericData(car, NumericInModel(car, numeric.name));
  CheckIndex(car, name, numeric.index, data);
  return data[numeric.index];
}

Scene WithCarParameters(const CarModel& car, const std::vector<CarParameter>& parameters) {
  Scene scene = car.scene();
  tinyxml2::XMLDocument document;
  ParseComposed(scene.xml, document);
  XMLElement& root = *document.RootElement();
  std::map<Mass, double> masses;
  std::string origin;
  for (const CarParameter& parameter : parameters) {
    if (const auto mass = Masses().find(parameter.name); mass != Masses().end()) {
      masses[mass->second] = parameter.value;
      if (!parameter.origin.empty()) {
        origin += (origin.empty() ? "" : "; ") + parameter.name + ": " + parameter.origin;
      }
    } else if (const auto range = Ranges().find(parameter.name); range != Ranges().end()) {
      SetRange(root, range->second, parameter);
    } else {
      SetNumeric(car, root, parameter);
    }
  }
  if (!masses.empty()) {
    SetMasses(car, root, masses, origin);
  }
  scene.xml = Print(document);
  scene.lines.clear();
  // the scene can be trusted, because it was compiled before and only numbers have changed since
  scene.trusted = true;
  return scene;
}

}  // namespace trackbed
