#include "trackbed/scenario/study.h"

#include <fmt/format.h>

#include "src/scenario/study_settings.h"
#include "trackbed/core/text_table.h"
#include "trackbed/optimize/search.h"

namespace trackbed {

const std::vector<std::string>& StudySearches() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const SampleMethod method :
         {SampleMethod::kRandom, SampleMethod::kLatinHypercube, SampleMethod::kSobol}) {
      all.emplace_back(ToString(method));
    }
    all.emplace_back("surrogate");
    for (const SearchEntry& entry : Searches()) {
      // Leave out SLSQP, which needs gradients: finite differences between runs are too inaccurate
      // for gradients.
      if (entry.method != SearchMethod::kSlsqp) {
        all.emplace_back(entry.name);
      }
    }
    return all;
  }();
  return names;
}

std::string ToString(const KeepSpec& keep) {
  switch (keep.rows) {
    case KeepSpec::Rows::kNone:
      break;
    case KeepSpec::Rows::kFailed:
      return "failed";
    case KeepSpec::Rows::kAll:
      return "all";
    case KeepSpec::Rows::kHighest:
      return fmt::format("worst {} by {}", keep.count, keep.by);
    case KeepSpec::Rows::kLowest:
      return fmt::format("lowest {} by {}", keep.count, keep.by);
  }
  return "none";
}

std::string CellText(const std::string& value) {
  const std::optional<double> number = NumberOf(value);
  return number ? ShortestText(*number) : value;
}

}  // namespace trackbed
