#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/world/world.h"

/// Computes events and tyre forces of a plant from its log.
namespace trackbed {

/// Returns the time intervals in which the steering is at its rate limit, and the times at which
/// the planner detects obstacles. The format of the result is {rate_limit: [[from, to], ...],
/// known: [[obstacle, time], ...]}, with times from the start of the run [s]. Rate limit intervals
/// less than 0.1 s apart are merged; merged intervals shorter than 0.1 s are then omitted.
/// EventsJson omits obstacles that are known from the start or never detected. Throws the errors of
/// ReadCsvExcerpt.
nlohmann::ordered_json EventsJson(const std::filesystem::path& log, const World& world,
                                  const VehicleParams& car);

/// Returns the tyre forces as fractions of the available friction: {t, fl: {along, across}, fr, rl,
/// rr}, with channels as in ChannelJson. The returned forces have up to 30 rows per second and at
/// most `row_limit` rows. If rows of the log are omitted, TyresJson keeps the row with the largest
/// friction use in each time interval. The fractions of friction are positive for tyre forces
/// forward and to the left, and 0 for an unloaded tyre. Returns null for logs without tyre forces.
/// Throws the errors of ReadCsvExcerpt.
nlohmann::ordered_json TyresJson(const std::filesystem::path& log, const std::string& plant,
                                 TyreLaw scenario_law, const World& world, const CarModel& car,
                                 std::size_t row_limit);

}  // namespace trackbed
