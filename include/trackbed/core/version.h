#pragma once

namespace trackbed {

/// The version this library was built as: the project's, and what `git describe` said of the
/// sources ("0.1.0 (v0.1.0-3-g1a2b3c4)").
const char* Version();

}  // namespace trackbed
