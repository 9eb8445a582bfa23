#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace trackbed {

/// Decompresses a frame of lz4 or zstd to at most `largest` bytes. Throws InputError if the frame
/// is damaged, or if the decompressed data exceed `largest` bytes.
std::string Decompress(std::string_view data, const std::string& compression, std::size_t largest,
                       const std::filesystem::path& file);

}  // namespace trackbed
