#pragma once

namespace trackbed {

/// The version of this library: the project's version, and the output of `git describe` for the
/// sources ("0.1.0 (v0.1.0-3-g1a2b3c4)").
const char* Version();

}  // namespace trackbed
