#include "src/fmu/resources.h"

#include <fmt/format.h>

#include "trackbed/core/hash.h"

namespace trackbed::fmu {

std::string TokenOf(const std::map<std::string, std::string>& resources) {
  std::string sums;
  for (const auto& [name, content] : resources) {
    sums += fmt::format("{} {}\n", name, Sha256(content));
  }
  const std::string sum = Sha256(sums);
  return fmt::format("{{{}-{}-{}-{}-{}}}", sum.substr(0, 8), sum.substr(8, 4), sum.substr(12, 4),
                     sum.substr(16, 4), sum.substr(20, 12));
}

}  // namespace trackbed::fmu
