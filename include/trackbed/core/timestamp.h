#pragma once

#include <optional>
#include <string_view>

namespace trackbed {

/// Returns the time of an ISO 8601 timestamp in seconds since 1970-01-01T00:00:00Z, such as
/// "2024-05-01T12:30:00.25Z", "2024-05-01 12:30:00+02:00" or "2024-05-01T12:30:00". Also accepts
/// the format "01-May-2024 12:30:00" of MATLAB. A timestamp without a time zone is read as UTC.
/// Returns nullopt if the text is no such timestamp. The returned time is accurate to 0.25 us until
/// the year 2100.
std::optional<double> TimestampSeconds(std::string_view text);

/// Returns TimestampSeconds, or the seconds since midnight for a time of day without a date, such
/// as "12:30:00.25".
std::optional<double> TimestampOrTimeOfDay(std::string_view text);

}  // namespace trackbed
