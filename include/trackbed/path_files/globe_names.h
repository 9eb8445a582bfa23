#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Recognizes latitudes and longitudes by the names of their columns.
namespace trackbed {

enum class GlobeAxis { kLatitude, kLongitude };

/// Meaning of a column of latitudes or longitudes.
struct GlobeColumn {
  GlobeAxis axis = GlobeAxis::kLatitude;
  double degrees = 1.0;  ///< Value of one unit of the column [deg].
};

/// Returns the meaning of a column by its name, such as "lat", "latitude_deg", "GPS Longitude",
/// "lng", "position_lat", "latRad" or "lon_e7". Returns nullopt for other column names, among them
/// "lat_acc" and "longitudinal".
std::optional<GlobeColumn> GlobeColumnOf(std::string_view name);

/// Returns whether a column's name contains a word for latitude or longitude, without a unit of
/// length. The numbers in a column of latitudes or longitudes must not be read as meters.
bool NamesGlobeAxis(std::string_view name);

/// Returns whether a column's name is usual for letters of hemispheres, such as "N/S" or "lat_dir".
bool NamesHemisphere(std::string_view name);

/// Returns the columns of latitude and longitude in a header. If several columns of latitude or of
/// longitude fit, returns the column with the shortest name.
struct GlobeColumns {
  std::optional<std::size_t> latitude;
  std::optional<std::size_t> longitude;
  GlobeColumn latitude_meaning{};
  GlobeColumn longitude_meaning{};
};
GlobeColumns FindGlobeColumns(const std::vector<std::string>& names);

/// Explains why a text is not a number, with the number to write instead. The text may have a
/// decimal comma ("48,137"), degrees with minutes and seconds ("48°08'14.3\"N") or a letter for the
/// hemisphere ("48.137N"). For other texts, returns "'...' is not a finite number".
std::string NumberProblem(const std::string& text);

}  // namespace trackbed
