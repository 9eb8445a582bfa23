#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Whether the folder contains an identification.
bool IsIdentificationFolder(const std::filesystem::path& folder);

/// Data of an identification for the page: the content of identify.json, and each record over time
/// with the model before and after the fit. IdentificationData throws InputError naming a missing
/// or invalid file.
nlohmann::ordered_json IdentificationData(const std::filesystem::path& folder);

}  // namespace trackbed
