#include "src/scenario/yaml_reader.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "src/scenario/key_lister.h"
#include "src/scenario/yaml_value.h"
#include "trackbed/core/spelling.h"
#include "trackbed/scenario/car_lengths.h"

// Implements a KeyVisitor that reads a YAML mapping. Each call of Field reads one key of the
// mapping and checks type, range and allowed names. YamlReader reports each problem with the key's
// position in the file and a hint. Finish reports duplicate keys and unknown keys, and suggests the
// most similar valid key. If a key is misspelled, Finish marks the intended key as unread, so that
// the missing value causes no follow-up errors. If the method of a section is missing or unknown,
// FinishWithoutMethod checks the names of the section's keys against the keys of all methods.
namespace trackbed {

YamlReader::YamlReader(ReaderContext& context, const YAML::Node& node, std::string key)
    : context_(context), node_(node), key_(std::move(key)) {}

std::string YamlReader::Dotted(const char* key) const {
  return key_.empty() ? key : key_ + "." + key;
}

void YamlReader::AddError(const YAML::Node& node, const std::string& dotted, std::string message) {
  // If the value is missing, use the position of the key, because yaml-cpp reports the position of
  // the next token for a missing value.
  context_.AddError(node.IsNull() ? last_key_mark_ : node.Mark(), dotted, std::move(message));
}

std::optional<YAML::Node> YamlReader::Take(const char* key, Need need) {
  known_.emplace_back(key);
  for (const auto& entry : node_) {
    if (entry.first.IsScalar() && entry.first.Scalar() == key) {
      last_key_mark_ = entry.first.Mark();
      return entry.second;
    }
  }
  if (need == Need::kRequired) {
    AddError(node_, Dotted(key), "missing");
  }
  return std::nullopt;
}

void YamlReader::ReadMap(const YAML::Node& node, const std::string& dotted, const Inside& inside) {
  if (CheckMap(node, dotted)) {
    YamlReader inner(context_, node, dotted);
    inside(inner);
    inner.Finish();
  }
}

bool YamlReader::VisitSection(const Key& key, Need need, bool, const Inside& inside) {
  const auto node = Take(key.name, need);
  if (node) {
    ReadMap(*node, Dotted(key.name), inside);
  }
  return node.has_value();
}

void YamlReader::VisitList(const Key& key, std::size_t,
                           const std::function<void(std::size_t size)>& resize,
                           const std::function<void(KeyVisitor& keys, std::size_t i)>& visit) {
  const auto node = Take(key.name, Need::kOptional);
  if (!node) {
    return;
  }
  if (!node->IsSequence()) {
    AddError(*node, Dotted(key.name),
             fmt::format("expected a list, found {}", DescribeValue(*node)));
    return;
  }
  resize(node->size());
  for (std::size_t i = 0; i < node->size(); ++i) {
    ReadMap((*node)[i], fmt::format("{}[{}]", Dotted(key.name), i),
            [&](KeyVisitor& inner) { visit(inner, i); });
  }
}

void YamlReader::VisitMethod(const Key& key, Need need, const Methods& methods) {
  const auto node = Take(key.name, need);
  if (!node || !CheckMap(*node, Dotted(key.name))) {
    return;
  }
  YamlReader inner(context_, *node, Dotted(key.name));
  Names names;
  for (const Methods::Entry& entry : methods.entries) {
    names.emplace_back(entry.name);
  }
  std::string method;
  inner.Field(kMethod, method, Need::kRequired, names);
  const auto found = std::find(names.begin(), names.end(), method);
  if (found == names.end()) {
    inner.FinishWithoutMethod(methods);
    return;
  }
  methods.select(static_cast<std::size_t>(found - names.begin()));
  methods.visit_selected(inner);
  methods.rest(inner);
  inner.Finish();
}

void YamlReader::FinishWithoutMethod(const Methods& methods) {
  std::vector<KeySection> sections;
  KeyLister lister(sections, {key_, "", "", {}});
  methods.rest(lister);
  for (std::size_t i = 0; i < methods.entries.size(); ++i) {
    methods.visit_defaults(i, lister);
  }
  method_is_known_ = false;
  CheckNames(sections, key_);
}

void YamlReader::CheckNames(const std::vector<KeySection>& sections, const std::string& section) {
  for (const KeySection& listed : sections) {
    for (std::size_t i = 0; listed.key == section && i < listed.keys.size(); ++i) {
      known_.push_back(listed.keys[i].name);
    }
  }
  const auto check = [&](const YAML::Node& inner, const std::string& key,
                         const std::string& listed) {
    const bool is_listed = std::any_of(sections.begin(), sections.end(),
                                       [&](const KeySection& any) { return any.key == listed; });
    if (inner.IsMap() && is_listed) {
      YamlReader(context_, inner, key).CheckNames(sections, listed);
    }
  };
  for (const auto& entry : node_) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    check(entry.second, Dotted(name.c_str()), section + "." + name);
    for (std::size_t i = 0; entry.second.IsSequence() && i < entry.second.size(); ++i) {
      check(entry.second[i], fmt::format("{}[{}]", Dotted(name.c_str()), i),
            section + "." + name + "[N]");
    }
  }
  Finish();
}

