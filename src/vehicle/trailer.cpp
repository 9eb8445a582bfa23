#include "trackbed/vehicle/trailer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

[[noreturn]] void Fail(const char* key, std::string message) {
  throw InputError(
      Problem{.key = std::string("vehicle.trailer.") + key, .message = std::move(message)});
}

void Check(const TrailerParams& trailer, const VehicleParams& car) {
  if (!(trailer.hitch > car.rear_overhang)) {
    Fail("hitch",
         fmt::format("{:.4g} m behind the rear axle is under the car; must be above {:.4g} "
                     "m, its rear overhang",
                     trailer.hitch, car.rear_overhang));
  }
  if (!(trailer.body_front() > 0.0)) {
    Fail("tongue",
         fmt::format("{:.4g} m: the body begins {:.4g} m ahead of the hitch; must be above {:.4g} "
                     "m, or the body shorter or farther back (length, body_ahead)",
                     trailer.tongue, -trailer.body_front(), trailer.tongue - trailer.body_front()));
  }
  if (!(std::abs(trailer.cg_ahead) < trailer.tongue)) {
    Fail("cg_ahead", fmt::format("{:.4g} m; must be between -{:.4g} and {:.4g} m, the tongue",
                                 trailer.cg_ahead, trailer.tongue, trailer.tongue));
  }
}

/// A side of the rectangular outline of car or trailer, in coordinates relative to the hitch.
struct Side {
  Vec2 from;
  Vec2 to;
};

std::vector<Side> SidesOf(const std::vector<Vec2>& corners) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sides.push_back({corners[i], corners[(i + 1) % corners.size()]});
  }
  return sides;
}

double PolarAngle(const Vec2& point) {
  return std::atan2(point.y(), point.x());
}

/// Calls `call` with the polar angle of each point of an outline's side that is at the distance
/// `radius` from the hitch.
template <typename Call>
void ForEachPointAt(const Side& side, double radius, const Call& call) {
  const Vec2 along = side.to - side.from;
  const double a = along.squaredNorm();
  const double b = side.from.dot(along);
  const double root = b * b - a * (side.from.squaredNorm() - radius * radius);
  if (a == 0.0 || root < 0.0) {
    return;
  }
  for (const double sign : {-1.0, 1.0}) {
    const double part = (-b + sign * std::sqrt(root)) / a;
    if (part >= 0.0 && part <= 1.0) {
      call(PolarAngle(side.from + part * along));
    }
  }
}

/// Returns an angle of [0, 2 pi) that differs from `angle` by whole turns.
double Positive(double angle) {
  return angle - 2.0 * kPi * std::floor(angle / (2.0 * kPi));
}

}  // namespace

std::array<double, 13> TrailerNumbers(const TrailerParams& trailer) {
  return {trailer.hitch,       trailer.hitch_height, trailer.tongue,   trailer.track,
          trailer.length,      trailer.width,        trailer.height,   trailer.body_ahead,
          trailer.mass,        trailer.yaw_inertia,  trailer.cg_ahead, trailer.cg_height,
          trailer.wheel_radius};
}

TrailerParams TrailerFromNumbers(const std::array<double, 13>& numbers) {
  const auto& [hitch, hitch_height, tongue, track, length, width, height, body_ahead, mass,
               yaw_inertia, cg_ahead, cg_height, wheel_radius] = numbers;
  return {.hitch = hitch,
          .hitch_height = hitch_height,
          .tongue = tongue,
          .track = track,
          .length = length,
          .width = width,
          .height = height,
          .body_ahead = body_ahead,
          .mass = mass,
          .yaw_inertia = yaw_inertia,
          .cg_ahead = cg_ahead,
          .cg_height = cg_height,
          .wheel_radius = wheel_radius};
}

TrailerParams MakeTrailer(const TrailerOptions& options, const VehicleParams& car) {
  TrailerParams trailer;
  trailer.hitch = options.hitch.value_or(car.rear_overhang + 0.02 * car.length);
  trailer.wheel_radius = options.wheel_radius.value_or(car.wheel_radius);
  trailer.hitch_height = options.hitch_height.value_or(1.2 * car.wheel_radius);
  trailer.tongue = options.tongue.value_or(car.wheelbase);
  trailer.track = options.track.value_or(car.track_rear);
  trailer.length = options.length.value_or(0.6 * car.length);
  trailer.width = options.width.value_or(car.width);
  trailer.height = options.height.value_or(0.8 * car.height);
  trailer.body_ahead = options.body_ahead.value_or(0.0);
  trailer.mass = options.mass.value_or(0.4 * car.mass);
  trailer.yaw_inertia = options.yaw_inertia.value_or(
      trailer.mass / 12.0 * (trailer.length * trailer.length + trailer.width * trailer.width));
  trailer.cg_ahead = options.cg_ahead.value_or(0.06 * trailer.tongue);
  trailer.cg_height = options.cg_height.value_or(1.75 * car.wheel_radius);
  Check(trailer, car);
  return trailer;
}

