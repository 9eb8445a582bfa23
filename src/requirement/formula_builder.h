#pragma once

#include <string_view>
#include <vector>

#include "trackbed/requirement/formula.h"

namespace trackbed {

/// Builds a formula while the parser reads its text. Checks that operands are conditions or numbers
/// as required. Throws InputError with the column in the text.
class FormulaBuilder {
 public:
  /// `text` must outlive the builder. All other texts must be parts of `text`.
  FormulaBuilder(std::string_view text, const std::vector<std::string>& allowed)
      : text_(text), allowed_(allowed) {}

  void AddNumber(std::string_view number);
  void AddSignal(std::string_view name);

  /// Begins an operation; the operands of the operation follow.
  void Open(FormulaOperation operation, std::string_view sign);
  /// Adds a bound to the last operation that was begun: the number, or the duration T minus the
  /// number.
  void AddBound(std::string_view number);
  void AddBoundFromEnd(std::string_view number);
  /// Ends the operation, after its last operand.
  void Close();

  void OpenParenthesis(std::string_view sign);
  /// Ends the second or a later argument of `min` and `max`, before the comma or parenthesis that
  /// follows.
  void FoldArgument();
  /// Ends a call of `abs`, `min` or `max`.
  void CloseFunction(std::string_view sign);
  void CloseParenthesis(std::string_view sign);

  [[nodiscard]] std::vector<FormulaStep> TakeSteps();
  [[nodiscard]] std::vector<std::string> TakeSignals() { return std::move(signals_); }

  /// Throws InputError at the part of the text that begins at `at`.
  [[noreturn]] void Fail(const char* at, const std::string& message) const;
  /// Throws InputError that names the text at `at` and the text that was expected there.
  [[noreturn]] void FailExpected(const char* at, const std::string& expected) const;

 private:
  enum class Kind { kNumber, kCondition };

  struct Operand {
    Kind kind;
    std::size_t begin;
    std::size_t end;
  };

  struct Pending {
    FormulaStep step;
    std::string_view sign;
    int bounds = 0;
  };

  void Push(Pending pending);
  void SetBound(WindowBound bound, std::string_view text);
  void Apply(const Pending& pending);
  void Require(const Operand& operand, Kind kind, std::string_view sign) const;
  [[nodiscard]] std::size_t Offset(const char* at) const {
    return static_cast<std::size_t>(at - text_.data());
  }
  [[nodiscard]] double ReadNumber(std::string_view number) const;

  std::string_view text_;
  const std::vector<std::string>& allowed_;
  std::vector<std::string> signals_;
  std::vector<FormulaStep> steps_;
  std::vector<Operand> operands_;
  std::vector<Pending> pending_;
};

}  // namespace trackbed
