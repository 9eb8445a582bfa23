#include "render/overlays.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/caption.h"
#include "render/error_ribbon.h"
#include "render/event_marks.h"
#include "render/gates.h"
#include "render/ghost.h"
#include "render/ground_paint.h"
#include "render/obstacles.h"
#include "render/plan_lines.h"
#include "render/relief.h"
#include "render/road.h"
#include "render/skid_marks.h"
#include "render/strip.h"
#include "render/trail.h"
#include "render/tyre_forces.h"
#include "render/wind_arrows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::render {
namespace {

/// Throws InputError, suggesting the most similar name, if the name of an overlay is unknown.
void CheckNames(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const OverlayEntry& entry : OverlayTable()) {
    known.push_back(entry.name);
  }
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw InputError(
          Problem{.key = "overlays", .message = "unknown overlay " + UnknownName(name, known)});
    }
  }
}

}  // namespace

/// The registry of overlays is defined by one line per overlay. Overlays that are later in the
/// registry are drawn over earlier overlays.
const std::vector<OverlayEntry>& OverlayTable() {
  static const std::vector<OverlayEntry> table{
      RoadOverlay(),  ReliefOverlay(),  GateOverlay(),  ObstacleOverlay(), SkidMarkOverlay(),
      PlanOverlay(),  TrailOverlay(),   ErrorOverlay(), GhostOverlay(),    WindOverlay(),
      StripOverlay(), CaptionOverlay(), ForceOverlay(), EventOverlay(),
  };
  return table;
}

OverlayList MakeOverlays(const OverlaySetup& setup) {
  CheckNames(setup.shown);
  OverlayList overlays;
  for (const OverlayEntry& entry : OverlayTable()) {
    if (setup.Shows(entry.name)) {
      overlays.push_back(entry.make(setup));
    }
  }
  return overlays;
}

std::vector<LegendEntry> MakeLegend(const Recording& recording, const OverlayList& overlays) {
  std::vector<LegendEntry> legend{
      {recording.plants.front().color(), recording.plants.front().plant()}};
  for (const auto& overlay : overlays) {
    overlay->AddLegend(legend);
  }
  std::vector<double> factors;
  for (const FrictionPatch& patch : recording.world.friction_patches) {
    factors.push_back(patch.friction);
  }
  std::sort(factors.begin(), factors.end());
  factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
  // maximum number of friction factors in the legend; a fourth color would be hard to distinguish
  constexpr std::size_t kMaxFactors = 3;
  for (std::size_t i = 0; i < std::min(factors.size(), kMaxFactors); ++i) {
    legend.push_back({PatchColorOnRoad(factors[i]), fmt::format("friction x{:.3g}", factors[i])});
  }
  return legend;
}

}  // namespace trackbed::render
