#include "src/recording/log_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "src/recording/local_polynomial.h"
#include "trackbed/control/signal.h"
#include "trackbed/core/angle.h"

// Compares columns of a log with derivatives of the logged positions, which are fitted by local
// polynomials. The logged yaw and its derivative are compared with the direction of motion. The
// columns for speed, yaw rate and steering are fitted to the motion of the pose by least squares;
// the slope or the sign of the fit reveals a contradiction. A wrong unit or sign is recognized if
// the corrected column agrees with the motion, or if the fitted factor is 3.6, 180/pi or -1. The
// size of an error is measured by the upper quartile, because the upper quartile is robust against
// outliers. Noise of the positions makes the derivatives over short times useless: at 100 rows per
// second, position errors of millimeters become yaw rate errors of radians per second. A
// contradiction between rates is reported only if polynomials of all window widths show it. The
// widths range from the width in the map to 0.8 s.
namespace trackbed {
namespace {

// Typical yaw rate below which a drive turns too little to be judged [rad/s].
constexpr double kTurns = 0.02;

/// Motion at one moment of the drive, derived from the logged positions and yaw.
struct Moment {
  double time;
  double speed;        // Speed of the measured point [m/s].
  double course;       // Direction of motion [rad].
  double course_rate;  // Rate of change of the direction of motion [rad/s].
  double yaw_rate;     // Rate of change of the logged yaw [rad/s].
  double yaw;          // Logged yaw [rad].
};

double UpperQuartile(std::vector<double> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 3 / 4);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Returns moments of the drive at which the measured point moves with at least a fifth of its RMS
/// speed. Before the computation, the logged yaw is multiplied by `scale`. The polynomials reach
/// `half_width` [s] to both sides. Moments() returns fewer than 8000 moments, evenly distributed
/// over the drive.
std::vector<Moment> Moments(const LogRows& rows, const LogMap& map, double scale,
                            double half_width) {
  constexpr std::size_t kMaxMoments = 4000;
  std::vector<double> yaw = rows.yaw;
  for (double& angle : yaw) {
    angle *= scale;
  }
  Unwrap(yaw);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(yaw.size()), 3);
  for (std::size_t i = 0; i < yaw.size(); ++i) {
    values.row(static_cast<Eigen::Index>(i)) << rows.position[i].x(), rows.position[i].y(), yaw[i];
  }
  const LocalPolynomial fits(rows.time, values, half_width, map.resample.degree);
  std::vector<Moment> all;
  const std::size_t step = std::max<std::size_t>(1, rows.time.size() / kMaxMoments);
  double squares = 0.0;
  for (const LogStretch& stretch : SplitAtGaps(rows.time, map.gap)) {
    for (std::size_t i = stretch.first; i < stretch.end; i += step) {
      const LocalFit fit = fits.At(rows.time[i], stretch);
      const Vec2 velocity = fit.row(1).head<2>();
      const Vec2 acceleration = fit.row(2).head<2>();
      const double square = velocity.squaredNorm();
      squares += square;
      all.push_back({.time = rows.time[i],
                     .speed = std::sqrt(square),
                     .course = std::atan2(velocity.y(), velocity.x()),
                     .course_rate = square > 0.0 ? Cross(velocity, acceleration) / square : 0.0,
                     .yaw_rate = fit(1, 2),
                     .yaw = fit(0, 2)});
    }
  }
  const double slow = 0.2 * std::sqrt(squares / static_cast<double>(all.size()));
  std::erase_if(all, [&](const Moment& moment) { return moment.speed < std::max(slow, 1e-3); });
  return all;
}

/// Returns how badly the logged yaw fits the direction of motion. The misfit compares the yaw rate
/// with the rate of change of the direction of motion. The upper quartile of their difference is
/// divided by the upper quartile of the direction's rate. Returns nullopt if the vehicle hardly
/// turns.
std::optional<double> Misfit(const std::vector<Moment>& moments) {
  std::vector<double> apart;
  std::vector<double> course;
  for (const Moment& moment : moments) {
    apart.push_back(std::abs(moment.yaw_rate - moment.course_rate));
    course.push_back(std::abs(moment.course_rate));
  }
  if (course.size() < 20 || UpperQuartile(course) < kTurns) {
    return std::nullopt;
  }
  return UpperQuartile(apart) / UpperQuartile(course);
}

/// Returns the half-widths [s] of the windows to which polynomials are fitted for the comparison of
/// rates.
std::vector<double> HalfWidths(const LogMap& map) {
  constexpr double kWidest = 0.8;  // [s]
  std::vector<double> widths{map.resample.half_width};
  while (2.0 * widths.back() <= kWidest * (1.0 + 1e-9)) {
    widths.push_back(2.0 * widths.back());
  }
  return widths;
}

/// Returns the smallest misfit over all widths; nullopt if the vehicle hardly turns. Skips the
/// remaining widths of the polynomials after a misfit below `enough`. If only noise turns the
/// course, the misfit of narrow polynomials is near 1, because the course turns much more than the
/// yaw.
std::optional<double> LeastMisfit(const LogRows& rows, const LogMap& map, double scale,
                                  double enough) {
  constexpr double kLikeNoise = 0.3;  // Misfits that are closer to 1 may be noise.
  std::optional<double> least;
  for (const double width : HalfWidths(map)) {
    const std::optional<double> misfit = Misfit(Moments(rows, map, scale, width));
    if (!misfit && (!least || std::abs(*least - 1.0) < kLikeNoise)) {
      return std::nullopt;
    }
    if (misfit) {
      least = std::min(*misfit, least.value_or(*misfit));
    }
    if (*least < enough) {
      break;
    }
  }
  return least;
}

using Found = std::vector<std::pair<std::string, std::string>>;

const char* YawKey(const LogMap& map) {
  return map.yaw ? "yaw" : "orientation";
}

void CheckYawRateOfYaw(const LogRows& rows, const LogMap& map, Found& found) {
  constexpr double kContradictionLimit = 0.7;
  constexpr double kAgreementLimit = 0.35;
  const auto [least, most] = std::minmax_element(rows.yaw.begin(), rows.yaw.end());
  const bool is_constant = *most - *least < 1e-6;
  const std::optional<double> misfit =
      is_constant ? Misfit(Moments(rows, map, 1.0, map.resample.half_width))
                  : LeastMisfit(rows, map, 1.0, kContradictionLimit);
  if (!misfit || *misfit < kContradictionLimit) {
    return;
  }
  struct Explanation {
    double scale;
    const char* text;
  };
  const std::array explanations{
      Explanation{kPi / 180.0,
                  "the numbers look like degrees that are read as radians: set unit: deg"},
      Explanation{180.0 / kPi,
                  "the numbers look like radians that are read as degrees: set unit: rad"},
      Explanation{-1.0,
                  "the car turns the other way than its path does: look at frame, and at the order "
                  "of position.x and position.y, or set scale: -1"}};
  for (const Explanation& explanation : explanations) {
    if (LeastMisfit(rows, map, explanation.scale, kAgreementLimit).value_or(1.0) <
        kAgreementLimit) {
      found.emplace_back(YawKey(map), explanation.text);
      return;
    }
  }
  found.emplace_back(
      YawKey(map),
      is_constant
          ? "the yaw is constant while the path turns"
          : fmt::format(
                "the yaw does not turn as the path does: yaw rates differ from those of the "
                "course by {:.0f} % of the latter",
                100.0 * *misfit));
}

/// Detects a logged yaw that differs from the direction of motion by a constant angle, as compass
/// headings do.
void CheckHeading(const std::vector<Moment>& moments, const LogMap& map, Found& found) {
  if (moments.size() < 20) {
    return;
  }
  Vec2 mean = Vec2::Zero();
  for (const Moment& moment : moments) {
    mean += Direction(moment.yaw - map.sensor.yaw - moment.course);
  }
  mean /= static_cast<double>(moments.size());
  const double off = std::atan2(mean.y(), mean.x());
  // Smallest length of the mean of the unit vectors from which the angle counts as constant; the
  // length is 1 if all unit vectors are equal.
  constexpr double kMinConcentration = 0.9;
  // Ignore an offset near half a turn, because a drive in reverse causes such an offset.
  if (mean.norm() > kMinConcentration && std::abs(off) > 0.6 && std::abs(off) < kPi - 0.6) {
    found.emplace_back(YawKey(map),
                       fmt::format("the car moves {:.3g} rad to the {} of where it points, all the "
                                   "time: look at frame, sensor.yaw and the yaw's offset",
                                   std::abs(off), off > 0.0 ? "right" : "left"));
  }
}

/// Least-squares fit of a log column by the product b q, where q is a quantity of the pose: the
/// slope b, and the correlation between the column and q.
struct Ratio {
  double slope = 0.0;
  double correlation = 0.0;
  std::size_t count = 0;
};

template <typename OfPose>
Ratio RatioTo(const LogSeries& series, const std::vector<Moment>& moments, const OfPose& of_pose) {
  Signal signal;
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    signal.knots.emplace_back(series.time[i], series.value[i]);
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  Ratio ratio;
  for (const Moment& moment : moments) {
    if (signal.empty() || moment.time < series.time.front() || moment.time > series.time.back()) {
      continue;
    }
    const double x = of_pose(moment);
    const double y = signal.At(moment.time);
    xx += x * x;
    xy += x * y;
    yy += y * y;
    ++ratio.count;
  }
  if (xx > 0.0 && yy > 0.0) {
    ratio.slope = xy / xx;
    ratio.correlation = xy / std::sqrt(xx * yy);
  }
  return ratio;
}

bool IsNear(double value, double wanted) {
  constexpr double kRelativeTolerance = 0.15;
  return std::abs(value / wanted - 1.0) < kRelativeTolerance;
}

void CheckSpeed(const LogRows& rows, const std::vector<Moment>& moments, Found& found) {
  const Ratio ratio = RatioTo(rows.signals[kSpeedSignal], moments,
                              [](const Moment& moment) { return moment.speed; });
  const double times = std::abs(ratio.slope);
  if (ratio.count < 20 || (times > 0.67 && times < 1.5)) {
    return;
  }
  found.emplace_back(
      "speed",
      IsNear(times, 3.6) ? "the numbers look like km/h that are read as m/s: set unit: km/h"
      : IsNear(times, 1.0 / 3.6)
          ? "the numbers look like m/s that are read as km/h: set unit: m/s"
          : fmt::format(
                "the column's speed is {:.3g} times that of the position: look at the units "
                "of both",
                times));
}

void CheckYawRate(const LogRows& rows, const LogMap& map, Found& found) {
  Ratio ratio;
  for (const double width : HalfWidths(map)) {
    const std::vector<Moment> moments = Moments(rows, map, 1.0, width);
    std::vector<double> rates;
    for (const Moment& moment : moments) {
      rates.push_back(std::abs(moment.yaw_rate));
    }
    if (rates.size() < 20 || UpperQuartile(rates) < kTurns) {
      return;
    }
    ratio = RatioTo(rows.signals[kYawRateSignal], moments,
                    [](const Moment& moment) { return moment.yaw_rate; });
    if (ratio.count < 20 || (ratio.slope > 0.67 && ratio.slope < 1.5)) {
      return;
    }
  }
  const double times = std::abs(ratio.slope);
  std::string text =
      IsNear(times, 180.0 / kPi)
          ? "the numbers look like deg/s that are read as rad/s: set unit: deg/s"
      : IsNear(times, kPi / 180.0)
          ? "the numbers look like rad/s that are read as deg/s: set unit: rad/s"
      : IsNear(times, 1.0)
          ? "the column turns the other way than the yaw does: set scale: -1, or look at frame"
          : fmt::format("the column is {:.3g} times the rate of the yaw", ratio.slope);
  if (ratio.slope < 0.0 && !IsNear(times, 1.0)) {
    text += ", and its sign is the other one: set scale: -1";
  }
  found.emplace_back("yaw_rate", text);
}

void CheckSteering(const LogRows& rows, const LogMap& map, LogSignal signal, Found& found) {
  constexpr double kCertain = 0.7;  // smallest |correlation| with a reliable sign
  for (const double width : HalfWidths(map)) {
    // Compare tan(delta) of the steering angle delta with the curvature of the path, because
    // tan(delta) is proportional to the curvature, whatever the wheelbase is.
    const Ratio ratio =
        RatioTo(rows.signals[signal], Moments(rows, map, 1.0, width),
                [](const Moment& moment) { return moment.course_rate / moment.speed; });
    if (ratio.count < 20 || ratio.correlation > kCertain) {
      return;
    }
    if (ratio.correlation < -kCertain) {
      found.emplace_back(
          kLogSignalKeys[signal],
          "the car turns the other way than it steers: set scale: -1, or look at frame");
      return;
    }
  }
}

}  // namespace

Found FindContradictions(const LogRows& rows, const LogMap& map) {
  Found found;
  const std::vector<Moment> moments = Moments(rows, map, 1.0, map.resample.half_width);
  if (!map.heading_from_motion) {
    CheckYawRateOfYaw(rows, map, found);
  }
  if (found.empty() && !map.heading_from_motion) {
    CheckHeading(moments, map, found);
  }
  if (rows.has[kSpeedSignal]) {
    CheckSpeed(rows, moments, found);
  }
  // Check the logged yaw rate only if no problem was found so far, because the check uses the
  // logged yaw.
  if (rows.has[kYawRateSignal] && found.empty()) {
    CheckYawRate(rows, map, found);
  }
  for (const LogSignal signal : {kSteeringSignal, kSteeringCommandSignal}) {
    if (rows.has[signal]) {
      CheckSteering(rows, map, signal, found);
    }
  }
  return found;
}

}  // namespace trackbed
