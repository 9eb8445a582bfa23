#include "src/scenario/reader_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace trackbed {

void ReaderContext::AddError(const YAML::Mark& mark, const std::string& dotted,
                             std::string message) {
  const bool set = std::any_of(overridden.begin(), overridden.end(), [&](const std::string& key) {
    const char next = dotted.size() > key.size() ? dotted[key.size()] : '.';
    return dotted.starts_with(key) && (next == '.' || next == '[');
  });
  if (set) {
    problems.push_back({"--set", 0, 0, dotted, std::move(message)});
  } else {
    problems.push_back({file, mark.line + 1, mark.column + 1, dotted, std::move(message)});
  }
  unread.push_back(dotted);
}

bool ReaderContext::Read(std::string_view dotted) const {
  return std::none_of(unread.begin(), unread.end(), [&](const std::string& key) {
    const char next = dotted.size() > key.size() ? dotted[key.size()] : '.';
    return (dotted.starts_with(key) && (next == '.' || next == '[')) ||
           key.starts_with(std::string(dotted) + '[');
  });
}

std::string ReaderContext::MethodHint(const std::string& section, const YAML::Node& node,
                                      const std::string& unknown) const {
  if (section == "plan" && (unknown == "avoid" || unknown == "replan")) {
    return fmt::format(
        "; beside plan.{}, the planner has its own section: plan: {{global: "
        "{{method: {}}}, {}: ...}}",
        unknown, node["method"].as<std::string>(""), unknown);
  }
  const std::string key = section + ".method";
  if (std::find(overridden.begin(), overridden.end(), key) == overridden.end()) {
    return "";
  }
  return fmt::format("; --set {} keeps the other keys, --set '{}={{method: {}}}' replaces them",
                     key, section, node["method"].as<std::string>(""));
}

void ReaderContext::SortProblems() {
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
}

void ReaderContext::ThrowProblems() {
  if (!problems.empty()) {
    SortProblems();
    throw InputError(problems);
  }
}

}  // namespace trackbed
