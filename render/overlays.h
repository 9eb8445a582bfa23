#pragma once

#include <string>
#include <vector>

#include "render/overlay.h"

namespace trackbed::render {

/// The table of overlays, in the order of drawing and of the legend.
const std::vector<OverlayEntry>& OverlayTable();

/// The overlays named by `setup.shown`. MakeOverlays throws InputError with the nearest name if a
/// name is unknown.
OverlayList MakeOverlays(const OverlaySetup& setup);

/// The legend of a picture of `recording` with these overlays.
std::vector<LegendEntry> MakeLegend(const Recording& recording, const OverlayList& overlays);

}  // namespace trackbed::render
