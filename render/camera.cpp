#include "render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

// Computes the poses of the cameras of films: chase, side, driver, orbit and top.
// 1. Each camera pose is a function of the recording and the time. Headings are averaged from 0.8 s
//    before to 0.8 s after the frame's time, with triangular weights, so that cameras turn
//    smoothly.
// 2. The camera's distance and height are multiples of the size of the car, and include a trailer.
// 3. LiftOnto adds the height and the slope of the ground around the car.
// CameraTable lists the cameras with their names; FindCamera suggests the most similar name.
namespace trackbed::render {
namespace {

/// Returns the weighted mean of `value` from 0.8 s before to 0.8 s after `time`, with triangular
/// weights. The triangular weights make the derivative of the mean continuous, so the camera starts
/// and stops turning smoothly.
template <typename Function>
auto Smooth(double time, Function value) {
  constexpr int kHalf = 16;
  constexpr double kSmoothingTime = 0.8;  // [s]
  std::array<double, 2> sum{};
  double weights = 0.0;
  for (int i = -kHalf + 1; i < kHalf; ++i) {
    const double weight = kHalf - std::abs(i);
    const std::array<double, 2> here = value(time + i * kSmoothingTime / kHalf);
    sum[0] += weight * here[0];
    sum[1] += weight * here[1];
    weights += weight;
  }
  return std::array<double, 2>{sum[0] / weights, sum[1] / weights};
}

/// Adapts a camera pose that was computed for the plane z = 0 to the height and slope of the ground
/// around the car.
void LiftOnto(CameraPose& pose, const CameraSubject& subject, double time) {
  const Point car = subject.Position(time);
  pose.ground_z = subject.SmoothGround(time) +
                  subject.grade().dot(Vec2(pose.target_x - car.x, pose.target_y - car.y));
  pose.target_z += pose.ground_z;
  // The camera's elevation angle follows the slope, so that a hill does not hide the car.
  pose.elevation += std::atan(subject.grade().dot(Direction(pose.azimuth)));
}

CameraPose Chase(const CameraSubject& subject, double time, double /*aspect*/) {
  const Point car = subject.Position(time);
  // In reverse gear, the camera looks backward, in the car's direction of motion. When the car
  // changes to reverse gear, the camera swings to the front along the car's right side.
  const double heading = subject.SmoothHeading(time) + kPi * subject.SmoothReverse(time);
  // The camera aims at a point ahead of the rear axle, so that the road ahead fills the frame. The
  // camera is close enough to keep the car above the frame's chart strip and caption.
  const double size = subject.box().scale();
  const double ahead = 1.0 * size;
  CameraPose pose;
  pose.target_x = car.x + ahead * std::cos(heading);
  pose.target_y = car.y + ahead * std::sin(heading);
  pose.target_z = 1.0 * size;
  pose.distance = 14.5 * size + subject.box().towed;
  pose.paint_scale = size;
  // The chase camera looks slightly from the side, so that the car's flank and the trail beside the
  // caption are visible.
  pose.azimuth = heading + 14.0 * kPi / 180.0;
  pose.elevation = -18.0 * kPi / 180.0;
  pose.view_angle = 40.0 * kPi / 180.0;
  LiftOnto(pose, subject, time);
  return pose;
}

CameraPose Side(const CameraSubject& subject, double time, double aspect) {
  const Point car = subject.Position(time);
  const double heading = subject.SmoothHeading(time);
  const double size = subject.box().scale();
  // Distance from the rear axle of a typical car to the middle of car and trailer [m].
  const double ahead = 1.4 * size - 0.5 * subject.box().towed;
  // Width of the area that the camera sees at the car's distance [m]: two car lengths, and the
  // trailer.
  const double width = 9.0 * size + subject.box().towed;
  constexpr double kViewAngle = 28.0 * kPi / 180.0;
  CameraPose pose;
  pose.target_x = car.x + ahead * std::cos(heading);
  pose.target_y = car.y + ahead * std::sin(heading);
  pose.target_z = 0.7 * size;
  pose.paint_scale = size;
  pose.view_angle = kViewAngle;
  // The limited aspect ratio keeps the whole car visible in frames in portrait format.
  pose.distance = 0.5 * width / (std::tan(0.5 * kViewAngle) * std::clamp(aspect, 0.2, 16.0 / 9.0));
  // The camera looks from the car's right side. Seen from the right side, the sun is not behind the
  // camera, so that shadows are visible.
  pose.azimuth = heading + 0.5 * kPi;
  pose.elevation = -12.0 * kPi / 180.0;
  LiftOnto(pose, subject, time);
  return pose;
}

CameraPose Driver(const CameraSubject& subject, double time, double aspect) {
  const Point car = subject.Position(time);
  const double heading = subject.Heading(time);
  const CarBox& box = subject.box();
  // horizontal angle of view of the driver's camera
  constexpr double kFieldOfView = 66.0 * kPi / 180.0;
  CameraPose pose;
  pose.inside = true;
  // The driver's camera is at the driver's eye: midway along the car, left of the center line,
  // below the roof.
  const Vec2 eye = ToWorld({car.x, car.y, heading}, {box.middle, 0.45 * box.half_width});
  pose.distance = 8.0 * subject.box().scale();
  pose.paint_scale = subject.box().scale();
  pose.azimuth = heading;
  pose.elevation = -6.0 * kPi / 180.0;
  pose.view_angle = 2.0 * std::atan(std::tan(0.5 * kFieldOfView) / std::max(aspect, 1.0));
  const double level = pose.distance * std::cos(pose.elevation);
  pose.target_x = eye.x() + level * std::cos(heading);
  pose.target_y = eye.y() + level * std::sin(heading);
  pose.target_z = 0.82 * box.height + pose.distance * std::sin(pose.elevation);
  LiftOnto(pose, subject, time);
  return pose;
}

CameraPose Orbit(const CameraSubject& subject, double time, double /*aspect*/) {
  const Point car = subject.Position(time);
  const double heading = subject.SmoothHeading(time);
  const double middle = subject.box().middle - 0.5 * subject.box().towed;
  CameraPose pose;
  pose.target_x = car.x + middle * std::cos(heading);
  pose.target_y = car.y + middle * std::sin(heading);
  pose.target_z = 0.7 * subject.box().scale();
  pose.distance = 11.0 * subject.box().scale() + subject.box().towed;
  pose.paint_scale = subject.box().scale();
  constexpr double kRound = 24.0;  // [s]
  pose.azimuth = subject.Heading(subject.begin()) + 2.0 * kPi * (time - subject.begin()) / kRound;
  pose.elevation = -20.0 * kPi / 180.0;
  pose.view_angle = 40.0 * kPi / 180.0;
  LiftOnto(pose, subject, time);
  return pose;
}

CameraPose Top(const CameraSubject& subject, double time, double aspect) {
  // The top camera is high above the ground and has a narrow angle of view, so that perspective
  // hardly distorts vertical objects.
  constexpr double kViewAngle = 20.0 * kPi / 180.0;
  const double size = subject.box().scale();
  // Margin between the route and the edges of the frame [m].
  const double margin = 5.0 * size;
  // Length of the ground shown from the bottom to the top of the frame [m].
  const double follow_height = 34.0 * size;
  // Maximum extent of a route that is shown as a whole [m]; in a view of a larger route, the car
  // would be too small.
  const double fit_height = 60.0 * size;
  const Point low = subject.lowest();
  const Point high = subject.highest();
  const double needed =
      std::max(high.y - low.y + 2 * margin, (high.x - low.x + 2 * margin) / aspect);

  CameraPose pose;
  pose.azimuth = 0.5 * kPi;
  pose.elevation = -0.5 * kPi;
  pose.view_angle = kViewAngle;
  double height = follow_height;
  if (needed <= fit_height) {
    height = std::max(needed, 20.0 * size);
    pose.target_x = 0.5 * (low.x + high.x);
    pose.target_y = 0.5 * (low.y + high.y);
  } else {
    // The camera aims ahead of the car, since the road ahead matters more than the road behind.
    const Point car = subject.SmoothPosition(time);
    const double heading = subject.SmoothHeading(time);
    pose.target_x = car.x + 6.0 * size * std::cos(heading);
    pose.target_y = car.y + 6.0 * size * std::sin(heading);
  }
  pose.ground_z = subject.grade().dot(Vec2(pose.target_x, pose.target_y));
  pose.target_z = pose.ground_z;
  pose.distance = 0.5 * height / std::tan(0.5 * kViewAngle);
  pose.paint_scale = height / 22.0;
  return pose;
}

}  // namespace

CameraSubject::CameraSubject(const Recording& recording)
    : recording_(recording),
      car_(recording.plants.front()),
      lowest_(car_.Position(car_.begin())),
      highest_(lowest_),
      box_(FindCarBox(*recording.model)) {
  constexpr double kStandstillSpeed = 0.05;  // speed below which a car is treated as standing [m/s]
  double reverse = 0.0;
  for (const double at : car_.log().times()) {
    const double speed = car_.ReadingsAt(at).speed;
    reverse = std::abs(speed) < kStandstillSpeed ? reverse : speed < 0.0 ? 1.0 : 0.0;
    reverse_.push_back(reverse);
  }
  const auto include = [this](const Point& point) {
    lowest_ = {std::min(lowest_.x, point.x), std::min(lowest_.y, point.y)};
    highest_ = {std::max(highest_.x, point.x), std::max(highest_.y, point.y)};
  };
  for (const Point& point : recording.plan) {
    include(point);
  }
  for (const NewPlan& plan : recording.new_plans) {
    for (const Point& point : plan.path) {
      include(point);
    }
  }
  for (const PlantRecording& plant : recording.plants) {
    for (const double time : plant.times()) {
      include(plant.Position(time));
    }
  }
}

Point CameraSubject::SmoothPosition(double time) const {
  const auto mean = Smooth(time, [this](double at) {
    const Point point = car_.Position(at);
    return std::array<double, 2>{point.x, point.y};
  });
  return {mean[0], mean[1]};
}

double CameraSubject::SmoothHeading(double time) const {
  return Smooth(time, [this](double at) {
    return std::array<double, 2>{car_.Heading(at), 0.0};
  })[0];
}

double CameraSubject::SmoothGround(double time) const {
  return Smooth(time, [this](double at) {
    return std::array<double, 2>{recording_.OnGround(car_.Position(at)).z, 0.0};
  })[0];
}

double CameraSubject::SmoothReverse(double time) const {
  return Smooth(time, [this](double at) {
    return std::array<double, 2>{reverse_[car_.log().At(at).row], 0.0};
  })[0];
}

const std::vector<Camera>& CameraTable() {
  static const std::vector<Camera> table{
      {"chase", &Chase}, {"side", &Side}, {"driver", &Driver}, {"orbit", &Orbit}, {"top", &Top}};
  return table;
}

const Camera& FindCamera(const std::string& name, const char* key) {
  std::vector<std::string> names;
  for (const Camera& camera : CameraTable()) {
    if (camera.name == name) {
      return camera;
    }
    names.emplace_back(camera.name);
  }
  throw InputError(
      Problem{.file = "", .key = key, .message = "unknown camera " + UnknownName(name, names)});
}

}  // namespace trackbed::render
