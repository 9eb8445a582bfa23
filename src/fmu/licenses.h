#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "src/fmu/zip_archive.h"

namespace trackbed::fmu {

/// Returns the files of the folder `documentation/licenses` of an FMU. The files are the license
/// texts of Trackbed, of the code compiled into `library`, and of the libraries in `carried`, a map
/// from soname to file. The license texts for the compiled code are in the folder fmu_licenses
/// beside `library`. `license.txt` lists all carried libraries with their license texts.
///
/// A wheel has the license text of each carried library in library_licenses/SONAME.txt beside
/// `library`. Elsewhere, the license text of a carried library is the copyright file of the Debian
/// package that owns it, found in the database of dpkg below `root`. For a library without a text,
/// license.txt says so.
std::vector<ZipEntry> LicenseEntries(const std::filesystem::path& library,
                                     const std::map<std::string, std::filesystem::path>& carried,
                                     const std::filesystem::path& root = "/");

}  // namespace trackbed::fmu
