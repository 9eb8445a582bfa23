#include "trackbed/core/timestamp.h"

#include <charconv>
#include <chrono>
#include <cstddef>

namespace trackbed {
namespace {

/// Reads the parts of a timestamp from left to right.
class Timestamp {
 public:
  explicit Timestamp(std::string_view text) : rest_(text) {}

  /// Reads an integer of exactly `digits` digits.
  std::optional<int> Digits(std::size_t digits) {
    if (rest_.size() < digits) {
      return std::nullopt;
    }
    int number = 0;
    for (const char c : rest_.substr(0, digits)) {
      if (c < '0' || c > '9') {
        return std::nullopt;
      }
      number = 10 * number + (c - '0');
    }
    rest_.remove_prefix(digits);
    return number;
  }

  /// Skips the next character if it is one of the given characters. Skip() returns the skipped
  /// character, or 0 if no character was skipped.
  char Skip(std::string_view characters) {
    if (rest_.empty() || characters.find(rest_.front()) == std::string_view::npos) {
      return '\0';
    }
    const char skipped = rest_.front();
    rest_.remove_prefix(1);
    return skipped;
  }

  /// Reads the digits after a decimal point as a fraction from 0 to 1.
  std::optional<double> Fraction() {
    std::size_t count = 0;
    double fraction = 0.0;
    double unit = 0.1;
    while (count < rest_.size() && rest_[count] >= '0' && rest_[count] <= '9') {
      fraction += unit * (rest_[count] - '0');
      unit *= 0.1;
      ++count;
    }
    rest_.remove_prefix(count);
    return count == 0 ? std::nullopt : std::optional(fraction);
  }

  /// Reads the English abbreviation of a month, as in 01-May-2024, as a number from 1 to 12.
  std::optional<int> Month() {
    constexpr std::string_view kMonths = "JanFebMarAprMayJunJulAugSepOctNovDec";
    const std::size_t at = rest_.size() < 3 ? kMonths.npos : kMonths.find(rest_.substr(0, 3));
    if (at == kMonths.npos || at % 3 != 0) {
      return std::nullopt;
    }
    rest_.remove_prefix(3);
    return static_cast<int>(at / 3) + 1;
  }

  [[nodiscard]] bool is_empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

/// Reads the time zone at the end of a timestamp as seconds east of UTC.
std::optional<double> Zone(Timestamp& text) {
  text.Skip(" ");
  if (text.is_empty() || text.Skip("Zz") != '\0') {
    return 0.0;
  }
  const char sign = text.Skip("+-");
  const std::optional<int> hours = sign == '\0' ? std::nullopt : text.Digits(2);
  if (!hours) {
    return std::nullopt;
  }
  text.Skip(":");
  const int minutes = text.is_empty() ? 0 : text.Digits(2).value_or(60);
  if (*hours > 23 || minutes > 59) {
    return std::nullopt;
  }
  return (sign == '-' ? -1.0 : 1.0) * (3600.0 * *hours + 60.0 * minutes);
}

/// Reads a time of day as seconds since midnight. `digits` is the number of digits of the hour.
std::optional<double> TimeOfDay(Timestamp& text, std::size_t digits, bool needs_seconds) {
  const std::optional<int> hour = text.Digits(digits);
  const bool has_colon = text.Skip(":") != '\0';
  const std::optional<int> minute = text.Digits(2);
  if (!hour || !has_colon || !minute || *hour > 24 || *minute > 59) {
    return std::nullopt;
  }
  double second = 0.0;
  if (text.Skip(":") != '\0') {
    const std::optional<int> whole = text.Digits(2);
    const std::optional<double> fraction =
        text.Skip(".,") != '\0' ? text.Fraction() : std::optional(0.0);
    if (!whole || !fraction || *whole > 60) {
      return std::nullopt;
    }
    second = *whole + *fraction;
  } else if (needs_seconds) {
    return std::nullopt;
  }
  return 3600.0 * *hour + 60.0 * *minute + second;
}

/// Reads a date such as 2024-05-01, 2024/05/01 or 01-May-2024.
std::optional<std::chrono::year_month_day> Date(Timestamp& text, bool begins_with_day) {
  std::optional<int> year = begins_with_day ? std::nullopt : text.Digits(4);
  std::optional<int> day = begins_with_day ? text.Digits(2) : std::nullopt;
  const bool has_dash = text.Skip("-/") != '\0';
  const std::optional<int> month = begins_with_day ? text.Month() : text.Digits(2);
  const bool has_second_dash = text.Skip("-/") != '\0';
  (begins_with_day ? year : day) = text.Digits(begins_with_day ? 4 : 2);
  if (!year || !month || !day || !has_dash || !has_second_dash || text.Skip("Tt ") == '\0') {
    return std::nullopt;
  }
  return std::chrono::year_month_day{std::chrono::year(*year),
                                     std::chrono::month(static_cast<unsigned>(*month)),
                                     std::chrono::day(static_cast<unsigned>(*day))};
}

}  // namespace

std::optional<double> TimestampSeconds(std::string_view text) {
  Timestamp rest(text);
  const std::optional<std::chrono::year_month_day> date = Date(rest, text.find('-') == 2);
  const std::optional<double> time = date ? TimeOfDay(rest, 2, false) : std::nullopt;
  const std::optional<double> zone = time ? Zone(rest) : std::nullopt;
  if (!zone || !rest.is_empty() || !date->ok()) {
    return std::nullopt;
  }
  const auto days = std::chrono::sys_days(*date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + *time - *zone;
}

std::optional<double> TimestampOrTimeOfDay(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon != 1 && colon != 2) {
    return TimestampSeconds(text);
  }
  Timestamp rest(text);
  const std::optional<double> time = TimeOfDay(rest, colon, true);
  return rest.is_empty() ? time : std::nullopt;
}

}  // namespace trackbed
