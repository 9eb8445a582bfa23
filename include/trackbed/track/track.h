#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/path.h"
#include "trackbed/track/closed_spline.h"

/// A closed race track: a center line with the distances to the edges of the track.
///
/// Symbols: s is the station along the center line [m], which is 0 at the start line and grows in
/// the direction of driving. The symbol d is the lateral offset from the center line [m], positive
/// to the left.
namespace trackbed {

/// A surveyed point on the center line of a track.
struct TrackPoint {
  Vec2 position{0.0, 0.0};   ///< Position of the point on the center line [m].
  double width_right = 0.0;  ///< Distance from the point to the right edge [m], > 0.
  double width_left = 0.0;   ///< Distance from the point to the left edge [m], > 0.

  bool operator==(const TrackPoint&) const = default;
};

/// The edges of a track at one station.
struct TrackEdges {
  double left = 0.0;  ///< Lateral offset d of the left edge [m].
  /// Lateral offset d of the right edge [m]; smaller than the offset of the left edge.
  double right = 0.0;
};

/// A place in track coordinates: station and lateral offset.
struct TrackPlace {
  double s = 0.0;       ///< Station of the nearest point of the center line [m].
  double offset = 0.0;  ///< Offset d [m].
};

/// A closed edge line of a track: the last point connects to the first point. The points of an edge
/// line are evenly spaced in the station of the center line.
using TrackEdgeLine = std::vector<Vec2>;

struct TrackFold;

/// A closed race track with a smoothed center line. A Track cannot be changed after construction.
///
/// The center line is a closed B-spline of degree 5 fitted to the points (closed_spline.h). Bends
/// shorter than the wavelength of the smoothing are smoothed out, because the second derivative of
/// surveyed points is mostly noise. The member `deviation_max` is the largest distance by which the
/// smoothing moves a point. The edges are not smoothed: widths are measured from the surveyed
/// points.
///
/// Guarantees: curvature and curvature rate of the center line are continuous, even across the
/// start line. The gap between the end and the start of the center line is at most 1e-4 times the
/// distance between the points. A Track contains no heights and no friction coefficients.
class Track {
 public:
  static constexpr std::size_t kMinPoints = 8;
  static constexpr std::size_t kMaxPoints = 20000;

  /// Makes a track from points in the order of driving. The first point of the track is at the
  /// start line and is not repeated at the end. The argument `smoothing` is the wavelength of the
  /// smoothing [m], > 0; by default, four times the mean distance between neighboring points.
  /// Throws PreconditionError if there are too few or too many points, a number is not finite, a
  /// width is not positive, or two neighboring points coincide. The constructor of Track takes 5 us
  /// per surveyed point.
  explicit Track(std::vector<TrackPoint> points, std::optional<double> smoothing = {});

  [[nodiscard]] const std::vector<TrackPoint>& points() const { return points_; }
  [[nodiscard]] double smoothing() const { return smoothing_; }  ///< Wavelength [m].
  /// Returns the largest distance by which the smoothing moves a point [m].
  [[nodiscard]] double deviation_max() const { return deviation_max_; }
  /// Returns the root mean square of the distances by which the smoothing moves the points [m].
  [[nodiscard]] double deviation_rms() const { return deviation_rms_; }

  /// Returns the length of one lap of the center line [m].
  [[nodiscard]] double length() const { return length_; }
  /// Returns the point of the center line at any station; the station is wrapped to one lap, so the
  /// yaw is the same in every lap.
  [[nodiscard]] PathPoint At(double s) const;
  /// Returns the edges at a station, interpolated linearly between the surveyed points.
  [[nodiscard]] TrackEdges EdgesAt(double s) const;
  /// Returns the station of the surveyed point with index `point`.
  [[nodiscard]] double StationOf(std::size_t point) const { return stations_[point]; }

