#pragma once

#include <string_view>
#include <vector>

#include "trackbed/requirement/formula.h"

namespace trackbed {

/// Builds a formula while the parser reads the text of the formula. Checks that each operand of an
/// operation is of the required kind, a condition or a number. If a formula has an error, throws
/// InputError with the error's column in the text.
class FormulaBuilder {
 public:
  /// The argument `text` is the text of the whole formula and must outlive the FormulaBuilder.
  /// Texts passed to the member functions of FormulaBuilder must be substrings of the formula
  /// `text`.
  FormulaBuilder(std::string_view text, const std::vector<std::string>& allowed)
      : text_(text), allowed_(allowed) {}

  void AddNumber(std::string_view number);
  void AddSignal(std::string_view name);

  /// Begins an operation of the formula; the calls between Open and Close add the operands of the
  /// operation.
  void Open(FormulaOperation operation, std::string_view sign);
  /// Adds a time bound to the operation that was begun last. AddBound adds the bound `number` [s];
  /// AddBoundFromEnd adds the bound T minus `number`, where T is the duration of the run.
  void AddBound(std::string_view number);
  void AddBoundFromEnd(std::string_view number);
  /// Ends the operation that was begun last; the parser calls Close after the last operand.
  void Close();

  void OpenParenthesis(std::string_view sign);
  /// Combines the last argument of `min` or `max` with the result of all earlier arguments. The
  /// parser calls FoldArgument after each argument except the first, before the comma or
  /// parenthesis that follows.
  void FoldArgument();
  /// Ends a call of `abs`, `min` or `max` in the formula.
  void CloseFunction(std::string_view sign);
  void CloseParenthesis(std::string_view sign);

  [[nodiscard]] std::vector<FormulaStep> TakeSteps();
  [[nodiscard]] std::vector<std::string> TakeSignals() { return std::move(signals_); }

  /// Throws InputError with `message` and the column of `at`, which is a position in the text of
  /// the formula.
  [[noreturn]] void Fail(const char* at, const std::string& message) const;
  /// Throws InputError that quotes the text at position `at` and names what was expected at this
  /// position.
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
