#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/geometry/pose.h"

/// Positions on the globe: latitude and longitude of GPS logs and maps, and their projection to
/// meters with PROJ.
namespace trackbed {

/// Geodetic position in WGS 84 [deg]: latitude positive to the north, longitude positive to the
/// east.
struct GlobePosition {
  double latitude = 0.0;
  double longitude = 0.0;
};

/// Largest magnitude of a latitude that can be projected [deg]. Closer to a pole than this
/// latitude, the direction to the north changes too fast along a path.
inline constexpr double kMaxLatitude = 89.0;
/// Largest magnitude of a longitude [deg]; some receivers count from 0 to 360 degrees.
inline constexpr double kMaxLongitude = 360.0;

/// Returns why no car can be at the position, and the remedy; "" if the position is valid. The
/// returned text names three likely mistakes: swapped coordinates, degrees and minutes of NMEA
/// 0183, and numbers in 1e-7 degrees.
std::string GlobeProblem(const GlobePosition& position);

/// Returns the indices of the positions at which a receiver had no fix, so that latitude and
/// longitude are exactly 0. If the other positions are near latitude 0 and longitude 0, a position
/// at exactly 0 may be real, so the returned list is empty.
std::vector<std::size_t> PositionsWithoutFix(const std::vector<GlobePosition>& positions);

/// Returns the note about skipped positions without a fix.
std::string NoFixNote(std::size_t count, const std::string& first);

/// A transverse Mercator projection of the ellipsoid WGS 84, with the scale 1 on the meridian of
/// its origin. The x axis points to the east and the y axis to the north at the origin.
///
/// Scale: lengths at the distance x east or west of the origin are too long by the factor 1 +
/// x^2/(2 R^2) with the earth's radius R. The projection's relative error of a length is 1.2e-8 at
/// x = 1 km east or west of the origin, 1.2e-6 at 10 km, and 1.2e-4 at 100 km. In a UTM zone,
/// lengths are too short by 4e-4 on the zone's meridian. Heights are ignored: a road at the height
/// h is longer than its projection by the fraction h/R, which is 1.6e-4 for h = 1 km.
class LocalPlane {
 public:
  explicit LocalPlane(const GlobePosition& origin);
  LocalPlane(LocalPlane&&) noexcept;
  LocalPlane& operator=(LocalPlane&&) noexcept;
  ~LocalPlane();

  /// Projects a valid position [m]; returns nullopt if the position is more than 300 km east or
  /// west or 5000 km north or south of the origin. Longitudes that differ by 360 degrees are equal.
  /// Cost: 1 us.
  [[nodiscard]] std::optional<Vec2> ToMeters(const GlobePosition& position) const;
  [[nodiscard]] const GlobePosition& origin() const { return origin_; }

  /// States the projection, its origin, the origin's coordinates in its UTM zone and the largest
  /// scale error at the eastings up to `max_easting` [m].
  [[nodiscard]] std::string Note(double max_easting) const;

 private:
  struct Projection;
  GlobePosition origin_;
  std::unique_ptr<Projection> projection_;
};

/// Positions in meters, and how they were projected.
struct GlobePoints {
  std::vector<Vec2> points;  ///< Projected positions [m]; empty if there is a `problem`.
  std::string note;
  std::size_t bad = 0;  ///< Index of the position that cannot be projected.
  std::string problem;  ///< Reason why the position `bad` cannot be projected; else empty.
};

/// Projects valid positions to a plane about `origin`, by default the first position.
GlobePoints ProjectGlobe(const std::vector<GlobePosition>& positions,
                         const std::optional<GlobePosition>& origin);

}  // namespace trackbed
