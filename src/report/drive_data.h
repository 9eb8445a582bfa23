#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/world/world.h"

/// What a plant's log tells beyond its curves: events, and the forces of tyres.
namespace trackbed {

/// When the steering was at its rate limit, and when planners learned of obstacles: {rate_limit:
/// [[from, to], ...], known: [[obstacle, time], ...]}, times from the start of the run [s]. A
/// period at the limit lasts 0.1 s at least; two less than 0.1 s apart are one. Obstacles that are
/// known from the start are left out, and those that are never learned of. InputError as
/// ReadCsvExcerpt.
nlohmann::ordered_json EventsJson(const std::filesystem::path& log, const World& world,
                                  const VehicleParams& car);

/// The forces of the tyres as shares of what friction allows each, at up to 30 rows a second and at
/// most `row_limit` in all: {t, fl: {along, across}, fr, rl, rr}, channels as ChannelJson has them.
/// A share is positive forward and to the left; both are 0 of a tyre without load. Of the rows
/// between two that are shown the one is taken where the tyres use most. Null for logs without
/// tyre forces. InputError as ReadCsvExcerpt.
nlohmann::ordered_json TyresJson(const std::filesystem::path& log, const std::string& plant,
                                 TyreLaw scenario_law, const World& world, const CarModel& car,
                                 std::size_t row_limit);

}  // namespace trackbed