bool YamlReader::HasAny(const char* key, const Names& inner) const {
  const YAML::Node section = static_cast<const YAML::Node&>(node_)[key];
  return section && section.IsMap() && !section[kMethod.name] &&
         std::any_of(inner.begin(), inner.end(),
                     [&](const std::string& name) { return static_cast<bool>(section[name]); });
}

bool YamlReader::CheckMap(const YAML::Node& node, const std::string& dotted) {
  if (!node.IsMap()) {
    AddError(node, dotted,
             fmt::format("expected a section of 'key: value', found {}", DescribeValue(node)));
    return false;
  }
  return true;
}

bool YamlReader::ReadNumber(const YAML::Node& node, const std::string& dotted, Range range,
                            double& value) {
  const std::string problem = ParseNumber(node, range, value);
  if (!problem.empty()) {
    AddError(node, dotted, problem);
  }
  return problem.empty();
}

double YamlReader::DefaultOf(const Key& key, Range range, double value) const {
  const bool is_in_plan = key_ == "plan" || key_.starts_with("plan.");
  if (!context_.car_length_scale || !is_in_plan) {
    return value;
  }
  const YAML::Node method = static_cast<const YAML::Node&>(node_)[kMethod.name];
  if (!FollowsCarSize(key, method && method.IsScalar() ? method.Scalar() : "")) {
    return value;
  }
  if (!context_.length_scale) {
    context_.length_scale = context_.car_length_scale();
  }
  return std::clamp(value * *context_.length_scale, range.min, range.max);
}

void YamlReader::Field(const Key& key, double& value, Need need, Range range) {
  if (const auto node = Take(key.name, need)) {
    ReadNumber(*node, Dotted(key.name), WithinReason(key, range), value);
  } else {
    value = DefaultOf(key, WithinReason(key, range), value);
  }
}

void YamlReader::Field(const Key& key, std::optional<double>& value, Range range) {
  if (const auto node = Take(key.name, Need::kOptional)) {
    double number = 0.0;
    if (ReadNumber(*node, Dotted(key.name), WithinReason(key, range), number)) {
      value = number;
    }
  }
}

bool YamlReader::ReadFlag(const YAML::Node& node, const std::string& dotted, bool& value) {
  if (!Decode(node, value)) {
    AddError(node, dotted,
             fmt::format("expected true or false, found {}", DescribeWrong<bool>(node)));
    return false;
  }
  return true;
}

void YamlReader::Field(const Key& key, bool& value, Need need) {
  if (const auto node = Take(key.name, need)) {
    ReadFlag(*node, Dotted(key.name), value);
  }
}

void YamlReader::Field(const Key& key, std::optional<bool>& value) {
  if (const auto node = Take(key.name, Need::kOptional)) {
    bool flag = false;
    if (ReadFlag(*node, Dotted(key.name), flag)) {
      value = flag;
    }
  }
}

void YamlReader::Field(const Key& key, int& value, Need need, Range range) {
  if (const auto node = Take(key.name, need)) {
    double number = 0.0;
    if (!ReadNumber(*node, Dotted(key.name), range, number)) {
      return;
    }
    if (number != std::floor(number) || std::abs(number) > 1e9) {
      AddError(*node, Dotted(key.name), fmt::format("expected a whole number, found {}", number));
      return;
    }
    value = static_cast<int>(number);
  }
}

void YamlReader::Field(const Key& key, std::uint64_t& value, Need need) {
  if (const auto node = Take(key.name, need)) {
    // Reject a minus sign, because a C++ stream converts -1 to the largest unsigned number.
    if (node->Scalar().starts_with('-') || !Decode(*node, value)) {
      AddError(*node, Dotted(key.name),
               fmt::format("expected a whole number from 0 to {}, found {}",
                           std::numeric_limits<std::uint64_t>::max(),
                           DescribeWrong<std::uint64_t>(*node)));
    }
  }
}

void YamlReader::Field(const Key& key, std::string& value, Need need, const Names& allowed) {
  const auto node = Take(key.name, need);
  if (!node) {
    return;
  }
  if (!node->IsScalar() || node->Scalar().empty()) {
    AddError(*node, Dotted(key.name),
             fmt::format("expected a name, found {}", DescribeValue(*node)));
    return;
  }
  if (!allowed.empty() &&
      std::find(allowed.begin(), allowed.end(), node->Scalar()) == allowed.end()) {
    AddError(*node, Dotted(key.name), "unknown " + UnknownName(node->Scalar(), allowed));
    return;
  }
  value = node->Scalar();
}

void YamlReader::Field(const Key& key, std::optional<std::string>& value) {
  std::string name;
  Field(key, name, Need::kOptional);
  if (!name.empty()) {
    value = name;
  }
}

