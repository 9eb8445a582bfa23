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

namespace trackbed {
namespace {

constexpr const char* kPrefix = "bank[";
// Largest number of parameters of a study, because QuadraticProgram supports no more variables.
constexpr std::size_t kMostParameters = 40;

/// Returns the index of the sample that ends the first lap of a drive: the sample nearest to the
/// sample `first` when the car has returned from afar and heads in the same direction. Returns
/// nullopt if the car does not return.
std::optional<std::size_t> EndOfLap(const std::vector<RecordedSample>& samples, std::size_t first) {
  const Pose2 start = samples[first].pose;
  const auto away = [&](std::size_t i) {
    return (samples[i].pose.position() - start.position()).norm();
  };
  double farthest = 0.0;
  for (std::size_t i = first; i < samples.size(); ++i) {
    farthest = std::max(farthest, away(i));
  }
  // Fractions of the largest distance: the car has left, is back, and has passed the start.
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

/// Returns evenly spaced points on the first lap of a drive. The gap between the end and the start
/// of the lap is distributed over the lap.
std::vector<Vec2> FirstLap(const Scenario& scenario, const Identification& study) {
  const std::vector<RecordedSample>& samples = scenario.record->data->samples;
  const auto moves = [&](const RecordedSample& sample) {
    return sample.valid && std::abs(sample.velocity_V.x()) >= scenario.record->min_speed;
  };
  const auto first = static_cast<std::size_t>(std::find_if(samples.begin(), samples.end(), moves) -
                                              samples.begin());
  const std::optional<std::size_t> last =
      first < samples.size() ? EndOfLap(samples, first) : std::nullopt;
  if (!last) {
    throw InputError(Problem{
        .file = study.file.string(),
        .key = "bank.track",
        .message = fmt::format("missing, and the record of {} does not return to its start; name "
                               "the file of the closed track that was driven on",
                               scenario.name)});
  }
  std::vector<double> driven{0.0};
  for (std::size_t i = first + 1; i <= *last; ++i) {
    driven.push_back(driven.back() +
                     (samples[i].pose.position() - samples[i - 1].pose.position()).norm());
  }
  constexpr double kSpacing = 2.0;  // [m]
  const double lap = driven.back();
  const auto count = static_cast<std::size_t>(std::clamp(std::ceil(lap / kSpacing), 40.0, 1000.0));
  const Vec2 gap = samples[*last].pose.position() - samples[first].pose.position();
  std::vector<Vec2> points;
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count);
    while (i + 2 < driven.size() && driven[i + 1] <= part * lap) {
      ++i;
    }
    const double step = driven[i + 1] - driven[i];
    const double share = step > 0.0 ? (part * lap - driven[i]) / step : 0.0;
    const Vec2 from = samples[first + i].pose.position();
    points.push_back(from + share * (samples[first + i + 1].pose.position() - from) - part * gap);
  }
  return points;
}

/// Returns the track points of the first lap, with edges that all records stay within.
std::vector<TrackPoint> TrackOfRecords(const Identification& study) {
  const Scenario& first = study.fit_scenarios.front();
  std::vector<TrackPoint> points;
  for (const Vec2& point : FirstLap(first, study)) {
    points.push_back({point, 1.0, 1.0});
  }
  const Track line(points);
  double left = 0.0;
  double right = 0.0;
  for (const auto* scenarios : {&study.fit_scenarios, &study.held_out_scenarios}) {
    for (const Scenario& scenario : *scenarios) {
      constexpr double kSpacing = 1.0;  // between the samples that are compared with the track [m]
      std::optional<Vec2> before;
      for (const RecordedSample& sample : scenario.record->data->samples) {
        const Vec2 at = sample.pose.position();
        if (!sample.valid || (before && (at - *before).norm() < kSpacing)) {
          continue;
        }
        before = at;
        const double offset = line.Locate(at).offset;
        left = std::max(left, offset);
        right = std::max(right, -offset);
      }
    }
  }
  const double half = 0.5 * LoadCar(first).params().width;
  double widest = std::numeric_limits<double>::infinity();
  constexpr double kFold = 0.9;  // of the radius, to which the ground reaches
  for (double s = 0.0; s < line.length(); s += line.length() / 400.0) {
    widest = std::min(widest, kFold / std::max(std::abs(line.At(s).curvature), 1e-9));
  }
  for (TrackPoint& point : points) {
    point.width_left = std::min(left + half, widest);
    point.width_right = std::min(right + half, widest);
  }
  return points;
}

/// Returns the number of knots. The study must have room for as many parameters.
std::size_t KnotsOf(const Identification& study, double length) {
  const std::size_t room = kMostParameters - std::min(kMostParameters, study.parameters.size());
  const auto least = ClosedSplineBasis::kMinFunctions;
  const auto knots = static_cast<std::size_t>(
      std::lround(std::min(1e6, length / study.bank->spacing.value_or(length / 8.0))));
  if (std::max(knots, least) > room) {
    const std::string remedy =
        room < least
            ? fmt::format("remove {} parameters", least - room)
            : fmt::format("set it to {:.4g} m or more", length / static_cast<double>(room) + 0.05);
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

std::vector<TrackPoint> PointsOf(const Identification& study) {
  TRACKBED_CHECK(study.bank && !study.fit_scenarios.empty(), "a study {}", "without bank");
  return study.bank->points.empty() ? TrackOfRecords(study) : study.bank->points;
}

}  // namespace

bool IsBankParameter(const std::string& name) {
  return name.starts_with(kPrefix);
}

BankModel::BankModel(const Identification& study)
    : options_(*study.bank),
      ground_(PointsOf(study)),
      basis_(ground_.track().length(), KnotsOf(study, ground_.track().length())) {}

std::vector<IdentifiedParameter> BankModel::Parameters() const {
  std::vector<IdentifiedParameter> parameters;
  for (std::size_t i = 0; i < basis_.count(); ++i) {
    parameters.push_back({.name = fmt::format("{}{}]", kPrefix, i),
                          .from = -options_.largest,
                          .to = options_.largest,
                          .start = 0.0,
                          .prior = ParameterPrior{.mean = 0.0, .deviation = options_.deviation}});
  }
  return parameters;
}

BankedTrack BankModel::At(std::span<const double> parameters) const {
  TRACKBED_CHECK(parameters.size() == basis_.count(), "{} values for {} knots", parameters.size(),
                 basis_.count());
  const Eigen::MatrixXd coefficients = Eigen::Map<const Eigen::VectorXd>(
      parameters.data(), static_cast<Eigen::Index>(parameters.size()));
  const Track& track = ground_.track();
  BankedTrack banked{.points = track.points(), .banks = {}, .heights = {}};
  for (std::size_t i = 0; i < banked.points.size(); ++i) {
    banked.banks.push_back(Evaluate(basis_.At(track.StationOf(i), 0), coefficients, 0)[0]);
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
