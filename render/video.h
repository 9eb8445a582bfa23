#pragma once

#include "render/output.h"

namespace trackbed::render {

/// Opens an MP4 video for pictures of a given size, whose sides must be even. VideoOpener returns
/// null in a build without TRACKBED_VIDEO, which compiles only render/video/off.cpp of that folder.
OpenOutput VideoOpener();

/// Opens an animated picture that loops forever: WebP, or lossless PNG. The opener is null in a
/// build without TRACKBED_VIDEO.
OpenOutput WebpOpener();
OpenOutput ApngOpener();

}  // namespace trackbed::render