void YamlReader::Identifier(const Key& key, std::string& value) {
  Field(key, value, Need::kRequired);
  const std::string problem = value.empty() ? "" : FolderNameProblem(value);
  if (!problem.empty()) {
    for (const auto& entry : node_) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key.name) {
        AddError(entry.second, Dotted(key.name), problem);
        return;
      }
    }
  }
}

void YamlReader::Field(const Key& key, std::vector<std::string>& value, Need need,
                       const Names& allowed) {
  const auto node = Take(key.name, need);
  if (!node) {
    return;
  }
  if (!node->IsSequence() || node->size() == 0) {
    AddError(*node, Dotted(key.name),
             fmt::format("expected a list of names, found {}",
                         node->IsSequence() ? "an empty one" : DescribeValue(*node)));
    return;
  }
  Names names;
  for (std::size_t i = 0; i < node->size(); ++i) {
    const YAML::Node item = (*node)[i];
    const std::string dotted = fmt::format("{}[{}]", Dotted(key.name), i);
    if (!item.IsScalar()) {
      AddError(item, dotted, fmt::format("expected a name, found {}", DescribeValue(item)));
    } else if (!allowed.empty() &&
               std::find(allowed.begin(), allowed.end(), item.Scalar()) == allowed.end()) {
      AddError(item, dotted, "unknown " + UnknownName(item.Scalar(), allowed));
    } else if (std::find(names.begin(), names.end(), item.Scalar()) != names.end()) {
      AddError(item, dotted, fmt::format("'{}' is listed twice", item.Scalar()));
    } else {
      names.push_back(item.Scalar());
    }
  }
  value = names;
}

void YamlReader::Field(const Key& key, std::vector<Vec2>& value, Need need,
                       const PairShape& shape) {
  const auto node = Take(key.name, need);
  if (!node) {
    return;
  }
  if (!node->IsSequence()) {
    AddError(*node, Dotted(key.name),
             fmt::format("expected a list of {}, found {}", shape.many, DescribeValue(*node)));
    return;
  }
  value.clear();
  for (std::size_t i = 0; i < node->size(); ++i) {
    const YAML::Node item = (*node)[i];
    const std::string dotted = fmt::format("{}[{}]", Dotted(key.name), i);
    if (!item.IsSequence() || item.size() != 2) {
      AddError(item, dotted,
               fmt::format("expected {}, found {}", shape.one,
                           item.IsSequence() ? CountNumbers(item.size()) : DescribeValue(item)));
      continue;
    }
    Vec2 point = Vec2::Zero();
    if (ReadNumber(item[0], dotted + "[0]", shape.first, point.x()) &&
        ReadNumber(item[1], dotted + "[1]", shape.second, point.y())) {
      value.push_back(point);
    }
  }
}

void YamlReader::Field(const Key& key, std::vector<double>& value, Need need, Range range) {
  const auto node = Take(key.name, need);
  if (!node) {
    return;
  }
  if (!node->IsSequence()) {
    AddError(*node, Dotted(key.name),
             fmt::format("expected a list of numbers, found {}", DescribeValue(*node)));
    return;
  }
  value.clear();
  for (std::size_t i = 0; i < node->size(); ++i) {
    double number = 0.0;
    if (ReadNumber((*node)[i], fmt::format("{}[{}]", Dotted(key.name), i), WithinReason(key, range),
                   number)) {
      value.push_back(number);
    }
  }
}

void YamlReader::Pair(const Key& key, int& first, int& second, Range range) {
  const auto node = Take(key.name, Need::kOptional);
  if (!node) {
    return;
  }
  if (!node->IsSequence() || node->size() != 2) {
    AddError(*node, Dotted(key.name),
             fmt::format("expected two whole numbers, found {}",
                         node->IsSequence() ? CountNumbers(node->size()) : DescribeValue(*node)));
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    double number = 0.0;
    const std::string dotted = fmt::format("{}[{}]", Dotted(key.name), i);
    if (!ReadNumber((*node)[i], dotted, range, number)) {
      continue;
    }
    if (number != std::floor(number)) {
      AddError((*node)[i], dotted, fmt::format("expected a whole number, found {}", number));
      continue;
    }
    (i == 0 ? first : second) = static_cast<int>(number);
  }
}

void YamlReader::Finish() {
  Names seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) {
      AddError(entry.first, key_, "keys must be names");
      continue;
    }
    const std::string& name = entry.first.Scalar();
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
      AddError(entry.first, Dotted(name.c_str()), "duplicate key");
    } else if (std::find(known_.begin(), known_.end(), name) == known_.end()) {
      const std::string meant = NearestSpelling(name, known_);
      AddError(
          entry.first, Dotted(name.c_str()),
          "unknown key " + (method_is_known_ || !meant.empty()
                                ? UnknownName(name, known_) + context_.MethodHint(key_, node_, name)
                                : fmt::format("'{}'; no method has this key", name)));
      if (!meant.empty()) {
        context_.unread.push_back(Dotted(meant.c_str()));
      }
    }
    seen.push_back(name);
  }
}

}  // namespace trackbed
