#include "src/core/vbo.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string.hpp>
#include <cmath>

#include "src/core/csv_number.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/text_table.h"

// A VBO file has sections that begin with lines such as [header]. Each line of the section [header]
// describes a column in words. The section [column names] contains the short names of all columns
// in one line. FindVboHead finds no table in a VBO file without [column names], because the
// descriptions in [header] contain blanks.
namespace trackbed {
namespace {

constexpr double kDay = 86400.0;

std::string Lower(std::string_view text) {
  std::string lower(text);
  boost::trim(lower);
  boost::to_lower(lower);
  return lower;
}

/// Returns the name of a VBO column without leading underscores, which mark the data of a second
/// receiver.
std::string Plain(const std::string& name) {
  return boost::trim_left_copy_if(Lower(name), boost::is_any_of("_"));
}

bool IsLatitude(const std::string& name) {
  return name == "lat" || name == "latitude";
}
bool IsLongitude(const std::string& name) {
  return name == "long" || name == "lon" || name == "longitude";
}

std::vector<std::string> Words(std::string_view line) {
  std::vector<std::string> words;
  std::string trimmed(line);
  boost::trim(trimmed);
  boost::split(words, trimmed, boost::is_any_of(" \t"), boost::token_compress_on);
  return words;
}

/// Returns the unit at the end of a column description such as "velocity kmh"; "" if the
/// description has no unit.
std::string UnitAtEnd(const std::string& description) {
  constexpr std::array kUnits{"kmh", "km/h", "mph", "knots", "m/s", "g", "deg/s", "rpm"};
  const std::vector<std::string> words = Words(description);
  const std::string last = boost::to_lower_copy(words.back());
  return words.size() > 1 && std::find(kUnits.begin(), kUnits.end(), last) != kUnits.end() ? last
                                                                                           : "";
}

std::string UnitOf(const std::string& name, const std::string& description) {
  const std::string plain = Plain(name);
  if (plain == "time") {
    return "s";
  }
  if (IsLatitude(plain) || IsLongitude(plain) || plain == "heading") {
    return "deg";
  }
  const std::string unit = UnitAtEnd(description);
  return unit.empty() && plain == "velocity" ? "kmh"
         : unit.empty() && plain == "height" ? "m"
                                             : unit;
}

}  // namespace

std::optional<CsvHead> FindVboHead(std::string_view begin) {
  std::vector<std::string> descriptions;
  std::vector<std::string> names;
  CsvHead head{.delimiter = kBlanks, .is_vbo = true};
  std::string section;
  for (int line = 1;; ++line) {
    const std::size_t end = begin.find('\n');
    if (end == std::string_view::npos) {
      return std::nullopt;
    }
    const std::string text = boost::trim_copy(std::string(begin.substr(0, end)));
    begin.remove_prefix(end + 1);
    if (text.starts_with('[') && text.ends_with(']')) {
      section = Lower(text);
      if (section == "[data]") {
        head.first_row = line + 1;
        break;
      }
    } else if (section == "[header]" && !text.empty()) {
      descriptions.push_back(text);
    } else if (section == "[column names]" && names.empty() && !text.empty()) {
      head.preamble_lines = line - 1;
      names = Words(text);
    }
  }
  if (names.empty()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool has_descriptions = descriptions.size() == names.size();
    head.units.push_back(UnitOf(names[i], has_descriptions ? descriptions[i] : ""));
  }
  return head;
}

VboCells::VboCells(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::string plain = Plain(name.substr(0, name.find(" [")));
    kinds_.push_back(plain == "time"      ? Kind::kTime
                     : IsLatitude(plain)  ? Kind::kLatitude
                     : IsLongitude(plain) ? Kind::kLongitude
                                          : Kind::kPlain);
  }
}

std::string VboCells::Convert(std::vector<std::string>& cells) {
  constexpr double kMinutes = 60.0;
  std::string problem;
  for (std::size_t i = 0; i < std::min(cells.size(), kinds_.size()); ++i) {
    NormalizeNumber(cells[i], true);
    const std::optional<double> number = CellNumber(cells[i]);
    if (!number || kinds_[i] == Kind::kPlain) {
      continue;
    }
    if (kinds_[i] != Kind::kTime) {
      const double sign = kinds_[i] == Kind::kLongitude ? -1.0 : 1.0;
      cells[i] = ShortestText(sign * *number / kMinutes);
      continue;
    }
    const double hours = std::floor(*number / 1e4);
    const double minutes = std::floor(*number / 100.0) - 100.0 * hours;
    const double seconds = *number - 100.0 * std::floor(*number / 100.0);
    if (!(hours >= 0.0 && hours < 24.0 && minutes < kMinutes && seconds < 61.0)) {
      problem = fmt::format("'{}' is no time of day hhmmss", cells[i]);
      continue;
    }
    const double time = 3600.0 * hours + kMinutes * minutes + seconds;
    days_ += last_ && *last_ - time > 0.5 * kDay ? kDay : 0.0;
    last_ = time;
    // Times in VBO files have up to three decimals (hhmmss.sss); round away further digits, which
    // are rounding errors.
    cells[i] = fmt::format("{:.6f}", time + days_);
  }
  return problem;
}

}  // namespace trackbed
