#pragma once

#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// Checks untrusted model files before MuJoCo reads these files.
namespace trackbed {

/// Maximum size of an asset file [bytes].
inline constexpr std::size_t kMaxAssetBytes = std::size_t{64} << 20;
/// Maximum number of asset files; the limit stays below the 2000 files that fit into the virtual
/// file system of MuJoCo 2.2.2.
inline constexpr std::size_t kMaxAssets = 1900;
/// Maximum total size of all asset files [bytes].
inline constexpr std::size_t kMaxTotalAssetBytes = std::size_t{512} << 20;

/// Checks the content of an asset file whose kind is `kind`, such as "mesh" or "texture". Returns
/// the error as a phrase that follows the file name, such as "is no PNG picture"; empty if the
/// content is valid.
std::string AssetError(std::string_view kind, const std::filesystem::path& file,
                       std::string_view content);

/// Checks an XML element of the composed model. Returns the error in the XML element as a sentence;
/// empty if the element is valid.
std::string ElementError(const tinyxml2::XMLElement& element);

}  // namespace trackbed
