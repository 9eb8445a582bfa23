#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "trackbed/world/world.h"

/// Data of the 3D scene of a run.
namespace trackbed {

/// The vehicle of a run's model.xml, as in ReadVehicleShape: {bodies, geoms, meshes}. VehicleJson
/// throws the errors of CompileScene.
nlohmann::ordered_json VehicleJson(const std::filesystem::path& model);

/// Motion of a vehicle on a plant, from the plant's state log: {t, channels}. The channels of the
/// motion are those of the joints that the log contains, and the pose of the free joint. The motion
/// has at most `row_limit` evenly spaced rows, up to 30 per second, including the last row. Angles
/// of spinning wheels are not wrapped to one turn. With wind, `wind` is the velocity of the air at
/// the rear axle, {x, y}. MotionJson throws the errors of ReadCsvExcerpt. MotionJson throws
/// InputError for a log without rows.
nlohmann::ordered_json MotionJson(const std::filesystem::path& states,
                                  const nlohmann::ordered_json& vehicle, const World& world,
                                  std::size_t row_limit);

/// Indices of at most `row_limit` evenly spaced moments, up to 30 per second, including the first
/// and the last. RowsOfMotion is empty if `times` is empty.
std::vector<std::size_t> RowsOfMotion(const std::vector<double>& times, std::size_t row_limit);

/// Elevation of uneven ground on a grid around the run: {x, y, step, columns, z}, with rows along
/// y. GroundJson is null for flat ground.
nlohmann::ordered_json GroundJson(const World& world, double low_x, double low_y, double high_x,
                                  double high_y);

/// Numbers as base64. If `scale` is below 1e-3 (meter or radian), the format is {i2, offset, scale}
/// with int16. For a larger `scale`, the format is {f4} with little-endian float32.
nlohmann::ordered_json ChannelJson(const std::vector<double>& values);

/// Numbers as base64 in the format {f4}.
nlohmann::ordered_json FloatsJson(const std::vector<double>& values);

}  // namespace trackbed
