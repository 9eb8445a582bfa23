#pragma once

#include <string>
#include <vector>

#include "render/overlay.h"

namespace trackbed::render {

/// Returns the table of overlays in the order in which overlays are drawn and listed in the legend.
const std::vector<OverlayEntry>& OverlayTable();

/// Makes the overlays named in `setup.shown`. Throws InputError that suggests the most similar
/// name, if a name is unknown.
OverlayList MakeOverlays(const OverlaySetup& setup);

/// Returns the legend for frames of `recording` with these overlays.
std::vector<LegendEntry> MakeLegend(const Recording& recording, const OverlayList& overlays);

}  // namespace trackbed::render
