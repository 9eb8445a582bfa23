#include "trackbed/sim/adapt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <string_view>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/model_notes.h"
#include "trackbed/sim/plant.h"

// Tests the car files that AdaptModel proposes. The models are written here, with names, frames and
// shapes that differ from those of docs/models.md; the expected parameters are the numbers from
// which the models are written.
namespace trackbed {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A vehicle in the dialect of some other program.
struct Foreign {
  double heading = 0.0;  ///< Direction of the car's front in the world [rad].
  double x = 0.0;        ///< Position of the body in the world [m].
  double y = 0.0;
  double wheelbase = 0.3;
  double track_front = 0.2;
  double track_rear = 0.22;
  double radius = 0.05;
  double base_mass = 3.0;
  double base_x = 0.12;  ///< Center of gravity of the base ahead of the rear axle [m].
  double base_z = 0.07;
  double base_yaw = 0.035;  ///< Yaw inertia of the base [kg m^2].
  double wheel_mass = 0.2;
  double range = 0.5;  ///< Range of the steering joints [rad].
  bool steers = true;
  bool steers_rear = false;
  bool flips_spin = false;         ///< Whether the right wheels' axes point to the right.
  std::string wheel = "cylinder";  ///< Type of the wheels' geoms.
  std::string base_joint = "<freejoint/>";
  std::string base_geom = "<geom type='box' size='0.1 0.05 0.02' pos='0.15 0 0.12' mass='0'/>";
  std::string more{};  ///< Further sections.
};

/// Returns one wheel of the model, with its steering joint in the same body.
std::string ForeignWheel(const Foreign& car, int i) {
  const bool front = i < 2;
  const double side = i % 2 == 0 ? 0.5 : -0.5;
  const bool steered = front ? car.steers : car.steers_rear;
  std::string joints;
  if (steered) {
    joints =
        "<joint name='turn" + std::to_string(i) + "' axis='0 0 1'" +
        (car.range > 0.0 ? fmt::format(" limited='true' range='{} {}'/>", -car.range, car.range)
                         : "/>");
  }
  joints +=
      fmt::format("<joint name='roll{}' axis='0 {} 0'/>", i, car.flips_spin && side < 0.0 ? -1 : 1);
  const double r = car.radius;
  const std::string shape =
      car.wheel == "ellipsoid" ? fmt::format("type='ellipsoid' size='{} {} {}'", r, 0.3 * r, r)
      : car.wheel == "sphere"  ? fmt::format("type='sphere' size='{}'", r)
                               : fmt::format("type='{}' size='{} {}' euler='{} 0 0'", car.wheel, r,
                                             0.3 * r, 0.5 * std::numbers::pi);
  const double m = car.wheel_mass;
  return fmt::format(
      "<body name='w{}' pos='{} {} {}'><inertial pos='0 0 0' mass='{}' diaginertia='{} {} "
      "{}'/>{}<geom {}/></body>\n",
      i, front ? car.wheelbase : 0.0, side * (front ? car.track_front : car.track_rear), r, m,
      0.3 * m * r * r, 0.5 * m * r * r, 0.3 * m * r * r, joints, shape);
}

std::string ForeignXml(const Foreign& car) {
  std::string wheels;
  for (int i = 3; i >= 0; --i) {
    wheels += ForeignWheel(car, i);
  }
  return fmt::format(
      "<mujoco model='foreign'>\n<compiler angle='radian'/>\n<worldbody>\n"
      "<geom name='floor' type='plane' size='9 9 1'/>\n"
      "<body name='robot' pos='{} {} 0' euler='0 0 {}'>{}\n"
      "<inertial pos='{} 0 {}' mass='{}' diaginertia='{} {} {}'/>{}\n{}</body>\n"
      "</worldbody>\n{}</mujoco>\n",
      car.x, car.y, car.heading, car.base_joint, car.base_x, car.base_z, car.base_mass,
      0.3 * car.base_yaw, 0.8 * car.base_yaw, car.base_yaw, car.base_geom, wheels, car.more);
}

AdaptedModel AdaptText(const std::string& text, const AdaptOptions& options = {},
                       const std::string& name = "robot.xml") {
  const TempFolder folder;
  WriteFileAtomically(folder.path() / name, text);
  return AdaptModel(folder.path() / name, options);
}

CarModel AdaptedCar(const Foreign& car, const AdaptOptions& options = {}) {
  return {Scene{.xml = AdaptText(ForeignXml(car), options).xml, .assets = {}, .lines = {}}, "car"};
}

std::string Refusal(const std::string& text, const AdaptOptions& options = {}) {
  return ErrorText([&] { AdaptText(text, options); });
}

std::string NotesOf(const AdaptedModel& model) {
  std::string text;
  for (const std::string& note : model.notes) {
    text += note + "\n";
  }
  return text;
}

/// Checks the parameters of the proposed car against the numbers of the foreign model.
void ExpectSameCar(const Foreign& car) {
  const CarModel adapted = AdaptedCar(car);
  const VehicleParams& params = adapted.params();
  // The tolerance covers the rounding of a rotation and its inverse, and of numbers with 17 digits.
  const double rounding = Tolerance(1e-9);
  EXPECT_NEAR(params.wheelbase, car.wheelbase, rounding);
  EXPECT_NEAR(params.track_front, car.track_front, rounding);
  EXPECT_NEAR(params.track_rear, car.track_rear, rounding);
  EXPECT_NEAR(params.wheel_radius, car.radius, rounding);
  const double mass = car.base_mass + 4.0 * car.wheel_mass;
  const double ahead = (car.base_mass * car.base_x + 2.0 * car.wheel_mass * car.wheelbase) / mass;
  EXPECT_NEAR(params.mass, mass, rounding * mass);
  EXPECT_NEAR(params.cg_to_rear, ahead, rounding);
  EXPECT_NEAR(adapted.chassis().cg_height,
              (car.base_mass * car.base_z + 4.0 * car.wheel_mass * car.radius) / mass, rounding);
  // The parallel axis theorem over the base and the four wheels.
  const auto square = [](double a) { return a * a; };
  double yaw = car.base_yaw + car.base_mass * square(car.base_x - ahead);
  for (const auto& [x, track] :
       {std::pair(car.wheelbase, car.track_front), std::pair(0.0, car.track_rear)}) {
    yaw +=
        2.0 * car.wheel_mass * (0.3 * square(car.radius) + square(x - ahead) + square(0.5 * track));
  }
  EXPECT_NEAR(params.yaw_inertia, yaw, rounding * yaw);
  // The range of the joint is that of the inner wheel, with cot inner = cot bicycle - track/(2 L).
  // The file gives the limit with 6 digits.
  const double limit = params.steering_limit;
  EXPECT_NEAR(1.0 / std::tan(car.range),
              1.0 / std::tan(limit) - 0.5 * car.track_front / car.wheelbase, Tolerance(1e-4));
}

TEST(Adapt, KeepsSizesAndMassesOfRandomCars) {
  std::mt19937 random(50);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const std::array<const char*, 4> shapes{"cylinder", "ellipsoid", "capsule", "sphere"};
  for (int i = 0; i < 20; ++i) {
    const double scale = std::pow(10.0, between(-1.0, 1.0));
    Foreign car;
    car.heading = between(-3.0, 3.0);
    car.x = between(-5.0, 5.0);
    car.y = between(-5.0, 5.0);
    car.wheelbase = scale * between(0.25, 0.4);
    car.track_front = scale * between(0.15, 0.25);
    car.track_rear = scale * between(0.15, 0.25);
    car.radius = scale * between(0.03, 0.06);
    car.base_mass = between(1.0, 3000.0);
    car.base_x = car.wheelbase * between(0.3, 0.6);
    car.base_z = car.radius * between(1.0, 2.0);
    car.base_yaw = car.base_mass * std::pow(between(0.2, 0.4) * car.wheelbase, 2);
    car.wheel_mass = car.base_mass * between(0.01, 0.05);
    car.range = between(0.2, 0.8);
    car.flips_spin = i % 2 == 0;
    car.wheel = shapes.at(static_cast<std::size_t>(i) % shapes.size());
    SCOPED_TRACE(ForeignXml(car));
    ExpectSameCar(car);
  }
}

TEST(Adapt, TurnsTheSteeredAxleToTheFront) {
  Foreign car;
  car.steers = false;
  car.steers_rear = true;
  const CarModel adapted = AdaptedCar(car);
  EXPECT_NEAR(adapted.params().track_front, car.track_rear, Tolerance(1e-9));
  const double mass = car.base_mass + 4.0 * car.wheel_mass;
  const double ahead = (car.base_mass * car.base_x + 2.0 * car.wheel_mass * car.wheelbase) / mass;
  EXPECT_NEAR(adapted.params().cg_to_rear, car.wheelbase - ahead, Tolerance(1e-9));
}

TEST(Adapt, CarDrivesItsCircle) {
  const Foreign foreign;
  const CarModel car = AdaptedCar(foreign);
  const World world;
  const double steering = 0.3;
  const double speed = 0.5;
  const auto plant = MakePlant("mujoco", {.car = car, .world = world, .start = {.speed = speed}});
  VehicleState state = plant->Observe();
  while (state.time < 4.0) {
    plant->Step({.steering = steering, .acceleration = 2.0 * (speed - state.speed)});
    state = plant->Observe();
  }
  // At 0.26 m/s^2, the slip angles of the tyres are a_y/(8 g) = 3 mrad. The difference between the
  // axles, at most a tenth of this, changes the yaw rate by less than 2 %.
  EXPECT_NEAR(state.yaw_rate / state.speed * foreign.wheelbase, std::tan(steering),
              Tolerance(0.02) * std::tan(steering));
  EXPECT_NEAR(state.speed, speed, Tolerance(0.02) * speed);
}

TEST(Adapt, NamesWhatCannotBeDriven) {
  Foreign car;
  car.steers = false;
  EXPECT_THAT(Refusal(ForeignXml(car)), AllOf(HasSubstr("a skid-steer robot"), HasSubstr("'roll0'"),
                                              HasSubstr("give the front wheels steering joints")));
  car.steers = car.steers_rear = true;
  EXPECT_THAT(Refusal(ForeignXml(car)),
              AllOf(HasSubstr("all four wheels are steered"), HasSubstr("--front-steering")));
  EXPECT_NEAR(AdaptedCar(car, {.steers_front_only = true}).params().wheelbase, car.wheelbase,
              Tolerance(1e-9));
  const std::string xml = ForeignXml(Foreign{});
  const std::size_t wheel = xml.find("<body name='w3'");
  const std::string without = xml.substr(0, wheel) + xml.substr(xml.find("</body>", wheel) + 7);
  EXPECT_THAT(Refusal(without), HasSubstr("a tricycle"));
  // A fifth wheel in the middle of the rear axle, as a copy of the fourth.
  std::string fifth = xml.substr(wheel, xml.find("</body>", wheel) + 7 - wheel);
  for (const char* name : {"w3", "roll3"}) {
    const std::string quoted = fmt::format("'{}'", name);
    fifth.replace(fifth.find(quoted), quoted.size(), fmt::format("'middle_{}'", name));
  }
  const std::size_t place = fifth.find("pos='");
  const std::size_t first = fifth.find(' ', place);
  const std::size_t second = fifth.find(' ', first + 1);
  fifth.replace(first, second - first, " 0");
  std::string five = xml;
  five.insert(wheel, fifth);
  EXPECT_THAT(Refusal(five), AllOf(HasSubstr("a vehicle with more than two wheels on an axle"),
                                   HasSubstr("remove the other wheels from the file")));
  EXPECT_THAT(Refusal("<mujoco><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>"),
              AllOf(HasSubstr("no wheels found"), HasSubstr("no hinge joints")));
}

// 25 000 m^3 of MuJoCo's usual density: a wall of 2.5e7 kg, which stands.
TEST(Adapt, TakesTheMassOfWallsForIrrelevant) {
  std::string xml = ForeignXml(Foreign{});
  const std::string wall =
      "<body name='wall' pos='0 80 0'>{}<geom type='box' size='50 25 2.5'/></body>";
  std::string standing = xml;
  standing.insert(standing.find("</worldbody>"), fmt::format(fmt::runtime(wall), ""));
  EXPECT_EQ(AdaptText(standing).kind, VehicleKind::kSteered);
  xml.insert(xml.find("</worldbody>"), fmt::format(fmt::runtime(wall), "<freejoint/>"));
  EXPECT_THAT(Refusal(xml), HasSubstr("wall: body_mass is 2.5e+07; must be within 1e+06 of 0"));
}

TEST(Adapt, AsksForALimitThatTheModelDoesNotHave) {
  Foreign car;
  car.range = 0.0;
  EXPECT_THAT(Refusal(ForeignXml(car)),
              AllOf(HasSubstr("how far do the front wheels steer?"), HasSubstr("'turn0'"),
                    HasSubstr("--steering-limit RAD")));
  EXPECT_NEAR(AdaptedCar(car, {.steering_limit = 0.4}).params().steering_limit, 0.4,
              Tolerance(1e-6));
  car.range = 0.5 * std::numbers::pi / 180.0;
  EXPECT_THAT(Refusal(ForeignXml(car)), HasSubstr("ranges are in degrees; correct the file"));
}

TEST(Adapt, AsksWhichOfSeveralVehicles) {
  Foreign other;
  other.y = 2.0;
  other.wheelbase = 0.4;
  std::string second = ForeignXml(other);
  second = second.substr(second.find("<body name='robot'"));
  second = second.substr(0, second.find("</worldbody>"));
  for (const char* name :
       {"robot", "w0", "w1", "w2", "w3", "turn0", "turn1", "roll0", "roll1", "roll2", "roll3"}) {
    const std::string quoted = fmt::format("'{}'", name);
    second.replace(second.find(quoted), quoted.size(), fmt::format("'other_{}'", name));
  }
  std::string both = ForeignXml(Foreign{});
  both.insert(both.find("</worldbody>"), second);
  EXPECT_THAT(Refusal(both), AllOf(HasSubstr("which vehicle?"), HasSubstr("'robot' (4 wheels)"),
                                   HasSubstr("'other_robot' (4 wheels)"), HasSubstr("--body")));
  const AdaptedModel chosen = AdaptText(both, {.body = "other_robot"});
  const CarModel car(Scene{.xml = chosen.xml, .assets = {}, .lines = {}}, "car");
  EXPECT_NEAR(car.params().wheelbase, 0.4, Tolerance(1e-9));
  EXPECT_THAT(Refusal(both, {.body = "third"}), HasSubstr("no body 'third'"));
}

TEST(Adapt, NotesFaultsThatARunWouldHaveHad) {
  Foreign car;
  car.base_joint =
      "<joint name='slide_x' type='slide' axis='1 0 0'/><joint name='slide_y' type='slide' "
      "axis='0 1 0'/><joint name='yaw' axis='0 0 1'/>";
  car.base_geom = "<geom name='belly' type='box' size='0.2 0.09 0.02' pos='0.15 0 0.07' mass='0'/>";
  car.more = "<equality><joint name='both' joint1='turn0' joint2='turn1'/></equality>";
  // MuJoCo does not test a wheel against its parent body, so the belly is a separate body.
  std::string xml = ForeignXml(car);
  xml.replace(xml.find("<geom name='belly'"), 0, "<body name='shell'>");
  xml.insert(xml.find("/>", xml.find("<geom name='belly'")) + 2,
             "<joint name='lid' axis='0 1 0'/><inertial pos='0 0 0.1' mass='0.1' diaginertia='1e-4 "
             "1e-4 1e-4'/></body>");
  const std::string notes = NotesOf(AdaptText(xml));
  EXPECT_THAT(notes, HasSubstr("slide 'slide_x', slide 'slide_y', hinge 'yaw' instead of a free"));
  EXPECT_THAT(notes, HasSubstr("'both' between the joints 'turn0' and 'turn1' is replaced"));
  EXPECT_THAT(notes, HasSubstr("the tyre of 'roll0' touches the geom 'belly' of the body 'shell' "
                               "at rest"));
  EXPECT_THAT(notes, HasSubstr("locked at their initial positions: the joints 'lid'"));
  EXPECT_EQ(NotesOf(AdaptText(ForeignXml(Foreign{}))), "");
}

/// A robot with two driven wheels and a ball, 1 kg in all.
constexpr const char* kDifferential =
    "<mujoco><compiler angle='radian'/><worldbody><geom type='plane' size='3 3 1'/>"
    "<body name='car' pos='0 0 0.03' euler='0 0 2'><freejoint/>"
    "<inertial pos='0.02 0 0' mass='0.8' diaginertia='1e-3 1e-3 1e-3'/>"
    "<geom type='sphere' size='0.015' pos='0.15 0 -0.015' condim='1'/>"
    "<body pos='0 0.06 0'><joint name='l' axis='0 1 0'/>"
    "<geom type='cylinder' size='0.03 0.01' euler='1.5707963267948966 0 0' mass='0.1'/></body>"
    "<body pos='0 -0.06 0'><joint name='r' axis='0 1 0'/>"
    "<geom type='cylinder' size='0.03 0.01' euler='1.5707963267948966 0 0' mass='0.1'/></body>"
    "</body></worldbody></mujoco>";

TEST(Adapt, RecognizesDifferentialDrive) {
  const AdaptedModel model = AdaptText(kDifferential);
  EXPECT_EQ(model.kind, VehicleKind::kDifferential);
  const CarModel robot(Scene{.xml = model.xml, .assets = {}, .lines = {}}, "robot");
  EXPECT_EQ(robot.params().kind, VehicleKind::kDifferential);
  EXPECT_NEAR(robot.params().track_rear, 0.12, Tolerance(1e-9));
  EXPECT_NEAR(robot.params().mass, 1.0, Tolerance(1e-9));
  EXPECT_NEAR(robot.params().cg_to_rear, 0.016, Tolerance(1e-9));
  std::string balancing = kDifferential;
  const std::size_t ball = balancing.find("<geom type='sphere'");
  balancing.erase(ball, balancing.find("/>", ball) + 2 - ball);
  EXPECT_THAT(Refusal(balancing), HasSubstr("nothing but its two wheels touches the ground"));
}

/// The same car as URDF: links with the masses of `car`, and joints with origins.
std::string ForeignUrdf(const Foreign& car, const std::string& wheel_shape) {
  std::string text = fmt::format(
      "<robot name='car'><link name='base'><inertial><origin xyz='{} 0 {}'/><mass value='{}'/>"
      "<inertia ixx='0.01' iyy='0.03' izz='0.035' ixy='0' ixz='0' iyz='0'/></inertial></link>\n",
      car.base_x, car.base_z, car.base_mass);
  for (int i = 0; i < 4; ++i) {
    const double m = car.wheel_mass;
    const double r = car.radius;
    const double side = i % 2 == 0 ? 0.5 : -0.5;
    const std::string at = fmt::format("<origin xyz='{} {} {}'/>", i < 2 ? car.wheelbase : 0.0,
                                       side * (i < 2 ? car.track_front : car.track_rear), r);
    text += fmt::format(
        "<link name='wheel{0}'><inertial><mass value='{1}'/><inertia ixx='{2}' iyy='{3}' "
        "izz='{2}' ixy='0' ixz='0' iyz='0'/></inertial><collision>"
        "<origin rpy='1.5707963267948966 0 0'/><geometry>{4}</geometry></collision></link>\n",
        i, m, 0.3 * m * r * r, 0.5 * m * r * r, wheel_shape);
    const std::string parent = i < 2 ? fmt::format("hub{}", i) : "base";
    if (i < 2) {
      // a hub without mass, as many files have it
      text += fmt::format(
          "<link name='hub{0}'/><joint name='turn{0}' type='revolute'><parent link='base'/><child "
          "link='hub{0}'/>{1}<axis xyz='0 0 1'/><limit lower='-{2}' upper='{2}' effort='1' "
          "velocity='1'/></joint>\n",
          i, at, car.range);
    }
    text += fmt::format(
        "<joint name='roll{0}' type='continuous'><parent link='{1}'/><child "
        "link='wheel{0}'/>{2}<axis xyz='0 1 0'/></joint>\n",
        i, parent, i < 2 ? "" : at);
  }
  return text + "<gazebo><plugin name='p'/></gazebo></robot>\n";
}

TEST(Adapt, ReadsUrdf) {
  const Foreign car;
  const AdaptedModel model =
      AdaptText(ForeignUrdf(car, "<cylinder radius='0.05' length='0.03'/>"), {}, "car.urdf");
  const CarModel adapted(Scene{.xml = model.xml, .assets = {}, .lines = {}}, "car");
  EXPECT_NEAR(adapted.params().wheelbase, car.wheelbase, Tolerance(1e-9));
  EXPECT_NEAR(adapted.params().track_rear, car.track_rear, Tolerance(1e-9));
  // Each of the two hubs gets 1e-6 kg.
  EXPECT_NEAR(adapted.params().mass, 3.8 + 2e-6, Tolerance(1e-9));
  EXPECT_THAT(NotesOf(model), HasSubstr("get 1e-6 kg each: 'hub0', 'hub1'; add the masses"));
}

// In URDF, a link without <inertial> has no mass, even if the link has shapes.
TEST(Adapt, GivesNoMassToShapesOfUrdf) {
  const Foreign car;
  std::string urdf = ForeignUrdf(car, "<cylinder radius='0.05' length='0.03'/>");
  urdf.insert(urdf.find("</gazebo>") + 9,
              "<link name='sensor'><collision><geometry><box size='0.1 0.1 0.1'/></geometry>"
              "</collision></link><joint name='fix' type='fixed'><parent link='base'/>"
              "<child link='sensor'/><origin xyz='0.1 0 0.3'/></joint>"
              "<mujoco><compiler inertiafromgeom='true'/></mujoco>");
  const AdaptedModel model = AdaptText(urdf, {}, "car.urdf");
  const CarModel adapted(Scene{.xml = model.xml, .assets = {}, .lines = {}}, "car");
  EXPECT_NEAR(adapted.params().mass, 3.8 + 3e-6, Tolerance(1e-9));
  EXPECT_THAT(NotesOf(model), HasSubstr("'sensor'"));
}

// The wheels of such a car have more inertia than the whole car leaves for its chassis.
TEST(Adapt, ReadsUrdfWithoutAMassOfTheChassis) {
  std::string urdf = ForeignUrdf(Foreign{}, "<cylinder radius='0.05' length='0.03'/>");
  const std::size_t begin = urdf.find("<inertial>");
  urdf.erase(begin, urdf.find("</inertial>") + 11 - begin);
  const AdaptedModel model = AdaptText(urdf, {}, "car.urdf");
  const CarModel adapted(Scene{.xml = model.xml, .assets = {}, .lines = {}}, "car");
  EXPECT_NEAR(adapted.params().mass, 4.0 * Foreign{}.wheel_mass + 3e-6, Tolerance(1e-9));
  EXPECT_THAT(NotesOf(model), HasSubstr("'base'"));
}

// Files for display have visual geometry only, and hubs without mass.
TEST(Adapt, FindsWheelsOfVisualGeometry) {
  const Foreign car;
  std::string urdf = ForeignUrdf(car, "<cylinder radius='0.05' length='0.03'/>");
  for (const auto& [from, to] :
       {std::pair("<collision>", "<visual>"), std::pair("</collision>", "</visual>")}) {
    for (std::size_t at = urdf.find(from); at != std::string::npos; at = urdf.find(from)) {
      urdf.replace(at, std::string_view(from).size(), to);
    }
  }
  const AdaptedModel model = AdaptText(urdf, {}, "car.urdf");
  const CarModel adapted(Scene{.xml = model.xml, .assets = {}, .lines = {}}, "car");
  EXPECT_NEAR(adapted.params().wheelbase, car.wheelbase, Tolerance(1e-9));
  EXPECT_NEAR(adapted.params().wheel_radius, car.radius, Tolerance(1e-9));
  // Each of the two hubs gets 1e-6 kg.
  EXPECT_NEAR(adapted.params().mass, 3.8 + 2e-6, Tolerance(1e-9));
}

TEST(Adapt, NamesMeshesOfUrdfThatItCannotRead) {
  const std::string urdf =
      ForeignUrdf(Foreign{}, "<mesh filename='package://car/meshes/wheel.dae' scale='1 1 1 1'/>");
  const auto adapt = [&](const AdaptOptions& options) {
    return AdaptText(urdf, options, "car.urdf");
  };
  EXPECT_THAT(ErrorText([&] { adapt({}); }),
              AllOf(HasSubstr("no wheels found"), HasSubstr("wheel.dae does not exist"),
                    HasSubstr("--wheel-radius")));
  const AdaptedModel model = adapt({.wheel_radius = 0.05});
  EXPECT_THAT(NotesOf(model), HasSubstr("mesh dropped: package://car/meshes/wheel.dae"));
}

TEST(Adapt, NamesOtherDialects) {
  EXPECT_THAT(ErrorText([] { AdaptText("<sdf version='1.6'/>", {}, "car.sdf"); }),
              HasSubstr("root element is <sdf>"));
  EXPECT_THAT(ErrorText([] {
                AdaptText("<robot xmlns:xacro='x'><xacro:macro name='m'/></robot>", {},
                          "car.xacro");
              }),
              HasSubstr("`xacro car.xacro > car.urdf`"));
  EXPECT_THAT(ErrorText([] { AdaptModel("/no/such/car.xml", {}); }), HasSubstr("no such file"));
  EXPECT_THAT(ErrorText([] { AdaptText("<mujoco>"); }), HasSubstr("not XML"));
}

/// The car file `name` with `more` before the first occurrence of `before`.
CarModel CarWithMore(const std::string& before, const std::string& more) {
  std::string xml =
      ReadFile(std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/models/small_car.xml");
  return {Scene{.xml = xml.insert(xml.find(before), more), .assets = {}, .lines = {}}, "small"};
}

TEST(NotesOnModel, NameTyresThatRubAndLeftoverCouplings) {
  for (const char* name : {"prius", "bmw320i", "dart", "diff_drive", "f1tenth"}) {
    EXPECT_THAT(NotesOnModel(CarModel(ComposeScene(FindModel(name, ""), {}), name)),
                testing::IsEmpty())
        << name;
  }
  EXPECT_THAT(NotesOnModel(CarWithMore("<body name=\"rack\"",
                                       "<geom name='fender' type='box' size='0.03 0.01 0.01' "
                                       "pos='0.26 0.085 0.06' mass='0'/>")),
              testing::ElementsAre(HasSubstr("tyre_fl touches the geom 'fender' of the body "
                                             "'chassis' at rest")));
  EXPECT_THAT(NotesOnModel(CarWithMore("</equality>",
                                       "<joint name='tie' joint1='steer_fl' joint2='steer_fr'/>")),
              testing::ElementsAre(HasSubstr("'tie' between the joints 'steer_fl' and 'steer_fr' "
                                             "works against Ackermann's linkage")));
}

TEST(ForeignModel, IsSentToAdapt) {
  const TempFolder folder;
  WriteFileAtomically(folder.path() / "robot.xml", ForeignXml(Foreign{}));
  EXPECT_THAT(ErrorText([&] {
                const CarModel car(ComposeScene(folder.path() / "robot.xml", {}), "robot.xml");
              }),
              HasSubstr("`trackbed model robot.xml --adapt -o car.xml` proposes a car file"));
  WriteFileAtomically(folder.path() / "robot.urdf", "<robot name='r'/>");
  EXPECT_THAT(ErrorText([&] { ComposeScene(folder.path() / "robot.urdf", {}); }),
              AllOf(HasSubstr("root element is <robot>, of URDF"), HasSubstr("--adapt")));
}

}  // namespace
}  // namespace trackbed
