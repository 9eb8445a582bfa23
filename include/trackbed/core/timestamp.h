#pragma once

#include <optional>
#include <string_view>

namespace trackbed {

/// Returns the time of an ISO 8601 timestamp in seconds since 1970-01-01T00:00:00Z, such as
/// "2024-05-01T12:30:00.25Z", "2024-05-01 12:30:00+02:00" or "2024-05-01T12:30:00". A timestamp
/// without a time zone is read as UTC. Returns nullopt if the text is not a valid ISO 8601
/// timestamp. The returned time is accurate to 0.25 us until the year 2100.
std::optional<double> TimestampSeconds(std::string_view text);

}  // namespace trackbed
