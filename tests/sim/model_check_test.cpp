#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"

/// Tests the messages for models that MuJoCo compiles but that are not vehicles.
namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The error for the Prius with every match of a regular expression replaced.
std::string ErrorWith(const std::string& find, const std::string& replace) {
  Scene scene = ComposeScene(FindModel("prius", ""), {});
  const std::string before = scene.xml;
  scene.xml = std::regex_replace(scene.xml, std::regex(find), replace,
                                 std::regex_constants::format_first_only);
  EXPECT_NE(scene.xml, before) << find;
  try {
    CarModel car(std::move(scene), "car.xml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string ErrorWithNumber(const std::string& name, const std::string& value) {
  return ErrorWith(fmt::format("(<numeric name=\"{}\" data=)\"[^\"]*\"", name),
                   fmt::format("$1\"{}\"", value));
}

TEST(CheckModel, RefusesNumbersThatNoVehicleHas) {
  EXPECT_EQ(ErrorWithNumber("drag_area", "nan"),
            "car.xml: drag_area: is nan; must be within 100 of 0");
  EXPECT_EQ(ErrorWithNumber("p_cx1", "-inf"), "car.xml: p_cx1: is -inf; must be within 1000 of 0");
  // Public tyres of MF6.1 have an r_by4 of 1747 and an r_bx3 of 3247.
  const auto with = [](const std::string& name, const std::string& value) {
    return ErrorWith(
        "<numeric name=\"p_cx1\"",
        fmt::format("<numeric name=\"{}\" data=\"{}\"/><numeric name=\"p_cx1\"", name, value));
  };
  EXPECT_THAT(with("r_by4", "1747.4"), Not(HasSubstr("must be within")));
  EXPECT_THAT(with("r_bx3", "-3247"), Not(HasSubstr("must be within")));
  EXPECT_THAT(with("r_by4", "2e6"), HasSubstr("r_by4: is 2e+06; must be within 1e+06 of 0"));
  EXPECT_EQ(ErrorWithNumber("rolling_resistance", "1e9"),
            "car.xml: rolling_resistance: is 1e+09; must be within 1 of 0");
  EXPECT_EQ(ErrorWithNumber("center_of_pressure", "1.68 1e9"),
            "car.xml: center_of_pressure: is 1e+09; must be within 100 of 0");
  EXPECT_THAT(ErrorWith("mass=\"1184\"", "mass=\"inf\""),
              HasSubstr("car.xml: chassis: body_mass is inf; must be within 1e+06 of 0"));
  EXPECT_THAT(ErrorWith("damping=\"[0-9.]+\"", "damping=\"-1000\""),
              HasSubstr("dof_damping is -1000; must be from 0 to 1e+07"));
  EXPECT_EQ(ErrorWith("<option ", "<option gravity=\"0 0 9.81\" "),
            "car.xml: option: gravity 0 0 9.81 must point down, 0 0 -9.81, with at most 100 m/s^2");
  EXPECT_EQ(ErrorWith("<option ", "<option density=\"nan\" "),
            "car.xml: option: density is nan; must be from 0 to 2000");
}

TEST(CheckModel, RefusesACarThatDoesNotStandOnItsGround) {
  EXPECT_THAT(
      ErrorWith("<body name=\"chassis\"", "<body name=\"chassis\" pos=\"0 0 100\""),
      HasSubstr("car.xml: tyre_fl: its lowest point is 100 m above the ground at qpos0; the "
                "car must stand on the ground"));
  EXPECT_THAT(ErrorWith("<body name=\"chassis\"", "<body name=\"chassis\" pos=\"0 0 -1\""),
              HasSubstr("car.xml: tyre_rr: its lowest point is 1 m below the ground at qpos0"));
}

std::string ErrorWithJoint(const std::string& name) {
  return ErrorWith("(<body name=\"chassis\"[^>]*>)",
                   "$1<body name=\"box\" pos=\"1 0 1\"><joint name=\"" + name +
                       "\" type=\"slide\" axis=\"0 0 1\" stiffness=\"1000\"/>"
                       "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"0.1 0.1 0.1\"/></body>");
}

TEST(CheckModel, RefusesJointsThatCannotBeColumnsOfLogs) {
  const std::string refused =
      ": the joint's name is a column of logs; must have letters, digits, spaces and _ . : - only";
  EXPECT_EQ(ErrorWithJoint("a load: 1.5-t_x"), "");
  EXPECT_EQ(ErrorWithJoint("a,b"), "car.xml: a,b" + refused);
  EXPECT_EQ(ErrorWithJoint("a&quot;b"), "car.xml: a\"b" + refused);
  EXPECT_EQ(ErrorWithJoint("a&#10;b"), "car.xml: a<U+000A>b" + refused);
  EXPECT_EQ(ErrorWithJoint("x"),
            "car.xml: x: the joint's column would be that of the chassis' position; rename it");
}

}  // namespace
}  // namespace trackbed
