#pragma once

#include <string>
#include <vector>

namespace trackbed::fmu {

struct ZipEntry {
  std::string name;  ///< Path in the archive, with forward slashes.
  std::string content;
};

/// Returns a ZIP archive with the entries, compressed, and a comment at its end. Archives of equal
/// entries have equal bytes. Throws RunError if there is not enough memory.
std::string MakeZip(const std::vector<ZipEntry>& entries, const std::string& comment);

}  // namespace trackbed::fmu
