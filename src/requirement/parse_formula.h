#pragma once

#include <string_view>

#include "src/requirement/formula_builder.h"

namespace trackbed {

/// Hands the parts of a formula to its builder. InputError for a syntax error, and those of the
/// builder.
void ParseFormula(std::string_view text, FormulaBuilder& builder);

}  // namespace trackbed
