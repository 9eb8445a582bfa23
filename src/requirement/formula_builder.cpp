#include "src/requirement/formula_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

constexpr double kMaxTimeBound = 1e6;  // [s]

bool IsWindowed(FormulaOperation operation) {
  return operation == FormulaOperation::kAlways || operation == FormulaOperation::kEventually ||
         operation == FormulaOperation::kUntil;
}

std::size_t OperandCount(FormulaOperation operation) {
  switch (operation) {
    case FormulaOperation::kNumber:
    case FormulaOperation::kSignal:
      return 0;
    case FormulaOperation::kNegate:
    case FormulaOperation::kAbs:
    case FormulaOperation::kNot:
    case FormulaOperation::kAlways:
    case FormulaOperation::kEventually:
      return 1;
    default:
      return 2;
  }
}

/// Returns whether the operands of an operation are numbers and not conditions.
bool TakesNumbers(FormulaOperation operation) {
  return operation < FormulaOperation::kNot;
}

bool GivesNumber(FormulaOperation operation) {
  return operation < FormulaOperation::kLess;
}

/// Returns the name or number at the beginning of a formula's text. If the text begins with neither
/// a name nor a number, returns its first character.
std::string_view FirstWord(std::string_view text) {
  const auto in_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
  const auto is_continuation = [](unsigned char c) { return (c & 0xC0U) == 0x80U; };
  constexpr std::size_t kMaxQuotedLength = 40;
  std::size_t length = 1;
  const bool word = in_word(static_cast<unsigned char>(text.front()));
  while (length < std::min(text.size(), kMaxQuotedLength) &&
         (word ? in_word(static_cast<unsigned char>(text[length]))
               : is_continuation(static_cast<unsigned char>(text[length])))) {
    ++length;
  }
  return text.substr(0, length);
}

/// Returns a part of a formula's text in quotes, shortened if it is long.
std::string Quoted(std::string_view part) {
  constexpr std::size_t kMaxQuotedLength = 60;
  return part.size() <= kMaxQuotedLength ? fmt::format("'{}'", part)
                                         : fmt::format("'{} …'", part.substr(0, kMaxQuotedLength));
}

}  // namespace

void FormulaBuilder::Fail(const char* at, const std::string& message) const {
  throw InputError(Problem{.column = static_cast<int>(Offset(at)) + 1, .message = message});
}

void FormulaBuilder::FailExpected(const char* at, const std::string& expected) const {
  const std::size_t offset = Offset(at);
  Fail(at, offset == text_.size()
               ? fmt::format("expected {}, found the end", expected)
               : fmt::format("expected {}, found '{}'", expected, FirstWord(text_.substr(offset))));
}

double FormulaBuilder::ReadNumber(std::string_view number) const {
  double value = 0.0;
  const char* end = number.data() + number.size();
  if (const auto [to, error] = std::from_chars(number.data(), end, value);
      error != std::errc{} || to != end) {
    Fail(number.data(), fmt::format("{} is not representable as a double", number));
  }
  return value;
}

void FormulaBuilder::AddNumber(std::string_view number) {
  const std::size_t begin = Offset(number.data());
  steps_.push_back({.operation = FormulaOperation::kNumber,
                    .number = ReadNumber(number),
                    .begin = begin,
                    .end = begin + number.size()});
  operands_.push_back({Kind::kNumber, begin, begin + number.size()});
}

void FormulaBuilder::AddSignal(std::string_view name) {
  if (std::find(allowed_.begin(), allowed_.end(), name) == allowed_.end()) {
    Fail(name.data(), "unknown signal " + UnknownName(name, allowed_));
  }
  const auto found = std::find(signals_.begin(), signals_.end(), name);
  const auto index = static_cast<std::size_t>(found - signals_.begin());
  if (found == signals_.end()) {
    signals_.emplace_back(name);
  }
  const std::size_t begin = Offset(name.data());
  steps_.push_back({.operation = FormulaOperation::kSignal,
                    .signal = index,
                    .begin = begin,
                    .end = begin + name.size()});
  operands_.push_back({Kind::kNumber, begin, begin + name.size()});
}

