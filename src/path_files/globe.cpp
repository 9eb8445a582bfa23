#include "trackbed/path_files/globe.h"

#include <fmt/format.h>
#include <proj.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"

// Projects latitude and longitude to meters with PROJ. The projection is a transverse Mercator
// projection about the origin of the path. On a road of some kilometers, the projection's scale
// error is far below the accuracy of a GNSS receiver. A UTM zone would make every length 0.04 % too
// short.
namespace trackbed {
namespace {

using Context = std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)>;
using Transformation = std::unique_ptr<PJ, PJ* (*)(PJ*)>;

/// Largest distance of a point east or west of the origin [m]. At 300 km from the origin, the scale
/// error of the projection is about 1/1000.
constexpr double kMaxEasting = 3e5;
constexpr double kMaxNorthing = 5e6;  // largest distance north or south of the origin [m]

Transformation Create(PJ_CONTEXT* context, const std::string& definition) {
  Transformation created(proj_create(context, definition.c_str()), proj_destroy);
  TRACKBED_CHECK(created != nullptr, "PROJ does not know {}", definition);
  return created;
}

Vec2 Forward(PJ* transformation, const GlobePosition& at) {
  const PJ_COORD found = proj_trans(
      transformation, PJ_FWD, proj_coord(proj_torad(at.longitude), proj_torad(at.latitude), 0, 0));
  return {found.xy.x, found.xy.y};
}

/// Returns the UTM zone of a position, with the exceptions for Norway and Svalbard.
int UtmZone(const GlobePosition& at) {
  const double longitude = std::remainder(at.longitude, 360.0);
  if (at.latitude >= 56.0 && at.latitude < 64.0 && longitude >= 3.0 && longitude < 12.0) {
    return 32;
  }
  if (at.latitude >= 72.0 && at.latitude < 84.0 && longitude >= 0.0 && longitude < 42.0) {
    return longitude < 9.0 ? 31 : longitude < 21.0 ? 33 : longitude < 33.0 ? 35 : 37;
  }
  return std::clamp(static_cast<int>(std::floor((longitude + 180.0) / 6.0)) + 1, 1, 60);
}

/// Converts degrees and minutes of NMEA 0183, 4807.038 for 48 degrees 7.038 minutes, to degrees.
double FromNmea(double number) {
  const double whole = std::trunc(number / 100.0);
  return whole + (number - 100.0 * whole) / 60.0;
}

bool MayBeNmea(const GlobePosition& at) {
  const auto fits = [](double number, double largest) {
    return std::abs(number) < 100.0 * largest + 60.0 && std::abs(std::fmod(number, 100.0)) < 60.0;
  };
  return fits(at.latitude, 90.0) && fits(at.longitude, 180.0);
}

}  // namespace

std::string GlobeProblem(const GlobePosition& at) {
  const double latitude = std::abs(at.latitude);
  const double longitude = std::abs(at.longitude);
  if (latitude <= kMaxLatitude && longitude <= kMaxLongitude) {
    return "";
  }
  if (latitude <= 90.0 && longitude <= kMaxLongitude) {
    return fmt::format("latitude {} is too close to a pole; must be between {} and {} degrees",
                       at.latitude, -kMaxLatitude, kMaxLatitude);
  }
  std::string text = fmt::format(
      "latitude {} and longitude {} do not exist; latitudes must be between {} and {}, longitudes "
      "between {} and {} degrees",
      at.latitude, at.longitude, -kMaxLatitude, kMaxLatitude, -kMaxLongitude, kMaxLongitude);
  if (latitude <= 180.0 && longitude <= kMaxLatitude) {
    return text + fmt::format(": latitude and longitude are swapped (latitude {}, longitude {})",
                              at.longitude, at.latitude);
  }
  if (MayBeNmea(at)) {
    return text + fmt::format(
                      ": these look like degrees and minutes as in NMEA 0183 (ddmm.mmmm); write "
                      "decimal degrees, latitude {:.8g}, longitude {:.8g}",
                      FromNmea(at.latitude), FromNmea(at.longitude));
  }
  if (latitude >= 1e6 && latitude <= 9e8 && longitude <= 1.8e9 &&
      std::trunc(at.latitude) == at.latitude && std::trunc(at.longitude) == at.longitude) {
    return text + fmt::format(
                      ": these look like 1e-7 degrees; end the names of the columns with _e7, or "
                      "write latitude {:.9g}, longitude {:.9g}",
                      1e-7 * at.latitude, 1e-7 * at.longitude);
  }
  return text + ": if these are meters, name the columns x_m and y_m";
}

