#pragma once

#include <string_view>

#include "src/requirement/formula_builder.h"

namespace trackbed {

/// Parses a formula and passes its parts to the builder. Throws InputError for a syntax error, or
/// if the builder throws InputError.
void ParseFormula(std::string_view text, FormulaBuilder& builder);

}  // namespace trackbed