void FormulaBuilder::Push(Pending pending) {
  if (pending_.size() == Formula::kMaxDepth) {
    Fail(pending.sign.data(),
         fmt::format("more than {} parentheses and operators in each other", Formula::kMaxDepth));
  }
  pending_.push_back(pending);
}

void FormulaBuilder::Open(FormulaOperation operation, std::string_view sign) {
  FormulaStep step{.operation = operation, .begin = Offset(sign.data())};
  if (IsWindowed(operation)) {
    step.to = {.from_end = true};
  }
  Push({step, sign});
}

void FormulaBuilder::OpenParenthesis(std::string_view sign) {
  Push({{.begin = Offset(sign.data())}, sign});
}

void FormulaBuilder::SetBound(WindowBound bound, std::string_view text) {
  if (!(bound.seconds <= kMaxTimeBound)) {
    Fail(text.data(),
         fmt::format("{} s is out of range; must be at most {} s", bound.seconds, kMaxTimeBound));
  }
  Pending& window = pending_.back();
  (window.bounds == 0 ? window.step.from : window.step.to) = bound;
  const auto& [from, to] = std::pair(window.step.from, window.step.to);
  if (++window.bounds == 2 && from.from_end == to.from_end &&
      (from.from_end ? from.seconds < to.seconds : from.seconds > to.seconds)) {
    Fail(text.data(), "the second bound of a window must not be before the first");
  }
}

void FormulaBuilder::AddBound(std::string_view number) {
  SetBound({.seconds = ReadNumber(number)}, number);
}

void FormulaBuilder::AddBoundFromEnd(std::string_view number) {
  SetBound({.seconds = number.empty() ? 0.0 : ReadNumber(number), .from_end = true}, number);
}

void FormulaBuilder::Require(const Operand& operand, Kind kind, std::string_view sign) const {
  if (operand.kind == kind) {
    return;
  }
  const std::string part = Quoted(text_.substr(operand.begin, operand.end - operand.begin));
  Fail(text_.data() + operand.begin,
       kind == Kind::kNumber
           ? fmt::format("'{}' needs numbers; {} is a condition", sign, part)
           : fmt::format("'{}' needs conditions such as 'x < 1'; {} is a number", sign, part));
}

void FormulaBuilder::Apply(const Pending& pending) {
  const FormulaOperation operation = pending.step.operation;
  const std::size_t count = OperandCount(operation);
  const std::size_t first = operands_.size() - count;
  for (std::size_t i = first; i < operands_.size(); ++i) {
    Require(operands_[i], TakesNumbers(operation) ? Kind::kNumber : Kind::kCondition, pending.sign);
  }
  FormulaStep step = pending.step;
  step.begin = std::min(step.begin, operands_[first].begin);
  step.end = operands_.back().end;
  operands_.resize(first);
  operands_.push_back(
      {GivesNumber(operation) ? Kind::kNumber : Kind::kCondition, step.begin, step.end});
  steps_.push_back(step);
}

void FormulaBuilder::Close() {
  Apply(pending_.back());
  pending_.pop_back();
}

void FormulaBuilder::FoldArgument() {
  Apply(pending_.back());
}

void FormulaBuilder::CloseFunction(std::string_view sign) {
  if (pending_.back().step.operation == FormulaOperation::kAbs) {
    Apply(pending_.back());
  }
  steps_.back().end = Offset(sign.data()) + sign.size();
  operands_.back().end = steps_.back().end;
  pending_.pop_back();
}

void FormulaBuilder::CloseParenthesis(std::string_view sign) {
  operands_.back().begin = pending_.back().step.begin;
  operands_.back().end = Offset(sign.data()) + sign.size();
  pending_.pop_back();
}

std::vector<FormulaStep> FormulaBuilder::TakeSteps() {
  const Operand& whole = operands_.back();
  if (whole.kind != Kind::kCondition) {
    Fail(text_.data() + whole.begin,
         fmt::format("a formula must be a condition such as 'x < 1'; {} is a number",
                     Quoted(text_.substr(whole.begin, whole.end - whole.begin))));
  }
  if (signals_.empty()) {
    Fail(text_.data(), "the formula uses no signal");
  }
  return std::move(steps_);
}

}  // namespace trackbed