std::vector<std::size_t> PositionsWithoutFix(const std::vector<GlobePosition>& positions) {
  // The real positions of a drive are within 300 km, less than 3 degrees at the equator.
  constexpr double kNear = 3.0;
  const auto is_zero = [](const GlobePosition& at) {
    return at.latitude == 0.0 && at.longitude == 0.0;
  };
  const auto real = std::find_if_not(positions.begin(), positions.end(), is_zero);
  std::vector<std::size_t> without;
  if (real == positions.end() || (std::abs(real->latitude) < kNear &&
                                  std::abs(std::remainder(real->longitude, 360.0)) < kNear)) {
    return without;
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (is_zero(positions[i])) {
      without.push_back(i);
    }
  }
  return without;
}

std::string NoFixNote(std::size_t count, const std::string& first) {
  return fmt::format(
      "{} {} skipped that have latitude 0 and longitude 0, as receivers write without a fix, the "
      "first {}",
      count, count == 1 ? "position" : "positions", first);
}

struct LocalPlane::Projection {
  Context context{proj_context_create(), proj_context_destroy};
  Transformation mercator{nullptr, proj_destroy};
};

LocalPlane::LocalPlane(const GlobePosition& origin)
    : origin_(origin), projection_(std::make_unique<Projection>()) {
  projection_->mercator =
      Create(projection_->context.get(),
             fmt::format("+proj=tmerc +lat_0={:.12f} +lon_0={:.12f} +k=1 +ellps=WGS84 +units=m",
                         origin.latitude, std::remainder(origin.longitude, 360.0)));
}
LocalPlane::LocalPlane(LocalPlane&&) noexcept = default;
LocalPlane& LocalPlane::operator=(LocalPlane&&) noexcept = default;
LocalPlane::~LocalPlane() = default;

std::optional<Vec2> LocalPlane::ToMeters(const GlobePosition& at) const {
  const Vec2 point =
      Forward(projection_->mercator.get(), {at.latitude, std::remainder(at.longitude, 360.0)});
  if (!point.allFinite() || std::abs(point.x()) > kMaxEasting ||
      std::abs(point.y()) > kMaxNorthing) {
    return std::nullopt;
  }
  return point;
}

std::string LocalPlane::Note(double max_easting) const {
  // The geometric mean of the ellipsoid's radii of curvature is at least 6356 km.
  constexpr double kLeastRadius = 6.356e6;
  const double error = 0.5 * (max_easting / kLeastRadius) * (max_easting / kLeastRadius);
  std::string utm;
  if (origin_.latitude >= -80.0 && origin_.latitude <= 84.0) {
    const int zone = UtmZone(origin_);
    const bool south = origin_.latitude < 0.0;
    const Transformation transformation =
        Create(projection_->context.get(),
               fmt::format("+proj=utm +zone={}{} +ellps=WGS84", zone, south ? " +south" : ""));
    const Vec2 point =
        Forward(transformation.get(), {origin_.latitude, std::remainder(origin_.longitude, 360.0)});
    utm = fmt::format("; in UTM zone {}{} (EPSG:{}), the origin is at {:.3f} E, {:.3f} N", zone,
                      south ? "S" : "N", (south ? 32700 : 32600) + zone, point.x(), point.y());
  }
  return fmt::format(
      "WGS 84 by transverse Mercator about latitude {:.9g}, longitude {:.9g}, x east, y north, "
      "scale error at most {:.2g}{}",
      origin_.latitude, origin_.longitude, error, utm);
}

GlobePoints ProjectGlobe(const std::vector<GlobePosition>& positions,
                         const std::optional<GlobePosition>& origin) {
  TRACKBED_REQUIRE(!positions.empty(), "ProjectGlobe: no positions");
  const LocalPlane plane(origin.value_or(positions.front()));
  GlobePoints found;
  double max_easting = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::optional<Vec2> point = plane.ToMeters(positions[i]);
    if (!point) {
      found.points.clear();
      found.bad = i;
      found.problem = fmt::format(
          "latitude {}, longitude {} is too far from the origin of the projection, latitude {}, "
          "longitude {}; must be within {:.0f} km east or west and {:.0f} km north or south",
          positions[i].latitude, positions[i].longitude, plane.origin().latitude,
          plane.origin().longitude, 1e-3 * kMaxEasting, 1e-3 * kMaxNorthing);
      return found;
    }
    max_easting = std::max(max_easting, std::abs(point->x()));
    found.points.push_back(*point);
  }
  found.note = plane.Note(max_easting);
  return found;
}

}  // namespace trackbed
