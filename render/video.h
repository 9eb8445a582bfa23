#pragma once

#include "render/output.h"

namespace trackbed::render {

/// What opens an MP4 video for pictures of a given size, whose sides must be even. Null in a build
/// without TRACKBED_VIDEO, which has render/video/off.cpp instead of the rest of that folder.
OpenOutput VideoOpener();

/// What opens animated pictures, which play again and again wherever pictures are shown: WebP, and
/// PNG, which loses nothing. Null likewise.
OpenOutput WebpOpener();
OpenOutput ApngOpener();

}  // namespace trackbed::render
