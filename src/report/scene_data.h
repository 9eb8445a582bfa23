#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "trackbed/world/world.h"

/// Computes the data of the 3D scene of a run.
namespace trackbed {

/// Returns the shape of the vehicle from a run's model.xml, as read by ReadVehicleShape: {bodies,
/// geoms, meshes}. VehicleJson throws the errors of CompileScene.
nlohmann::ordered_json VehicleJson(const std::filesystem::path& model);

/// Returns the motion of a vehicle from the state log of its plant, as {t, channels}. The channels
/// of the motion are the coordinates of the logged joints, and the pose of the free joint. The
/// motion has at most `row_limit` evenly spaced rows, up to 30 per second, and includes the last
/// row. The rotation angles of spinning wheels are not wrapped to one turn. If the world has wind,
/// the field `wind` of the result is the air velocity at the rear axle, {x, y}. Throws the errors
/// of ReadCsvExcerpt, and InputError for a log without rows.
nlohmann::ordered_json MotionJson(const std::filesystem::path& states,
                                  const nlohmann::ordered_json& vehicle, const World& world,
                                  std::size_t row_limit);

/// Returns the indices of at most `row_limit` evenly spaced times, up to 30 per second, including
/// the first and the last. RowsOfMotion returns an empty list if `times` is empty.
std::vector<std::size_t> RowsOfMotion(const std::vector<double>& times, std::size_t row_limit);

/// Returns the elevation of uneven ground on a grid around the run, as {x, y, step, columns, z};
/// null for flat ground. The rows of the elevation grid follow each other along y.
nlohmann::ordered_json GroundJson(const World& world, double low_x, double low_y, double high_x,
                                  double high_y);

/// Encodes numbers as base64. If int16 resolves the range of the numbers to 1e-3 or finer (meters
/// or radians), the format is {i2, offset, scale} with int16. If the range is too large for int16,
/// the format is {f4} with float32. The bytes of int16 and float32 are little-endian.
nlohmann::ordered_json ChannelJson(const std::vector<double>& values);

/// Encodes numbers as base64 in the format {f4}, which contains float32.
nlohmann::ordered_json FloatsJson(const std::vector<double>& values);

}  // namespace trackbed
