#pragma once

namespace trackbed {

/// Returns the version of this library: the version number, followed by the output of `git
/// describe` for the source code ("0.1.0 (v0.1.0-3-g1a2b3c4)").
const char* Version();

}  // namespace trackbed