  /// Returns the track coordinates of a point, relative to the nearest part of the center line. If
  /// `near` [m] is set, Locate searches only at stations within 30 m of `near`, or within a tenth
  /// of the lap if that is less. The station of the returned place is in [0, length). The run time
  /// of Locate is that of Path::Project over the searched part of the center line.
  [[nodiscard]] TrackPlace Locate(const Vec2& point, std::optional<double> near = {}) const;

  /// Returns a car's state in the Frenet frame of the center line, at the nearest part of the
  /// center line whose direction is within pi/2 of the car's heading. Where the track crosses
  /// itself, Locate may choose another part of the center line. Returns nullopt if no part of the
  /// center line has a direction within pi/2 of the heading, or if the frame is undefined, as in
  /// trackbed::ToFrenet. ToFrenet takes 0.2 us per meter of the track.
  [[nodiscard]] std::optional<FrenetState> ToFrenet(const MotionState& motion) const;

  /// Returns the left edge as points whose stations are at most kEdgeSpacing apart.
  [[nodiscard]] const TrackEdgeLine& left_edge() const { return left_; }
  [[nodiscard]] const TrackEdgeLine& right_edge() const { return right_; }
  /// Maximum difference in station between neighboring points of an edge line [m].
  static constexpr double kEdgeSpacing = 0.5;

 private:
  friend std::optional<TrackFold> FindFold(const std::vector<TrackPoint>& points,
                                           std::optional<double> smoothing);
  struct CenterLine;
  static CenterLine Smooth(const std::vector<TrackPoint>& points, std::optional<double> smoothing);
  void BuildPath(const CenterLine& line);
  void PlaceEdges(const CenterLine& line);
  [[nodiscard]] TrackPlace LocateWithin(const Vec2& point, double near, double reach) const;
  [[nodiscard]] TrackPlace PlaceOf(const Projection& found) const;
  /// Returns the stations of path_ between which ToFrenet searches for the point nearest to the
  /// car.
  [[nodiscard]] std::optional<Stations> StretchAlong(const Pose2& pose) const;

  std::vector<TrackPoint> points_;
  double smoothing_ = 0.0;
  double deviation_max_ = 0.0;
  double deviation_rms_ = 0.0;
  double length_ = 0.0;
  // Length by which path_ begins before the start line, and continues after one lap [m].
  double extra_ = 0.0;
  Path path_;  // Center line over slightly more than one lap.
  std::vector<double> stations_;
  std::vector<TrackEdges> edges_;  // Edges of the track at the surveyed points.
  TrackEdgeLine left_;
  TrackEdgeLine right_;
};

/// A fold: a bend of the center line whose radius is so small that the inner edge of the track
/// would cross itself.
struct TrackFold {
  std::size_t point = 0;  ///< Index of the surveyed point before the tightest place of the bend.
  double radius = 0.0;    ///< Radius of the center line at the tightest place of the bend [m].
  /// Distance from the center line to the inner edge at the tightest place of the bend [m]. The
  /// distance `width` from the center line to the inner edge exceeds 95 % of the radius in every
  /// fold for which `turn` is not set.
  double width = 0.0;
  /// Lower bound on the angle by which the center line turns within a quarter of the mean distance
  /// between neighboring points [rad]. Only FindFold(points, smoothing) sets the member `turn`.
  double turn = 0.0;
};

/// Finds the first fold of a track; returns nullopt if the track has no fold.
std::optional<TrackFold> FindFold(const Track& track);

/// Finds the first clear fold in the points of a track, before a Track is made from the points. A
/// fold is clear if the inner edge of the track is beyond the bend's center of curvature. A fold is
/// also clear if the center line turns by more than half a circle within a quarter of the mean
/// distance between neighboring points. A single wrong number in a file can cause a clear fold, and
/// computing a Track from such points would take a long time. FindFold throws the same errors as
/// the constructor of Track. FindFold takes 5 us per point.
std::optional<TrackFold> FindFold(const std::vector<TrackPoint>& points,
                                  std::optional<double> smoothing);

}  // namespace trackbed
