#pragma once

#include <string>

struct mjModel_;

namespace trackbed {

/// Checks a compiled model before its data is used. Every number of the model must be finite and in
/// a range that is plausible for vehicles, and gravity must point down. Joint names become names of
/// log columns, so they must be unique and consist of plain characters.
///
/// Throws InputError that lists all problems, each with the name of the affected body, joint, geom
/// or number.
void CheckModel(const mjModel_& model, const std::string& file);

}  // namespace trackbed
