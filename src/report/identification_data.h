#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace trackbed {

/// Whether the folder contains the result of an identification.
bool IsIdentificationFolder(const std::filesystem::path& folder);

/// Returns the data of an identification for its report page. The data contain the content of
/// identify.json. For each record, the data also contain the curves of the record, of the model
/// before the fit and of the model after the fit. Throws InputError naming a missing or invalid
/// file.
nlohmann::ordered_json IdentificationData(const std::filesystem::path& folder);

}  // namespace trackbed
