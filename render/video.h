#pragma once

#include "render/output.h"

namespace trackbed::render {

/// Opens an MP4 video for pictures of a given size, whose sides must be even. Null in a build
/// without TRACKBED_VIDEO, which uses render/video/off.cpp instead of the rest of that folder.
OpenOutput VideoOpener();

/// Open animated pictures, which loop forever: WebP, and PNG, which is lossless. Null in a build
/// without TRACKBED_VIDEO.
OpenOutput WebpOpener();
OpenOutput ApngOpener();

}  // namespace trackbed::render
