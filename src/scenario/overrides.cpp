#include "src/scenario/overrides.h"

#include <charconv>

#include "src/scenario/yaml_file.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

[[noreturn]] void Fail(const std::string& text, std::string message) {
  throw InputError(Problem{"--set", 0, 0, text, std::move(message)});
}

/// Makes `node` refer to one of its children in the YAML tree. The argument `step` is the name of
/// the child's key, or a list index such as "[3]".
void StepInto(YAML::Node& node, const std::string& text, std::string_view step) {
  if (step.starts_with('[')) {
    std::size_t index = 0;
    const auto [end, error] =
        std::from_chars(step.data() + 1, step.data() + step.size() - 1, index);
    if (error != std::errc{} || end != step.data() + step.size() - 1 || !step.ends_with(']')) {
      Fail(text, fmt::format("expected a list index such as [0], found '{}'", step));
    }
    if (!node.IsSequence() || index >= node.size()) {
      Fail(text, fmt::format("element {} does not exist", step));
    }
    node.reset(node[index]);
    return;
  }
  if (step.empty() || (node.IsDefined() && !node.IsNull() && !node.IsMap())) {
    Fail(text, fmt::format("no section for the key '{}'", step));
  }
  node.reset(node[std::string(step)]);
}

}  // namespace

std::string ApplyOverride(YAML::Node& root, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    Fail(text, "expected key=value");
  }
  const std::string key = text.substr(0, equals);
  YAML::Node value;
  try {
    value = LoadYamlValue(text.substr(equals + 1), "");
  } catch (const InputError& error) {
    Fail(text, error.problems().front().message);
  }
  if (key.ends_with('.')) {
    Fail(text, "the key ends with a dot");
  }
  YAML::Node node(root);
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find_first_of(".[", begin + 1), key.size());
    StepInto(node, text, std::string_view(key).substr(begin, end - begin));
    begin = end < key.size() && key[end] == '.' ? end + 1 : end;
  }
  node = value;
  return key;
}

}  // namespace trackbed
