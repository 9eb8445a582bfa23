#pragma once

#include <string>
#include <vector>

namespace trackbed::fmu {

struct ZipEntry {
  std::string name;  ///< Path in the archive, with forward slashes.
  std::string content;
};

/// Returns a compressed ZIP archive of the entries, with a comment at the end of the archive.
/// Archives of equal entries have equal bytes. Throws RunError if there is not enough memory.
std::string MakeZip(const std::vector<ZipEntry>& entries, const std::string& comment);

}  // namespace trackbed::fmu
