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

/// A surveyed point of a track.
struct TrackPoint {
  Vec2 position{0.0, 0.0};   ///< Position on the center line [m].
  double width_right = 0.0;  ///< Distance to the right edge [m], > 0.
  double width_left = 0.0;   ///< Distance to the left edge [m], > 0.

  bool operator==(const TrackPoint&) const = default;
};

/// The edges at one station.
struct TrackEdges {
  double left = 0.0;   ///< Offset d of the left edge [m].
  double right = 0.0;  ///< Offset d of the right edge [m], below that of the left edge.
};

/// A place in track coordinates.
struct TrackPlace {
  double s = 0.0;       ///< Station of the nearest point of the center line [m].
  double offset = 0.0;  ///< Offset d [m].
};

/// A closed edge: the last point connects to the first. Points are evenly spaced in station.
using TrackEdgeLine = std::vector<Vec2>;

struct TrackFold;

/// The course of a track, with a smoothed center line. Immutable.
///
/// The center line is a closed B-spline of degree 5 fitted to the points (closed_spline.h): bends
/// shorter than the wavelength are smoothed out, because the second derivative of surveyed points
/// is mostly noise. `deviation_max` is the largest displacement of a point by the smoothing. The
/// edges are not smoothed: widths are measured from the surveyed points.
///
/// Guarantees: curvature and its rate are continuous, also across the start line; the gap between
/// the end and the start of the center line is at most 1e-4 of the distance between the points. A
/// track has no heights and no friction.
class Track {
 public:
  static constexpr std::size_t kMinPoints = 8;
  static constexpr std::size_t kMaxPoints = 20000;

  /// Makes a track from points in the order of driving. The first point is at the start line and is
  /// not repeated at the end. `smoothing` is the wavelength [m], > 0; by default four times the
  /// mean distance of the points. PreconditionError for too few or too many points, numbers that
  /// are not finite, widths that are not positive, and coinciding neighbors. Cost: 5 us per point.
  explicit Track(std::vector<TrackPoint> points, std::optional<double> smoothing = {});

  [[nodiscard]] const std::vector<TrackPoint>& points() const { return points_; }
  [[nodiscard]] double smoothing() const { return smoothing_; }  ///< Wavelength [m].
  /// Largest displacement of a point by the smoothing [m].
  [[nodiscard]] double deviation_max() const { return deviation_max_; }
  /// Root mean square displacement of the points by the smoothing [m].
  [[nodiscard]] double deviation_rms() const { return deviation_rms_; }

  /// Length of the center line [m].
  [[nodiscard]] double length() const { return length_; }
  /// The center line at any station, which is wrapped. The yaw is the same in every lap.
  [[nodiscard]] PathPoint At(double s) const;
  /// The edges at a station, linear between the points of the track.
  [[nodiscard]] TrackEdges EdgesAt(double s) const;
  /// The station of a point of the track.
  [[nodiscard]] double StationOf(std::size_t point) const { return stations_[point]; }

  /// Returns the track coordinates of a point, relative to the nearest part of the center line.
  /// With `near` [m], searches only within 30 m of that station, or a tenth of the lap if that is
  /// less. The station is within [0, length). Cost: that of Path::Project over the searched part.
  [[nodiscard]] TrackPlace Locate(const Vec2& point, std::optional<double> near = {}) const;

  /// Returns a car's state in the Frenet frame of the center line; nullopt if the frame is
  /// undefined, as in trackbed::ToFrenet.
  [[nodiscard]] std::optional<FrenetState> ToFrenet(const MotionState& motion) const;

  /// The edges, with points at most kEdgeSpacing apart.
  [[nodiscard]] const TrackEdgeLine& left_edge() const { return left_; }
  [[nodiscard]] const TrackEdgeLine& right_edge() const { return right_; }
  static constexpr double kEdgeSpacing = 0.5;  ///< Largest distance of points in station [m].

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
  double extra_ = 0.0;  // Length of path_ before the start line, and after a lap [m].
  Path path_;           // Center line, slightly more than a lap.
  std::vector<double> stations_;
  std::vector<TrackEdges> edges_;  // Edges at the surveyed points.
  TrackEdgeLine left_;
  TrackEdgeLine right_;
};

/// A bend that is tighter than the track is wide: its inner edge would fold over.
struct TrackFold {
  std::size_t point = 0;  ///< Point of the track before the tightest place of the bend.
  double radius = 0.0;    ///< Radius of the center line [m].
  /// Distance from the center line to the inner edge [m]. The distance exceeds 95 % of the radius
  /// unless `turn` is set.
  double width = 0.0;
  /// Lower bound on the angle by which the center line turns within a quarter of the mean distance
  /// of the points [rad]. Set only by the FindFold that searches points.
  double turn = 0.0;
};

/// Finds the first fold; nullopt for a usable track.
std::optional<TrackFold> FindFold(const Track& track);

/// Finds the first clear fold of a track before the track is made from its points. In a clear fold,
/// the inner edge is beyond the center of curvature, or the center line turns by more than half a
/// circle within a quarter of the mean distance of the points. One wrong number in a file can cause
/// such a fold, and the track would take a long time to compute. Throws the errors of Track. Cost:
/// 5 us per point.
std::optional<TrackFold> FindFold(const std::vector<TrackPoint>& points,
                                  std::optional<double> smoothing);

}  // namespace trackbed
