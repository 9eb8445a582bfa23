#include "src/identify/bank_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/track/closed_spline.h"

// Makes the bank of a road a set of identified parameters: the bank at evenly spaced knots of a
// spline along the road. The road is the given track, or the path of the first record with edges
// that all records stay within. For an open road, the closed spline runs along the road and its
// mirror image. BankedGround makes the terrain for each set of bank values.

namespace trackbed {
namespace {

constexpr const char* kPrefix = "bank[";
// Largest number of parameters of a study, because QuadraticProgram supports no more variables.
constexpr std::size_t kMostParameters = 40;

/// Returns the index of the sample that ends the first lap of a drive. The lap ends at the sample
/// nearest to the sample `first` after the car has returned from far away, heading in the same
/// direction. Returns nullopt if the car does not return to the place of `first`.
std::optional<std::size_t> EndOfLap(const std::vector<RecordedSample>& samples, std::size_t first) {
  const Pose2 start = samples[first].pose;
  const auto away = [&](std::size_t i) {
    return (samples[i].pose.position() - start.position()).norm();
  };
  double farthest = 0.0;
  for (std::size_t i = first; i < samples.size(); ++i) {
    farthest = std::max(farthest, away(i));
  }
  // The constants kLeft, kBack and kPassed are fractions of the largest distance from the start.
  // Beyond kLeft, the car has left the start; within kBack, the car has returned. The car has
  // passed the start if its distance from the start exceeds the smallest distance since its return
  // by kPassed.
  constexpr double kLeft = 0.5;
  constexpr double kBack = 0.2;
  constexpr double kPassed = 0.05;
  constexpr double kSameHeading = 0.5;  // [rad]
  bool left = false;
  std::optional<std::size_t> nearest;
  for (std::size_t i = first; i < samples.size(); ++i) {
    left = left || away(i) > kLeft * farthest;
    const bool back = left && away(i) < kBack * farthest &&
                      std::abs(AngleDifference(samples[i].pose.yaw, start.yaw)) < kSameHeading;
    if (back && (!nearest || away(i) < away(*nearest))) {
      nearest = i;
    } else if (nearest && away(i) > away(*nearest) + kPassed * farthest) {
      return nearest;
    }
  }
  return nearest;
}

/// Returns evenly spaced points on the path of a recorded drive: on its first lap if the car
/// returns to its start, else on the whole drive. The gap between the end and the start of the lap
/// is distributed over the lap.
CenterPoints PathOf(const Scenario& scenario, const Identification& study) {
  const std::vector<RecordedSample>& samples = scenario.record->data->samples;
  const auto moves = [&](const RecordedSample& sample) {
    return sample.valid && std::abs(sample.velocity_V.x()) >= scenario.record->min_speed;
  };
  const auto first = static_cast<std::size_t>(std::find_if(samples.begin(), samples.end(), moves) -
                                              samples.begin());
  const std::optional<std::size_t> lap =
      first < samples.size() ? EndOfLap(samples, first) : std::nullopt;
  const std::size_t last = lap.value_or(samples.size() - 1);
  std::vector<double> driven{0.0};
  for (std::size_t i = first + 1; i <= last; ++i) {
    driven.push_back(driven.back() +
                     (samples[i].pose.position() - samples[i - 1].pose.position()).norm());
  }
  if (!(driven.back() > 0.0)) {
    throw InputError(
        Problem{.file = study.file.string(),
                .key = "bank.track",
                .message = fmt::format("missing, and the car stands still in the record of {}; "
                                       "name the file of the track that was driven on",
                                       scenario.name)});
  }
  constexpr double kSpacing = 2.0;  // [m]
  const double length = driven.back();
  const auto count =
      static_cast<std::size_t>(std::clamp(std::ceil(length / kSpacing), 40.0, 1000.0));
  const std::size_t parts = lap ? count : count - 1;
  const Vec2 gap =
      lap ? Vec2(samples[last].pose.position() - samples[first].pose.position()) : Vec2(0.0, 0.0);
  CenterPoints path{.points = {}, .closed = lap.has_value()};
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(parts);
    while (i + 2 < driven.size() && driven[i + 1] <= part * length) {
      ++i;
    }
    const double step = driven[i + 1] - driven[i];
    const double share = step > 0.0 ? (part * length - driven[i]) / step : 0.0;
    const Vec2 from = samples[first + i].pose.position();
    const Vec2 at = from + share * (samples[first + i + 1].pose.position() - from) - part * gap;
    path.points.push_back({at, 1.0, 1.0});
  }
  return path;
}

/// Returns the offset of a point from the polyline through points, positive to the left.
double OffsetFrom(const CenterPoints& line, const Vec2& at) {
  double offset = std::numeric_limits<double>::infinity();
  const std::size_t count = line.points.size();
  for (std::size_t i = 0; i + (line.closed ? 0 : 1) < count; ++i) {
    const Vec2& from = line.points[i].position;
    const Vec2 chord = line.points[(i + 1) % count].position - from;
    const double share = std::clamp((at - from).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
    const Vec2 apart = at - from - share * chord;
    if (apart.norm() < std::abs(offset)) {
      offset = std::copysign(apart.norm(), Cross(chord, apart));
    }
  }
  return offset;
}

/// Returns the smallest radius of the circles through three neighboring points [m].
double SmallestRadius(const CenterPoints& line) {
  double smallest = std::numeric_limits<double>::infinity();
  const std::size_t count = line.points.size();
  for (std::size_t i = 0; i + (line.closed ? 0 : 2) < count; ++i) {
    const Vec2 a = line.points[i].position;
    const Vec2 b = line.points[(i + 1) % count].position;
    const Vec2 c = line.points[(i + 2) % count].position;
    const double area = 0.5 * std::abs(Cross(b - a, c - a));
    smallest = std::min(
        smallest, (b - a).norm() * (c - b).norm() * (c - a).norm() / std::max(4.0 * area, 1e-9));
  }
  return smallest;
}

/// Returns the path of the first record, with edges that all records stay within.
CenterPoints TrackOfRecords(const Identification& study) {
  const Scenario& first = study.fit_scenarios.front();
  CenterPoints line = PathOf(first, study);
  double left = 0.0;
  double right = 0.0;
  for (const auto* scenarios : {&study.fit_scenarios, &study.held_out_scenarios}) {
    for (const Scenario& scenario : *scenarios) {
      constexpr double kSpacing = 1.0;  // Spacing of the samples compared with the track [m].
      std::optional<Vec2> before;
      for (const RecordedSample& sample : scenario.record->data->samples) {
        const Vec2 at = sample.pose.position();
        if (!sample.valid || (before && (at - *before).norm() < kSpacing)) {
          continue;
        }
        before = at;
        const double offset = OffsetFrom(line, at);
        left = std::max(left, offset);
        right = std::max(right, -offset);
        constexpr double kWidest = 30.0;  // largest width of a road to either side [m]
        if (!line.closed && std::abs(offset) > kWidest) {
          throw InputError(Problem{
              .file = study.file.string(),
              .key = "bank.track",
              .message = fmt::format("missing, and {} drives {:.3g} m beside the path of {}; name "
                                     "the file of a track that all records follow, or remove {}",
                                     scenario.name, std::abs(offset), first.name, scenario.name)});
        }
      }
    }
  }
  const double half = 0.5 * LoadCar(first).params().width;
  constexpr double kFold = 0.9;  // Largest ratio of the ground's width to the smallest radius.
  const double widest = kFold * SmallestRadius(line);
  for (TrackPoint& point : line.points) {
    point.width_left = std::min(left + half, widest);
    point.width_right = std::min(right + half, widest);
  }
  return line;
}

/// Returns the number of knots of the bank's spline. Throws InputError if the study cannot estimate
/// a parameter for each knot.
std::size_t KnotsOf(const Identification& study, double length, bool closed) {
  const std::size_t room = kMostParameters - std::min(kMostParameters, study.parameters.size());
  // An open road needs one more knot than a closed road, because it has knots at both ends. The
  // mirror image of the road repeats the knots between the ends.
  const std::size_t more = closed ? 0 : 1;
  const std::size_t least =
      closed ? ClosedSplineBasis::kMinFunctions : ClosedSplineBasis::kMinFunctions / 2 + more;
  const auto knots = more + static_cast<std::size_t>(std::lround(std::min(
                                1e6, length / study.bank->spacing.value_or(length / 8.0))));
  if (std::max(knots, least) > room) {
    const std::string remedy = room < least
                                   ? fmt::format("remove {} parameters", least - room)
                                   : fmt::format("set it to {:.4g} m or more",
                                                 length / static_cast<double>(room - more) + 0.05);
    throw InputError(Problem{
        .file = study.file.string(),
        .key = "bank.spacing",
        .message = fmt::format("the track of {:.4g} m has {} knots, but a study estimates at most "
                               "{} parameters, {} of them others; {}",
                               length, std::max(knots, least), kMostParameters,
                               study.parameters.size(), remedy)});
  }
  return std::max(knots, least);
}

CenterPoints PointsOf(const Identification& study) {
  TRACKBED_CHECK(study.bank && !study.fit_scenarios.empty(), "a study {}", "without bank");
  return study.bank->center.points.empty() ? TrackOfRecords(study) : study.bank->center;
}

/// Returns the basis of a spline with the given knots. For an open road, the spline basis contains
/// the knots of the road and of its mirror image.
ClosedSplineBasis BasisOf(const BankedGround& ground, std::size_t knots) {
  return ground.closed() ? ClosedSplineBasis(ground.length(), knots)
                         : ClosedSplineBasis(2.0 * ground.length(), 2 * (knots - 1));
}

}  // namespace

bool IsBankParameter(const std::string& name) {
  return name.starts_with(kPrefix);
}

BankModel::BankModel(const Identification& study) : BankModel(study, PointsOf(study)) {}

BankModel::BankModel(const Identification& study, CenterPoints points)
    : options_(*study.bank),
      ground_(std::move(points.points), points.closed),
      knots_(KnotsOf(study, ground_.length(), ground_.closed())),
      basis_(BasisOf(ground_, knots_)) {}

std::vector<IdentifiedParameter> BankModel::Parameters() const {
  std::vector<IdentifiedParameter> parameters;
  for (std::size_t i = 0; i < knots_; ++i) {
    parameters.push_back({.name = fmt::format("{}{}]", kPrefix, i),
                          .from = -options_.largest,
                          .to = options_.largest,
                          .start = 0.0,
                          .prior = ParameterPrior{.mean = 0.0, .deviation = options_.deviation}});
  }
  return parameters;
}

BankedTrack BankModel::At(std::span<const double> parameters) const {
  TRACKBED_CHECK(parameters.size() == knots_, "{} values for {} knots", parameters.size(), knots_);
  Eigen::MatrixXd coefficients(static_cast<Eigen::Index>(basis_.count()), 1);
  for (std::size_t i = 0; i < basis_.count(); ++i) {
    coefficients(static_cast<Eigen::Index>(i), 0) = parameters[i < knots_ ? i : basis_.count() - i];
  }
  BankedTrack banked{
      .points = ground_.points(), .banks = {}, .heights = {}, .closed = ground_.closed()};
  for (std::size_t i = 0; i < banked.points.size(); ++i) {
    banked.banks.push_back(Evaluate(basis_.At(ground_.StationOf(i), 0), coefficients, 0)[0]);
    banked.heights.push_back(0.0);
  }
  return banked;
}

std::shared_ptr<const Terrain> BankModel::GroundAt(std::span<const double> parameters) const {
  const BankedTrack track = At(parameters);
  return ground_.With(track.banks, track.heights);
}

Scenario OnGround(Scenario scenario, std::shared_ptr<const BankedTrack> track,
                  std::shared_ptr<const Terrain> terrain) {
  scenario.record->ground = kBankCsv;
  scenario.record->ground_data = std::move(track);
  scenario.world.ground.terrain = std::move(terrain);
  return scenario;
}

}  // namespace trackbed
