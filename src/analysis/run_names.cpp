#include "trackbed/analysis/run_names.h"

#include <algorithm>

namespace trackbed {

namespace fs = std::filesystem;

std::vector<std::string> ShortRunNames(const std::vector<fs::path>& folders) {
  std::vector<fs::path> real;
  std::vector<fs::path> rest;
  std::vector<fs::path> names;
  for (const fs::path& folder : folders) {
    const fs::path path = fs::weakly_canonical(folder);
    real.push_back(path.has_filename() ? path : path.parent_path());
    names.push_back(real.back().filename());
    rest.push_back(real.back().parent_path());
  }
  const auto is_ambiguous = [&](std::size_t i) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (names[i] == names[j] && real[i] != real[j]) {
        return true;
      }
    }
    return false;
  };
  const auto any_ambiguous = [&] {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (is_ambiguous(i)) {
        return true;
      }
    }
    return false;
  };
  while (any_ambiguous()) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      names[i] = rest[i].filename() / names[i];
      rest[i] = rest[i].parent_path();
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace trackbed
