#include "src/path_files/json.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "src/path_files/reading.h"
#include "trackbed/core/classic_locale.h"
#include "trackbed/core/error.h"
#include "trackbed/core/foreign_content.h"
#include "trackbed/core/text_table.h"

// Parses JSON texts, and YAML texts that are converted to JSON values.
namespace trackbed {
namespace {

using nlohmann::json;

/// Builds a JSON value from the events of a YAML parser. Refuses aliases, because aliases can
/// expand a small text to a huge document.
class JsonOfYaml : public YAML::EventHandler {
 public:
  explicit JsonOfYaml(std::string file) : file_(std::move(file)) {}

  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { Add(mark, nullptr); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    Fail(mark, "aliases ('*') are not read");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t /*anchor*/,
                const std::string& value) override {
    if (open_.empty() || open_.back().value.is_array() || open_.back().key) {
      const auto number = tag == "!" ? std::nullopt : CellNumber(value);
      Add(mark, number ? json(*number) : json(value));
    } else {
      open_.back().key = value;
    }
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {
    Open(mark, json::array());
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    Open(mark, json::object());
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapEnd() override { Close(); }

  [[nodiscard]] json Take() { return std::move(root_); }

 private:
  struct Level {
    json value;
    std::optional<std::string> key{};  // key of the next value in the mapping
    YAML::Mark mark;
  };

  [[noreturn]] void Fail(const YAML::Mark& mark, std::string message) const {
    throw InputError(Problem{file_, mark.line + 1, mark.column + 1, "", std::move(message)});
  }
  void Open(const YAML::Mark& mark, json value) {
    if (!open_.empty() && open_.back().value.is_object() && !open_.back().key) {
      Fail(mark, "a list or section as a key");
    }
    if (open_.size() == kMaxDepth) {
      Fail(mark, fmt::format("nested deeper than {} levels", kMaxDepth));
    }
    open_.push_back({std::move(value), {}, mark});
  }
  void Close() {
    Level level = std::move(open_.back());
    open_.pop_back();
    Add(level.mark, std::move(level.value));
  }
  void Add(const YAML::Mark& mark, json value) {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (open_.back().value.is_array()) {
      open_.back().value.push_back(std::move(value));
    } else if (open_.back().key) {
      open_.back().value[*open_.back().key] = std::move(value);
      open_.back().key.reset();
    } else {
      Fail(mark, "a key without a name");
    }
  }

  std::string file_;
  std::vector<Level> open_;
  json root_;
};

}  // namespace

json ParseJsonText(const std::string& text, const std::string& file) {
  try {
    return json::parse(text, [&](int depth, json::parse_event_t /*event*/, const json& /*value*/) {
      if (depth > kMaxDepth) {
        throw InputError(Problem{
            .file = file, .message = fmt::format("nested deeper than {} levels", kMaxDepth)});
      }
      return true;
    });
  } catch (const json::parse_error& error) {
    int line = 1;
    for (std::size_t i = 0; i + 1 < error.byte && i < text.size(); ++i) {
      line += text[i] == '\n' ? 1 : 0;
    }
    const std::string what = error.what();
    const std::size_t colon = what.find(": ");
    throw InputError(
        Problem{.file = file,
                .line = line,
                .message = ParseProblem(
                    text, "JSON", colon == std::string::npos ? what : what.substr(colon + 2))});
  } catch (const json::out_of_range& error) {
    throw InputError(Problem{.file = file, .message = "not JSON: a number is too large"});
  }
}

json ParseYamlText(const std::string& text, const std::string& file) {
  const ClassicLocale locale;
  std::istringstream stream(text);
  JsonOfYaml events(file);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(events);
  } catch (const YAML::Exception& error) {
    throw InputError(
        Problem{file, error.mark.line + 1, error.mark.column + 1, "", "not YAML: " + error.msg});
  }
  return events.Take();
}

double NumberOf(const json& value, const std::string& key, double largest,
                const std::string& file) {
  const auto refuse = [&](std::string message) {
    throw InputError(Problem{.file = file, .key = key, .message = std::move(message)});
  };
  if (!value.is_number()) {
    refuse(
        value.is_null()
            ? "missing; must be a finite number"
            : fmt::format("{} is not a finite number",
                          value.dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 40)));
  }
  const auto number = value.get<double>();
  if (!std::isfinite(number) || std::abs(number) > largest) {
    refuse(fmt::format("{} is out of range; must be between {} and {}", number, -largest, largest));
  }
  return number;
}

}  // namespace trackbed
