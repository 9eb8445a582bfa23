#include "trackbed/analysis/metric_value.h"

#include <nlohmann/json.hpp>
#include <type_traits>

#include "trackbed/core/text_table.h"

namespace trackbed {

nlohmann::ordered_json ToJson(const MetricValue& value) {
  return std::visit(
      [](const auto& own) -> nlohmann::ordered_json {
        if constexpr (std::is_same_v<std::decay_t<decltype(own)>, std::monostate>) {
          return nullptr;
        } else {
          return own;
        }
      },
      value);
}

std::string ToText(const MetricValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    return ShortestText(*number);
  }
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : ToJson(value).dump();
}

}  // namespace trackbed
