#include "src/analysis/track_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/analysis/peaks.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Computes the distance that the rear axle has travelled along a closed track, which grows over
/// all laps.
class LapCounter {
 public:
  LapCounter(const Track& track, const Pose2& start) : track_(track) {
    // Where the track crosses itself, the car's heading decides on which part of the track the car
    // is.
    const std::optional<FrenetState> along = track.ToFrenet({.pose = start});
    station_ = along ? along->s : track.Locate(start.position()).s;
    if (station_ > 0.5 * track.length()) {
      station_ -= track.length();
    }
  }

  [[nodiscard]] double station() const { return station_; }

  /// Returns the station of the next position of the rear axle, counted over all laps.
  double Advance(const Vec2& position) {
    const double s = track_.Locate(position, station_).s;
    // Add whole laps, so that the new station is as near as possible to the previous station.
    station_ = s + track_.length() * std::round((station_ - s) / track_.length());
    return station_;
  }

 private:
  const Track& track_;
  double station_ = 0.0;
};

/// Returns the distance from a point to the nearest of those segments of a track edge that are near
/// a station [m]. The distance is negative for points outside the track: right of its right edge or
/// left of its left edge.
double DistanceInside(const TrackEdgeLine& edge, double side, const Vec2& point, double share) {
  const auto count = static_cast<std::ptrdiff_t>(edge.size());
  const auto middle = static_cast<std::ptrdiff_t>(share * static_cast<double>(count));
  constexpr double kSearchDistance = 15.0;  // [m]
  const auto reach =
      std::min(static_cast<std::ptrdiff_t>(kSearchDistance / Track::kEdgeSpacing), count / 4);
  double nearest = std::numeric_limits<double>::infinity();
  double inside = 0.0;
  for (std::ptrdiff_t k = middle - reach; k <= middle + reach; ++k) {
    const Vec2& a = edge[static_cast<std::size_t>((k % count + count) % count)];
    const Vec2& b = edge[static_cast<std::size_t>(((k + 1) % count + count) % count)];
    const Vec2 along = b - a;
    const double part =
        std::clamp((point - a).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
    const Vec2 beside = point - a - part * along;
    const double distance = beside.norm();
    // At a corner of a track edge, two segments of the edge may be equally near to the point. Of
    // two equally near edge segments, the segment with the larger perpendicular distance from the
    // point shows on which side of the edge the point lies.
    const double across = side * Cross(along, point - a) / std::max(along.norm(), 1e-6);
    const bool equal = std::abs(distance - nearest) < 1e-9;
    if (equal ? std::abs(across) > std::abs(inside) : distance < nearest) {
      nearest = equal ? nearest : distance;
      inside = across;
    }
  }
  return std::copysign(nearest, inside);
}

/// Smallest distance of the footprints of car and trailer from a track edge (TrackMargin) in one
/// row of the log.
struct Margin {
  double margin = 0.0;  // [m]
  const LogRow* row = nullptr;
};

std::vector<Margin> Margins(const MetricInput& input) {
  const Track& track = *input.plan.laps.track;
  LapCounter counter(track, input.log.rows.front().state.pose);
  std::vector<Margin> margins;
  for (const LogRow& row : input.log.rows) {
    const OrientedBox footprint = FootprintAt(input.vehicle, row.state.pose);
    const double ahead = (footprint.center.position() - row.state.pose.position()).norm();
    const double s = counter.Advance(row.state.pose.position());
    double margin = TrackMargin(track, footprint, s + ahead);
    if (const std::optional<OrientedBox> trailer = TrailerFootprint(input.log, row)) {
      const double behind = (trailer->center.position() - row.state.pose.position()).norm();
      margin = std::min(margin, TrackMargin(track, *trailer, s - behind));
    }
    margins.push_back({margin, &row});
  }
  return margins;
}

/// Sums `span`, a time or a distance, over the control periods at whose beginning the car is off
/// the track.
template <typename Span>
std::optional<MetricReading> SumOffTrack(const MetricInput& input, const Span& span) {
  if (!input.plan.laps.track) {
    return std::nullopt;
  }
  const std::vector<Margin> margins = Margins(input);
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < margins.size(); ++i) {
    if (margins[i].margin < 0.0) {
      sum += span(margins[i].row->state, margins[i + 1].row->state);
    }
  }
  return MetricReading{sum, {}};
}

}  // namespace

