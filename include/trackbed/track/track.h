#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/path.h"
#include "trackbed/track/closed_spline.h"

/// A closed race track: a center line with the distances to its edges.
///
/// Symbols: s station along the center line [m], 0 at the start line, growing in the direction of
/// driving; d lateral offset from the center line [m], positive to the left.
namespace trackbed {

/// A point of a track as surveyed.
struct TrackPoint {
  Vec2 position{0.0, 0.0};   ///< on the center line [m]
  double width_right = 0.0;  ///< to the right edge [m], > 0
  double width_left = 0.0;   ///< to the left edge [m], > 0

  bool operator==(const TrackPoint&) const = default;
};

/// Where the edges are at one station.
struct TrackEdges {
  double left = 0.0;   ///< d of the left edge [m]
  double right = 0.0;  ///< d of the right edge [m], below that of the left
};

/// A place in coordinates of a track.
struct TrackPlace {
  double s = 0.0;       ///< of the nearest point of the center line [m]
  double offset = 0.0;  ///< d [m]
};

/// An edge: closed, the last point leads to the first. Points are evenly spaced in station.
using TrackEdgeLine = std::vector<Vec2>;

struct TrackFold;

/// Which way round, and how the center line was smoothed. Immutable value.
///
/// The center line is a closed B-spline of degree 5 fitted to the points (closed_spline.h): bends
/// shorter than the wavelength are smoothed out, because surveyed points, differentiated twice, are
/// mostly noise. `deviation_max` tells how far that moves it. The edges stay where the points have
/// them: widths count from the point, not from the smoothed line.
///
/// Guarantees: curvature and its rate are continuous, also across the start line; the center line
/// closes to 1e-4 of the distance between the points. Does not know heights or friction.
class Track {
 public:
  static constexpr std::size_t kMinPoints = 8;
  static constexpr std::size_t kMaxPoints = 20000;

  /// From points in the order of driving, the first at the start line and not repeated at the end.
  /// `smoothing` is the wavelength [m], > 0; none: four times the mean distance of the points.
  /// PreconditionError for too few or too many points, numbers that are not finite, widths that are
  /// not positive, and neighbors at the same place. Cost: 5 us a point.
  explicit Track(std::vector<TrackPoint> points, std::optional<double> smoothing = {});

  [[nodiscard]] const std::vector<TrackPoint>& points() const { return points_; }
  [[nodiscard]] double smoothing() const { return smoothing_; }          ///< wavelength [m]
  [[nodiscard]] double deviation_max() const { return deviation_max_; }  ///< of a point [m]
  [[nodiscard]] double deviation_rms() const { return deviation_rms_; }  ///< of the points [m]

  /// Of the center line [m].
  [[nodiscard]] double length() const { return length_; }
  /// The center line at any station, which is wrapped; the yaw is that of the first lap.
  [[nodiscard]] PathPoint At(double s) const;
  /// Between the points of the track linear in the station.
  [[nodiscard]] TrackEdges EdgesAt(double s) const;
  /// The station of a point of the track.
  [[nodiscard]] double StationOf(std::size_t point) const { return stations_[point]; }

  /// The place of a point, on the nearest part of the center line; with `near` [m] on the part
  /// within 30 m, or a tenth of the lap where that is less, of that station. The station is within
  /// [0, length). Cost: that of Path::Project over the whole track, or over that part.
  [[nodiscard]] TrackPlace Locate(const Vec2& point, std::optional<double> near = {}) const;

  /// The same of a car, in the frame of the center line; none where there is no frame, as
  /// trackbed::ToFrenet.
  [[nodiscard]] std::optional<FrenetState> ToFrenet(const MotionState& motion) const;

  /// The edges, a point every kEdgeSpacing or less.
  [[nodiscard]] const TrackEdgeLine& left_edge() const { return left_; }
  [[nodiscard]] const TrackEdgeLine& right_edge() const { return right_; }
  static constexpr double kEdgeSpacing = 0.5;  ///< in station [m]

 private:
  friend std::optional<TrackFold> FindFold(const std::vector<TrackPoint>& points,
                                           std::optional<double> smoothing);
  struct CenterLine;
  static CenterLine Smooth(const std::vector<TrackPoint>& points, std::optional<double> smoothing);
  void BuildPath(const CenterLine& line);
  void PlaceEdges(const CenterLine& line);
  [[nodiscard]] TrackPlace LocateWithin(const Vec2& point, double near, double reach) const;
  [[nodiscard]] TrackPlace PlaceOf(const Projection& found) const;

  std::vector<TrackPoint> points_;
  double smoothing_ = 0.0;
  double deviation_max_ = 0.0;
  double deviation_rms_ = 0.0;
  double length_ = 0.0;
  double extra_ = 0.0;  // of path_ before the start line and after a lap [m]
  Path path_;           // the center line, somewhat more than a lap
  std::vector<double> stations_;
  std::vector<TrackEdges> edges_;  // at the points
  TrackEdgeLine left_;
  TrackEdgeLine right_;
};

/// A bend that is tighter than the track is wide: its inner edge would fold over.
struct TrackFold {
  std::size_t point = 0;  ///< of the track, before the bend's tightest place
  double radius = 0.0;    ///< of the center line [m]
  double width = 0.0;     ///< to the inner edge [m]; more than 95 % of the radius, or turn is set
  /// Most that the line may turn within a quarter of the mean distance of the points [rad]; set by
  /// the search before the track is made.
  double turn = 0.0;
};

/// The first fold; none on a track that is fit for use.
std::optional<TrackFold> FindFold(const Track& track);

/// The first clear fold of the track that these points would make: an inner edge beyond the radius,
/// or a line that turns by more than half a circle within a quarter of the mean distance of the
/// points. Such a line, of one wrong number, would take long to make and to follow. Errors as
/// Track. Cost: 5 us a point.
std::optional<TrackFold> FindFold(const std::vector<TrackPoint>& points,
                                  std::optional<double> smoothing);

}  // namespace trackbed
