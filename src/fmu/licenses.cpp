#include "src/fmu/licenses.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>

#include "trackbed/core/file.h"

// Takes the texts of libraries of a wheel from the folder beside the library of FMUs. Finds the
// owners of all other libraries in the lists of files that dpkg keeps, one list for each package.
namespace trackbed::fmu {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFolder = "documentation/licenses/";

/// Returns the names under which a list of dpkg may contain the file. Debian packages older than
/// the merge of /lib into /usr/lib list their files in /lib.
std::set<std::string> ListedNames(const fs::path& file) {
  std::error_code failed;
  const fs::path real = fs::canonical(file, failed);
  std::string name = failed ? file.string() : real.string();
  std::set<std::string> names{name};
  constexpr std::string_view kUsr = "/usr";
  if (name.starts_with("/usr/lib")) {
    names.insert(name.substr(kUsr.size()));
  }
  return names;
}

/// Returns the Debian packages that own the library files, keyed by the sonames of the files.
/// Owners() omits files that no package owns.
std::map<std::string, std::string> Owners(const std::map<std::string, fs::path>& carried,
                                          const fs::path& root) {
  std::map<std::string, std::string> soname_of;
  for (const auto& [soname, file] : carried) {
    for (const std::string& name : ListedNames(file)) {
      soname_of[name] = soname;
    }
  }
  std::map<std::string, std::string> owners;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(root / "var/lib/dpkg/info", ignored)) {
    if (entry.path().extension() != ".list") {
      continue;
    }
    std::ifstream list(entry.path());
    for (std::string line; std::getline(list, line);) {
      if (const auto found = soname_of.find(line); found != soname_of.end()) {
        // A file such as "libzip4:amd64.list" lists the files of the package libzip4.
        const std::string package = entry.path().stem().string();
        owners[found->second] = package.substr(0, package.find(':'));
      }
    }
  }
  return owners;
}

/// Returns the files in `folder` and its subfolders, keyed by their names relative to `folder`.
std::map<std::string, std::string> FilesIn(const fs::path& folder) {
  std::map<std::string, std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file(ignored)) {
      files[fs::relative(entry.path(), folder).generic_string()] = ReadFile(entry.path());
    }
  }
  return files;
}

}  // namespace

std::vector<ZipEntry> LicenseEntries(const fs::path& library,
                                     const std::map<std::string, fs::path>& carried,
                                     const fs::path& root) {
  std::map<std::string, std::string> texts = FilesIn(library.parent_path() / "fmu_licenses");
  const std::map<std::string, std::string> of_wheel =
      FilesIn(library.parent_path() / "library_licenses");
  std::string index =
      "This FMU contains Trackbed (LICENSE, NOTICE), code that is compiled into it\n"
      "(the other texts beside this file), and these libraries:\n\n";
  const std::map<std::string, std::string> owners = Owners(carried, root);
  // Find the license of MuJoCo, which MuJoCo's wheel and archive contain.
  const bool has_mujoco = texts.lower_bound("mujoco/") != texts.lower_bound("mujoco0");
  for (const auto& [soname, file] : carried) {
    std::string where = "no text found; add its license before you distribute this FMU";
    if (const auto carried_text = of_wheel.find(soname + ".txt"); carried_text != of_wheel.end()) {
      where = carried_text->first;
      texts.insert(*carried_text);
    } else if (const auto owner = owners.find(soname); owner != owners.end()) {
      const fs::path text = root / "usr/share/doc" / owner->second / "copyright";
      std::error_code ignored;
      if (fs::is_regular_file(text, ignored)) {
        where = owner->second + ".txt";
        texts[where] = ReadFile(text);
      }
    } else if (has_mujoco && soname.starts_with("libmujoco.so")) {
      where = "mujoco/";
    }
    index += fmt::format("{}: {}\n", soname, where);
  }
  std::vector<ZipEntry> entries{{std::string(kFolder) + "license.txt", index}};
  for (auto& [name, text] : texts) {
    entries.push_back({kFolder + name, std::move(text)});
  }
  return entries;
}

}  // namespace trackbed::fmu
