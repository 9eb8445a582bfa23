#pragma once

#include <string>
#include <vector>

#include "render/overlay.h"

namespace trackbed::render {

/// All overlays, in the order of drawing and of the legend.
const std::vector<OverlayEntry>& OverlayTable();

/// The overlays named by `setup.shown`; InputError with the nearest name if there is an unknown
/// name.
OverlayList MakeOverlays(const OverlaySetup& setup);

/// The legend of a picture of `recording` with these overlays.
std::vector<LegendEntry> MakeLegend(const Recording& recording, const OverlayList& overlays);

}  // namespace trackbed::render
