#include "trackbed/path_files/globe_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/text_table.h"

// Recognizes columns of latitudes and longitudes by the words of their names, and explains texts of
// coordinates that are not decimal numbers.
namespace trackbed {
namespace {

using Words = std::vector<std::string>;

bool IsAny(std::string_view word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::optional<GlobeAxis> AxisWord(std::string_view word) {
  if (IsAny(word, {"lat", "lats", "latitude", "latitudes"})) {
    return GlobeAxis::kLatitude;
  }
  if (IsAny(word, {"lon", "lons", "lng", "long", "longitude", "longitudes"})) {
    return GlobeAxis::kLongitude;
  }
  return std::nullopt;
}

/// Returns the value of one unit in degrees; 0 if the word is no unit of angles.
double AngleUnit(std::string_view word) {
  if (IsAny(word, {"deg", "degs", "degree", "degrees", "dd", "decimal", "\xC2\xB0"})) {
    return 1.0;
  }
  if (IsAny(word, {"rad", "radian", "radians"})) {
    return 180.0 / 3.14159265358979323846;
  }
  return word == "e7" ? 1e-7 : word == "e6" ? 1e-6 : 0.0;
}

bool IsLengthUnit(std::string_view word) {
  return IsAny(word, {"m", "meter", "meters", "metre", "metres", "cm", "mm", "km"});
}

/// Returns whether a word of a column's name says only where a position comes from, such as "gps"
/// or "raw".
bool IsSourceWord(std::string_view word) {
  return IsAny(word, {"gps",   "gnss",     "ins",      "rtk",        "pos",        "position",
                      "loc",   "location", "nav",      "fix",        "navsatfix",  "wgs",
                      "wgs84", "geo",      "geodetic", "coord",      "coordinate", "coordinates",
                      "field", "data",     "msg",      "message",    "vehicle",    "ego",
                      "car",   "point",    "value",    "navigation", "kalman",     "raw"}) ||
         std::all_of(word.begin(), word.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Splits a name into words in lower case at characters that are neither letters nor digits, and
/// before a capital letter that follows a small letter. In a run of capitals before a small letter,
/// the name is split before the last capital ("GPSLat" becomes gps, lat).
Words WordsOf(std::string_view name) {
  Words words(1);
  const auto at = [&](std::size_t i) {
    return i < name.size() ? static_cast<unsigned char>(name[i]) : static_cast<unsigned char>(0);
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const unsigned char c = at(i);
    if (std::isalnum(c) == 0 && c < 0x80) {
      words.emplace_back();
      continue;
    }
    const bool begins = std::isupper(c) != 0 && i > 0 &&
                        (std::islower(at(i - 1)) != 0 ||
                         (std::isupper(at(i - 1)) != 0 && std::islower(at(i + 1)) != 0));
    if (begins) {
      words.emplace_back();
    }
    words.back().push_back(static_cast<char>(std::tolower(c)));
  }
  std::erase(words, "");
  // Divide words that are written together, such as "gpslat" and "londeg".
  Words divided;
  for (std::string word : words) {
    for (const std::string_view prefix : {"gps", "gnss", "pos"}) {
      if (word.starts_with(prefix) && AxisWord(std::string_view(word).substr(prefix.size()))) {
        word.erase(0, prefix.size());
        break;
      }
    }
    for (const std::string_view suffix : {"deg", "rad", "dd", "e7"}) {
      if (word.ends_with(suffix) &&
          AxisWord(std::string_view(word).substr(0, word.size() - suffix.size()))) {
        word.erase(word.size() - suffix.size());
        divided.emplace_back(suffix);
        break;
      }
    }
    divided.push_back(std::move(word));
  }
  return divided;
}

/// Numbers, and a letter for the hemisphere, in a text of degrees, minutes and seconds.
struct Sexagesimal {
  std::vector<double> numbers;
  char hemisphere = '\0';
  bool has_marks = false;
};

/// Divides a text such as 48°08'14.3"N into numbers; nullopt if the text has other words.
std::optional<Sexagesimal> Divide(const std::string& text) {
  Sexagesimal found;
  std::string number;
  const auto finish = [&] {
    if (!number.empty()) {
      const std::optional<double> value = CellNumber(number);
      found.numbers.push_back(value.value_or(std::nan("")));
      number.clear();
    }
  };
  for (const char c : text) {
    const char upper = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if ((c >= '0' && c <= '9') || c == '.' || (c == '-' && number.empty())) {
      number.push_back(c);
      continue;
    }
    finish();
    if (IsAny(std::string_view(&upper, 1), {"N", "S", "E", "W"}) && found.hemisphere == '\0') {
      found.hemisphere = upper;
    } else if (static_cast<unsigned char>(c) >= 0x80 || c == '\'' || c == '"' || c == ':') {
      found.has_marks = true;
    } else if (c != ' ') {
      return std::nullopt;
    }
  }
  finish();
  const bool is_valid = !found.numbers.empty() && found.numbers.size() <= 3 &&
                        std::all_of(found.numbers.begin(), found.numbers.end(),
                                    [](double value) { return std::isfinite(value); });
  return is_valid ? std::optional(found) : std::nullopt;
}

double Degrees(const Sexagesimal& text) {
  double degrees = 0.0;
  double unit = 1.0;
  for (const double number : text.numbers) {
    degrees += unit * std::abs(number);
    unit /= 60.0;
  }
  const bool is_negative =
      std::signbit(text.numbers.front()) || text.hemisphere == 'S' || text.hemisphere == 'W';
  return is_negative ? -degrees : degrees;
}

}  // namespace

std::optional<GlobeColumn> GlobeColumnOf(std::string_view name) {
  std::optional<GlobeColumn> found;
  double unit = 1.0;
  for (const std::string& word : WordsOf(name)) {
    const std::optional<GlobeAxis> axis = AxisWord(word);
    if (axis && !found) {
      found = GlobeColumn{.axis = *axis};
    } else if (const double own = AngleUnit(word); own > 0.0) {
      unit = own;
    } else if (axis || !IsSourceWord(word)) {
      return std::nullopt;
    }
  }
  if (found) {
    found->degrees = unit;
  }
  return found;
}

bool NamesGlobeAxis(std::string_view name) {
  const Words words = WordsOf(name);
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return AxisWord(word).has_value(); }) &&
         std::none_of(words.begin(), words.end(),
                      [](const std::string& word) { return IsLengthUnit(word); });
}

bool NamesHemisphere(std::string_view name) {
  const Words words = WordsOf(name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return AxisWord(word).has_value() ||
           IsAny(word, {"n", "s", "e", "w", "ns", "ew", "hemisphere", "ref"});
  });
}

GlobeColumns FindGlobeColumns(const std::vector<std::string>& names) {
  GlobeColumns found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<GlobeColumn> column = GlobeColumnOf(names[i]);
    if (!column) {
      continue;
    }
    const bool is_latitude = column->axis == GlobeAxis::kLatitude;
    std::optional<std::size_t>& index = is_latitude ? found.latitude : found.longitude;
    if (!index || names[i].size() < names[*index].size()) {
      index = i;
      (is_latitude ? found.latitude_meaning : found.longitude_meaning) = *column;
    }
  }
  return found;
}

std::string NumberProblem(const std::string& text) {
  const std::string shown = text.substr(0, 40);
  if (std::count(text.begin(), text.end(), ',') == 1) {
    std::string pointed = text;
    pointed[pointed.find(',')] = '.';
    if (CellNumber(pointed)) {
      return fmt::format("'{}' has a decimal comma; write {}", shown, pointed);
    }
  }
  if (text.size() <= 40) {
    const std::optional<Sexagesimal> parts = Divide(text);
    if (parts && (parts->numbers.size() > 1 || parts->has_marks || parts->hemisphere != '\0')) {
      return fmt::format("'{}' is not in decimal degrees; write {:.9g}", shown, Degrees(*parts));
    }
  }
  return fmt::format("'{}' is not a finite number", shown);
}

}  // namespace trackbed
