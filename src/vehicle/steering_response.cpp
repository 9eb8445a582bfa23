#include "trackbed/vehicle/steering_response.h"

#include <math.h>  // pchip.hpp uses ::isnan

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns the dead time of the steering as a number of timesteps.
double DeadTimeSteps(const SteeringResponse& response, double timestep, double start) {
  TRACKBED_REQUIRE(response.time_constant >= 0.0 && std::isfinite(response.time_constant) &&
                       response.backlash >= 0.0 && std::isfinite(response.backlash) &&
                       std::isfinite(start),
                   "SteeringFilter: time constant {} s, backlash {} rad, start {} rad; must be "
                   "finite, the first two at least 0",
                   response.time_constant, response.backlash, start);
  constexpr double kMaxSteps = 1e7;
  const double steps = response.dead_time / timestep;
  TRACKBED_REQUIRE(timestep > 0.0 && response.dead_time >= 0.0 && steps <= kMaxSteps,
                   "SteeringFilter: a dead time of {} s in timesteps of {} s; must be at most {} "
                   "steps",
                   response.dead_time, timestep, kMaxSteps);
  // Tolerance within which the ratio of dead time to timestep counts as a whole number.
  constexpr double kRounding = 1e-6;
  const double whole = std::round(steps);
  return std::abs(steps - whole) < kRounding ? whole : steps;
}

}  // namespace

MonotoneCurve::MonotoneCurve(const std::vector<Vec2>& points) {
  TRACKBED_REQUIRE(points.size() >= 4, "MonotoneCurve: {} points; must be at least 4",
                   points.size());
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool rises =
        i == 0 || (points[i].x() > points[i - 1].x() && points[i].y() > points[i - 1].y());
    TRACKBED_REQUIRE(points[i].allFinite() && rises,
                     "MonotoneCurve: point {} is ({}, {}); both must be finite and increase", i,
                     points[i].x(), points[i].y());
    x.push_back(points[i].x());
    y.push_back(points[i].y());
  }
  first_ = x.front();
  last_ = x.back();
  interpolant_ = boost::math::interpolators::pchip(std::move(x), std::move(y));
}

double MonotoneCurve::At(double x) const {
  TRACKBED_REQUIRE(std::isfinite(x), "MonotoneCurve::At: {}; must be finite", x);
  return interpolant_(std::clamp(x, first_, last_));
}

bool SteeringResponse::ideal() const {
  return curve.empty() && dead_time == 0.0 && time_constant == 0.0 && backlash == 0.0;
}

SteeringFilter::SteeringFilter(const SteeringResponse& response, double timestep, double start)
    : half_backlash_(0.5 * response.backlash), arrived_(start), lagged_(start), output_(start) {
  const double steps = DeadTimeSteps(response, timestep, start);
  delay_line_.assign(static_cast<std::size_t>(steps), start);
  dead_time_fraction_ = steps - std::floor(steps);
  if (!response.curve.empty()) {
    curve_.emplace(response.curve);
  }
  decay_ = response.time_constant > 0.0 ? std::exp(-timestep / response.time_constant) : 0.0;
}

double SteeringFilter::Pass(double command) {
  TRACKBED_REQUIRE(std::isfinite(command), "SteeringFilter::Pass: {} rad; must be finite", command);
  double arrived = curve_ ? curve_->At(command) : command;
  if (!delay_line_.empty()) {
    std::swap(arrived, delay_line_[oldest_]);
    oldest_ = (oldest_ + 1) % delay_line_.size();
  }
  if (dead_time_fraction_ > 0.0) {
    const double before = std::exchange(arrived_, arrived);
    arrived = std::lerp(arrived, before, dead_time_fraction_);
  }
  lagged_ = decay_ == 0.0 ? arrived : arrived + decay_ * (lagged_ - arrived);
  output_ = std::clamp(output_, lagged_ - half_backlash_, lagged_ + half_backlash_);
  return output_;
}

}  // namespace trackbed
