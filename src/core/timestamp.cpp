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

}  // namespace

std::optional<double> TimestampSeconds(std::string_view text) {
  Timestamp rest(text);
  const std::optional<int> year = rest.Digits(4);
  const bool has_dashes = rest.Skip("-/") != '\0';
  const std::optional<int> month = rest.Digits(2);
  const bool has_second_dash = rest.Skip("-/") != '\0';
  const std::optional<int> day = rest.Digits(2);
  if (!year || !month || !day || !has_dashes || !has_second_dash || rest.Skip("Tt ") == '\0') {
    return std::nullopt;
  }
  const std::optional<int> hour = rest.Digits(2);
  const bool has_colon = rest.Skip(":") != '\0';
  const std::optional<int> minute = rest.Digits(2);
  if (!hour || !has_colon || !minute || *hour > 24 || *minute > 59) {
    return std::nullopt;
  }
  double second = 0.0;
  if (rest.Skip(":") != '\0') {
    const std::optional<int> whole = rest.Digits(2);
    const std::optional<double> fraction =
        rest.Skip(".,") != '\0' ? rest.Fraction() : std::optional(0.0);
    if (!whole || !fraction || *whole > 60) {
      return std::nullopt;
    }
    second = *whole + *fraction;
  }
  const std::optional<double> zone = Zone(rest);
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!zone || !rest.is_empty() || !date.ok()) {
    return std::nullopt;
  }
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * *hour + 60.0 * *minute + second - *zone;
}

}  // namespace trackbed
