#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// Checks untrusted model files before MuJoCo reads them.
namespace trackbed {

/// Largest size of an asset file [bytes].
inline constexpr std::size_t kMaxAssetBytes = std::size_t{64} << 20;
/// Largest number of asset files; below 2000, the number of files that fit into the virtual file
/// system of MuJoCo 2.2.2.
inline constexpr std::size_t kMaxAssets = 1900;
/// Largest size of all asset files together [bytes].
inline constexpr std::size_t kMaxTotalAssetBytes = std::size_t{512} << 20;

/// Checks the content of an asset file of this kind ("mesh", "texture", …). Returns the error as
/// the end of a sentence, such as "is no PNG picture"; empty if the content is valid.
std::string AssetError(std::string_view kind, const std::filesystem::path& file,
                       std::string_view content);

/// Checks an element of the composed model. Returns the error as a sentence; empty if the element
/// is valid.
std::string ElementError(const tinyxml2::XMLElement& element);

}  // namespace trackbed
