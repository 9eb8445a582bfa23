#include "trackbed/core/error.h"

#include <filesystem>

namespace trackbed {
namespace {

std::string Join(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) {
      text += '\n';
    }
    text += problem.ToString();
  }
  return text;
}

}  // namespace

std::string Problem::WithoutPlace() const {
  return key.empty() ? message : key + ": " + message;
}

std::string Problem::ToString() const {
  std::string text = file;
  if (line > 0) {
    text += column > 0 ? fmt::format(":{}:{}", line, column) : fmt::format(":{}", line);
  }
  if (!text.empty()) {
    text += ": ";
  }
  if (!key.empty()) {
    text += key + ": ";
  }
  return WithoutControls(text + message);
}

std::string WithoutControls(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_control = (byte < 0x20 && c != '\t' && c != '\n') || byte == 0x7f;
    shown += is_control ? fmt::format("<U+{:04X}>", byte) : std::string(1, c);
  }
  return shown;
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(Join(problems)), problems_(std::move(problems)) {}

void ThrowPreconditionError(const std::string& message) {
  throw PreconditionError(message);
}

void ThrowInternalError(const char* file, int line, const char* condition,
                        const std::string& message) {
  throw InternalError(fmt::format("{}:{}: {} ({} does not hold)",
                                  std::filesystem::path(file).filename().string(), line, message,
                                  condition));
}

}  // namespace trackbed
