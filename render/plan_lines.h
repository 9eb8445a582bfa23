#pragma once

#include "render/image.h"
#include "render/overlay.h"

namespace trackbed::render {

constexpr Color kPlanColor{1.00F, 1.00F, 0.97F};
constexpr Color kNewPlanColor{1.00F, 0.84F, 0.05F};  // as temporary markings overrule white ones

/// The planned path, and from the moment when the car adopts a new one, that one; those before it
/// stay, faint and narrow.
OverlayEntry PlanOverlay();

}  // namespace trackbed::render