std::vector<LapMetrics> MeasureLaps(const RunLog& log, const Plan& plan) {
  std::vector<LapMetrics> laps;
  if (!plan.laps.track) {
    return laps;
  }
  const Track& track = *plan.laps.track;
  const std::vector<LogRow>& rows = log.rows;
  LapCounter counter(track, rows.front().state.pose);
  std::optional<double> begin;
  if (counter.station() > -1e-6) {
    begin = rows.front().state.time;
  }
  // Count at most the planned laps: a car that drives beyond the finish line does not start another
  // lap.
  double next = begin ? track.length() : 0.0;
  double before = counter.station();
  for (std::size_t i = 1; i < rows.size() && laps.size() + 1 < plan.laps.lines.size(); ++i) {
    const double now = counter.Advance(rows[i].state.pose.position());
    if (before < next && now >= next) {
      const double share = (next - before) / (now - before);
      const double time = std::lerp(rows[i - 1].state.time, rows[i].state.time, share);
      if (begin) {
        const SpeedProfile& speed = plan.reference.speed;
        const double from = plan.laps.lines[laps.size()];
        const double to = plan.laps.lines[laps.size() + 1];
        laps.push_back({.time_planned = speed.TimeAt(to) - speed.TimeAt(from),
                        .time = time - *begin,
                        .s = to,
                        .t = time});
      }
      begin = time;
      next += track.length();
    }
    before = now;
  }
  return laps;
}

double TrackMargin(const Track& track, const OrientedBox& footprint, double near) {
  constexpr int kParts = 16;
  const double share = near / track.length() - std::floor(near / track.length());
  double smallest = std::numeric_limits<double>::infinity();
  for (const double side : {-0.5, 0.5}) {
    for (int k = 0; k <= kParts; ++k) {
      const double along = static_cast<double>(k) / kParts - 0.5;
      const Vec2 point =
          ToWorld(footprint.center, {along * footprint.length, side * footprint.width});
      smallest = std::min({smallest, DistanceInside(track.right_edge(), 1.0, point, share),
                           DistanceInside(track.left_edge(), -1.0, point, share)});
    }
  }
  return smallest;
}

std::optional<MetricReading> SmallestTrackMargin(const MetricInput& input) {
  if (!input.plan.laps.track) {
    return std::nullopt;
  }
  const std::vector<Margin> margins = Margins(input);
  const auto smallest =
      std::min_element(margins.begin(), margins.end(),
                       [](const Margin& a, const Margin& b) { return a.margin < b.margin; });
  return MetricReading{smallest->margin,
                       {.span = MetricSpan::kMoment,
                        .s = RowStation(*smallest->row),
                        .t = smallest->row->state.time}};
}

std::optional<MetricReading> PlannedTrackMargin(const MetricInput& input) {
  if (!input.plan.laps.track || input.plan.laps.lines.empty()) {
    return std::nullopt;
  }
  const Track& track = *input.plan.laps.track;
  const Path& path = input.plan.reference.path;
  const double end = std::min(input.plan.laps.lines.back(), path.length());
  LapCounter counter(track, path.At(0.0).pose);
  const double spacing = std::min(Track::kEdgeSpacing, 0.2 * input.vehicle.wheelbase);
  const double parts = std::max(1.0, std::ceil(end / spacing));
  double smallest = std::numeric_limits<double>::infinity();
  for (double k = 0.0; k <= parts; k += 1.0) {
    const Pose2 pose = path.At(end * k / parts).pose;
    const OrientedBox footprint = FootprintAt(input.vehicle, pose);
    const double ahead = (footprint.center.position() - pose.position()).norm();
    smallest =
        std::min(smallest, TrackMargin(track, footprint, counter.Advance(pose.position()) + ahead));
  }
  return MetricReading{smallest, {}};
}

std::optional<MetricReading> TimeOffTrack(const MetricInput& input) {
  return SumOffTrack(input,
                     [](const VehicleState& a, const VehicleState& b) { return b.time - a.time; });
}

std::optional<MetricReading> DistanceOffTrack(const MetricInput& input) {
  return SumOffTrack(
      input, [](const VehicleState& a, const VehicleState& b) { return b.distance - a.distance; });
}

}  // namespace trackbed
