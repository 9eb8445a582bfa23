#pragma once

#include <string>
#include <vector>

#include "render/overlay.h"

namespace trackbed::render {

/// All overlays, in the order in which they are drawn and stand in the legend.
const std::vector<OverlayEntry>& OverlayTable();

/// The overlays that `setup.shown` names; InputError with the nearest name where one of these is no
/// overlay's.
OverlayList MakeOverlays(const OverlaySetup& setup);

/// What the colors of a picture of `recording` with these overlays stand for.
std::vector<LegendEntry> MakeLegend(const Recording& recording, const OverlayList& overlays);

}  // namespace trackbed::render
