#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "trackbed/world/world.h"

/// What a page draws a run from in three dimensions.
namespace trackbed {

/// The vehicle of a run's model.xml, as ReadVehicleShape has it: {bodies, geoms, meshes}.
/// InputError as CompileScene.
nlohmann::ordered_json VehicleJson(const std::filesystem::path& model);

/// The motion of a vehicle on a plant, from its state log: {t, channels}, with the channels that
/// its joints name, those that the log has, and the pose of its free joint. At most `row_limit`
/// evenly chosen rows and no more than 30 per second, the last one among them. Angles of spinning
/// wheels are not wrapped. Where there is wind, `wind` has the velocity of the air at the rear
/// axle, {x, y}. InputError as ReadCsvExcerpt, and for a log without rows.
nlohmann::ordered_json MotionJson(const std::filesystem::path& states,
                                  const nlohmann::ordered_json& vehicle, const World& world,
                                  std::size_t row_limit);

/// Indices of at most `row_limit` evenly chosen moments, no more than 30 per second, with the first
/// and the last one. None of none.
std::vector<std::size_t> RowsOfMotion(const std::vector<double>& times, std::size_t row_limit);

/// Heights of ground that is not flat on a grid over the area where the run was: {x, y, step,
/// columns, z}, rows along y. Null of flat ground.
nlohmann::ordered_json GroundJson(const World& world, double low_x, double low_y, double high_x,
                                  double high_y);

/// Numbers as base64: {f4}, little-endian float32, or {i2, offset, scale}, int16, where steps of
/// the scale are finer than a thousandth, of a meter or a radian.
nlohmann::ordered_json ChannelJson(const std::vector<double>& values);

/// {f4} of them.
nlohmann::ordered_json FloatsJson(const std::vector<double>& values);

}  // namespace trackbed
