#include "src/scenario/study_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include "trackbed/core/text_table.h"

namespace trackbed {

std::string OverrideKey(const Override& override_text) {
  return override_text.substr(0, override_text.find('='));
}

Setting SettingOf(const Variation& variation, std::string value) {
  return {variation.key, std::move(value), variation.line, variation.column};
}

bool Replaces(const std::string& later, const std::string& earlier) {
  const char next = earlier.size() > later.size() ? earlier[later.size()] : '.';
  return earlier.starts_with(later) && (next == '.' || next == '[');
}

std::vector<Setting> AllSettings(const Study& study, const std::vector<Setting>& point,
                                 std::optional<double> bisected) {
  std::vector<Setting> all;
  std::copy_if(
      study.set.begin(), study.set.end(), std::back_inserter(all), [&](const Setting& setting) {
        return std::none_of(
            study.overrides.begin(), study.overrides.end(),
            [&](const Override& text) { return Replaces(OverrideKey(text), setting.key); });
      });
  all.insert(all.end(), point.begin(), point.end());
  if (bisected) {
    const BisectSpec& bisect = *study.bisect;
    all.push_back({bisect.key, ShortestText(*bisected), bisect.line, bisect.column});
  }
  return all;
}

std::vector<Setting> Varied(const Study& study) {
  std::vector<Setting> varied;
  for (const Variation& variation : study.vary) {
    varied.push_back(SettingOf(variation, ""));
  }
  for (const auto& point : study.list) {
    varied.insert(varied.end(), point.begin(), point.end());
  }
  for (const DerivedKey& derived : study.derive) {
    varied.push_back({derived.key, "", derived.line, derived.column});
  }
  if (study.bisect) {
    const BisectSpec& bisect = *study.bisect;
    varied.push_back({bisect.key, "", bisect.line, bisect.column});
  }
  return varied;
}

std::optional<double> NumberOf(const std::string& value) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc{} && end == value.data() + value.size() ? std::optional(number)
                                                                    : std::nullopt;
}

}  // namespace trackbed
