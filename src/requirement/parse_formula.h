#pragma once

#include <string_view>

#include "src/requirement/formula_builder.h"

namespace trackbed {

/// Parses the text of a formula and passes its parts to a FormulaBuilder. ParseFormula throws
/// InputError for a syntax error in the formula, or if the builder throws InputError.
void ParseFormula(std::string_view text, FormulaBuilder& builder);

}  // namespace trackbed