Pose2 TrailerPose(const TrailerParams& trailer, const Pose2& car, double angle) {
  const Vec2 hitch = ToWorld(car, {-trailer.hitch, 0.0});
  const double yaw = car.yaw + angle;
  const Vec2 axle = hitch - trailer.tongue * Direction(yaw);
  return {axle.x(), axle.y(), yaw};
}

OrientedBox TrailerFootprint(const TrailerParams& trailer, const Pose2& pose) {
  const Vec2 middle = ToWorld(pose, {trailer.body_ahead, 0.0});
  return {{middle.x(), middle.y(), pose.yaw}, trailer.length, trailer.width};
}

VehicleParams TrailerBody(const TrailerParams& trailer) {
  VehicleParams body;
  body.name = "trailer";
  body.length = trailer.length;
  body.width = trailer.width;
  body.height = trailer.height;
  body.rear_overhang = 0.5 * trailer.length - trailer.body_ahead;
  return body;
}

double JackknifeAngle(const TrailerParams& trailer, const VehicleParams& car) {
  // Car and trailer first touch where a corner of one outline meets a side of the other outline.
  // A corner of one outline moves on a circle about the hitch, as seen from the other outline. The
  // hitch angle of each contact therefore has a closed form. The outlines are symmetric, so only
  // positive hitch angles are searched.
  const double near = trailer.hitch - car.rear_overhang;
  const double half_width = 0.5 * car.width;
  const std::vector<Vec2> car_corners{{near, half_width},
                                      {near, -half_width},
                                      {near + car.length, -half_width},
                                      {near + car.length, half_width}};
  const double front = -trailer.body_front();
  const double side = 0.5 * trailer.width;
  const std::vector<Vec2> body_corners{{front, side},
                                       {front, -side},
                                       {front - trailer.length, -side},
                                       {front - trailer.length, side}};
  std::vector<Side> trailer_sides = SidesOf(body_corners);
  trailer_sides.push_back({{0.0, 0.0}, {front, 0.0}});  // the drawbar
  double smallest = kPi;
  for (const Side& car_side : SidesOf(car_corners)) {
    for (const Vec2& corner : body_corners) {
      ForEachPointAt(car_side, corner.norm(), [&](double touched) {
        smallest = std::min(smallest, Positive(touched - PolarAngle(corner)));
      });
    }
  }
  for (const Side& trailer_side : trailer_sides) {
    for (const Vec2& corner : car_corners) {
      ForEachPointAt(trailer_side, corner.norm(), [&](double touching) {
        smallest = std::min(smallest, Positive(PolarAngle(corner) - touching));
      });
    }
  }
  return smallest;
}

double RollingHitchRate(const TrailerParams& trailer, double angle, double speed, double yaw_rate) {
  return -speed * std::sin(angle) / trailer.tongue -
         yaw_rate * (1.0 + trailer.hitch * std::cos(angle) / trailer.tongue);
}

double RolledHitchAngle(const TrailerParams& trailer, double angle, double curvature,
                        double distance) {
  // The hitch angle theta obeys du/ds = A + B u + C u^2 with u = tan(theta/2), where A, B and C are
  // constants. With u = p/q, this equation becomes the linear system
  //   p' = B/2 p + A q,  q' = -C p - B/2 q,
  // whose matrix M has the square M^2 = (B^2/4 - A C) I, with the unit matrix I.
  const double ratio = trailer.hitch / trailer.tongue;
  const double a = -0.5 * curvature * (1.0 + ratio);
  const double half_b = -0.5 / trailer.tongue;
  const double c = -0.5 * curvature * (1.0 - ratio);
  const double square = half_b * half_b - a * c;
  const double root = std::sqrt(std::abs(square));
  // compute the matrix exponential exp(M s) up to a positive factor, which changes neither p/q nor
  // the quadrant of (q, p)
  double even = 1.0;
  double odd = distance;
  if (root * std::abs(distance) > 1e-12) {
    even = square > 0.0 ? 1.0 : std::cos(root * distance);
    odd = (square > 0.0 ? std::tanh(root * distance) : std::sin(root * distance)) / root;
  }
  const double p = std::sin(0.5 * angle);
  const double q = std::cos(0.5 * angle);
  const double after = 2.0 * std::atan2(even * p + odd * (half_b * p + a * q),
                                        even * q + odd * (-c * p - half_b * q));
  return angle + AngleDifference(after, angle);
}

}  // namespace trackbed
