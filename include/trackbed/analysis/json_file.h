#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

/// Reads the JSON files of a run folder, as Trackbed writes them.
namespace trackbed {

/// The JSON in a file. InputError with file, line and column where it is not JSON, and when it is
/// nested deeper than 64 levels; RunError as ReadFile, or of more than 16 MiB.
nlohmann::ordered_json ParseJson(const std::filesystem::path& file);

/// Calls `visit` with the JSON in `file`.
///
/// Errors: InputError naming the file when it is missing from its run folder
/// (run_folder::RequireFile), as ParseJson, and when it is not as `visit` takes it to be, which may
/// throw nlohmann::json::exception. For the last, `problem` may name a key, and have a message
/// instead of that of the JSON library. Other exceptions of `visit` pass through.
void VisitJson(const std::filesystem::path& file,
               const std::function<void(const nlohmann::ordered_json&)>& visit,
               Problem problem = {});

/// VisitJson with a `read` that returns something: returns that.
template <typename Read>
auto ReadJson(const std::filesystem::path& file, const Read& read, Problem problem = {}) {
  std::optional<std::invoke_result_t<const Read&, const nlohmann::ordered_json&>> value;
  VisitJson(
      file, [&](const nlohmann::ordered_json& json) { value.emplace(read(json)); },
      std::move(problem));
  return *std::move(value);
}

/// The cones of the gates in plan.json; none without gates. For use within VisitJson, as it throws
/// nlohmann::json::exception.
std::vector<Vec2> GateCones(const nlohmann::ordered_json& plan);

}  // namespace trackbed
