#include "trackbed/scenario/metric_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "trackbed/core/spelling.h"

namespace trackbed {

std::vector<std::pair<std::string, std::string>> UnknownMetrics(
    const Expectations& expect, const std::vector<std::string>& possible) {
  // Names of metrics that an error message may suggest; for metrics in lists, only those of the
  // first list element.
  std::vector<std::string> shown;
  std::copy_if(possible.begin(), possible.end(), std::back_inserter(shown),
               [](const std::string& path) {
                 const std::size_t bracket = path.find('[');
                 return bracket == std::string::npos || path[bracket + 1] == '0';
               });
  std::vector<std::pair<std::string, std::string>> found;
  const auto look = [&](const std::string& key, const PlantExpectation& own) {
    for (std::size_t i = 0; i < own.metrics.size(); ++i) {
      const std::string& metric = own.metrics[i].metric;
      if (std::find(possible.begin(), possible.end(), metric) == possible.end()) {
        found.emplace_back(fmt::format("{}.metrics[{}].metric", key, i),
                           "unknown metric " + UnknownName(metric, shown));
      }
    }
  };
  look("expect", expect.all);
  for (const auto& [plant, own] : expect.plants) {
    look("expect." + plant, own);
  }
  return found;
}

}  // namespace trackbed
