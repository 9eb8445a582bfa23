#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "trackbed/world/world.h"

/// Data of the 3D scene of a run.
namespace trackbed {

/// The vehicle of a run's model.xml, as in ReadVehicleShape: {bodies, geoms, meshes}. Throws the
/// errors of CompileScene.
nlohmann::ordered_json VehicleJson(const std::filesystem::path& model);

/// Motion of a vehicle on a plant, from its state log: {t, channels}, with the channels of its
/// joints that the log contains and the pose of its free joint. At most `row_limit` evenly spaced
/// rows, up to 30 per second, including the last. Angles of spinning wheels are not wrapped. With
/// wind, `wind` is the velocity of the air at the rear axle, {x, y}. Throws the errors of
/// ReadCsvExcerpt, and InputError for a log without rows.
nlohmann::ordered_json MotionJson(const std::filesystem::path& states,
                                  const nlohmann::ordered_json& vehicle, const World& world,
                                  std::size_t row_limit);

/// Indices of at most `row_limit` evenly spaced moments, up to 30 per second, including the first
/// and the last. Empty if `times` is empty.
std::vector<std::size_t> RowsOfMotion(const std::vector<double>& times, std::size_t row_limit);

/// Elevation of uneven ground on a grid around the run: {x, y, step, columns, z}, rows along y.
/// Null for flat ground.
nlohmann::ordered_json GroundJson(const World& world, double low_x, double low_y, double high_x,
                                  double high_y);

/// Numbers as base64: {i2, offset, scale} with int16 if `scale` is below 1e-3 (meter or radian),
/// else {f4} with little-endian float32.
nlohmann::ordered_json ChannelJson(const std::vector<double>& values);

/// Numbers as {f4}.
nlohmann::ordered_json FloatsJson(const std::vector<double>& values);

}  // namespace trackbed
