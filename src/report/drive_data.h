#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/world/world.h"

/// Events and tyre forces of a plant, computed from its log.
namespace trackbed {

/// Intervals with the steering at its rate limit, and times at which planners detected obstacles.
/// The format is {rate_limit: [[from, to], ...], known: [[obstacle, time], ...]}, with times from
/// the start of the run [s]. Intervals last at least 0.1 s. Intervals less than 0.1 s apart are
/// merged. The list of detected obstacles omits those that are known from the start and those that
/// are never detected. EventsJson throws the errors of ReadCsvExcerpt.
nlohmann::ordered_json EventsJson(const std::filesystem::path& log, const World& world,
                                  const VehicleParams& car);

/// Tyre forces as fractions of the available friction: {t, fl: {along, across}, fr, rl, rr}, with
/// channels as in ChannelJson. The tyre forces have up to 30 rows per second and at most
/// `row_limit` rows. Fractions are positive forward and to the left, and 0 for an unloaded tyre. Of
/// the rows between two shown rows, the row with the largest use of friction is taken. TyresJson
/// returns null for logs without tyre forces. TyresJson throws the errors of ReadCsvExcerpt.
nlohmann::ordered_json TyresJson(const std::filesystem::path& log, const std::string& plant,
                                 TyreLaw scenario_law, const World& world, const CarModel& car,
                                 std::size_t row_limit);

}  // namespace trackbed
