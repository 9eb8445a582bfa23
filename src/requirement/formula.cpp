#include "trackbed/requirement/formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "src/requirement/formula_builder.h"
#include "src/requirement/parse_formula.h"
#include "trackbed/core/error.h"

namespace trackbed {

Formula Formula::Parse(std::string_view text, const std::vector<std::string>& signals) {
  if (text.size() > kMaxLength) {
    throw InputError(Problem{.column = static_cast<int>(kMaxLength) + 1,
                             .message = fmt::format("the formula has {} bytes; at most {} are "
                                                    "allowed",
                                                    text.size(), kMaxLength)});
  }
  Formula formula;
  formula.text_ = text;
  FormulaBuilder builder(formula.text_, signals);
  ParseFormula(formula.text_, builder);
  formula.steps_ = builder.TakeSteps();
  formula.signals_ = builder.TakeSignals();
  return formula;
}

double Formula::horizon_s() const {
  std::vector<double> horizons;
  const auto pop = [&] {
    const double top = horizons.back();
    horizons.pop_back();
    return top;
  };
  for (const FormulaStep& step : steps_) {
    const double reach =
        step.to.from_end ? std::numeric_limits<double>::infinity() : step.to.seconds;
    switch (step.operation) {
      case FormulaOperation::kNumber:
      case FormulaOperation::kSignal:
        horizons.push_back(0.0);
        break;
      case FormulaOperation::kNegate:
      case FormulaOperation::kAbs:
      case FormulaOperation::kNot:
        break;
      case FormulaOperation::kAlways:
      case FormulaOperation::kEventually:
        horizons.back() += reach;
        break;
      default: {
        const double second = pop();
        horizons.back() = std::max(horizons.back(), second) + reach;
      }
    }
  }
  return pop();
}

}  // namespace trackbed
