#pragma once

#include "render/output.h"

namespace trackbed::render {

/// Returns the function that opens an MP4 video, for frames of even width and height. VideoOpener
/// returns null in a build without TRACKBED_VIDEO, which compiles render/video/off.cpp instead of
/// the encoder.
OpenOutput VideoOpener();

/// Returns the function that opens an animated image file (WebP, or lossless PNG), which repeats
/// forever. WebpOpener and ApngOpener return null in a build without TRACKBED_VIDEO.
OpenOutput WebpOpener();
OpenOutput ApngOpener();

}  // namespace trackbed::render
