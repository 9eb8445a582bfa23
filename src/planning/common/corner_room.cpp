#include "trackbed/planning/common/corner_room.h"

#include <fmt/format.h>

#include <utility>

#include "trackbed/planning/common/plan_comparison.h"

namespace trackbed {

Plan WithLessCornerRoom(const PlanRequest& request, double corner_room,
                        const std::function<Plan(const PlanRequest&, double)>& plan) {
  Plan best = plan(request, corner_room);
  if (request.max_samples < kMaxSamples) {
    return best;
  }
  PlanRequest left = request;
  for (const double share : {0.3, 0.0}) {
    const PlanStatus status = best.status;
    const bool may_help =
        best.ok() ? best.partial.empty() && IsDetour(best, request)
                  : status == PlanStatus::kNoPath || status == PlanStatus::kTurnTooTight ||
                        status == PlanStatus::kCollides || status == PlanStatus::kBudgetUsedUp ||
                        status == PlanStatus::kStartBlocked;
    left.max_samples = request.max_samples - best.diagnostics.samples;
    if (!may_help || corner_room == 0.0 || request.obstacles.empty() || left.max_samples <= 0) {
      break;
    }
    Plan own = plan(left, share * corner_room);
    const long samples = best.diagnostics.samples + own.diagnostics.samples;
    if (own.partial.empty() && IsShorterAndNotSlower(own, best, request.vehicle)) {
      own.notes.push_back(fmt::format(
          "corner_room is reduced from {:.3g} m to {:.3g} m: {}", corner_room, share * corner_room,
          best.ok() ? fmt::format("the path is {:.4g} m long instead of {:.4g} m", PlanLength(own),
                                  PlanLength(best))
                    : "with more, there is no path"));
      best = std::move(own);
      best.diagnostics.samples = samples;
      break;
    }
    best.diagnostics.samples = samples;
  }
  // Among obstacles, make a second plan, for a car at rest, only if the detour exceeds the stopping
  // distance. Detours around obstacles are common, and a second plan takes computing time.
  const double stopping =
      0.5 * request.start_speed * request.start_speed / request.speed.deceleration;
  if (best.partial.empty() && corner_room > 0.0 &&
      (request.obstacles.empty() || ExtraLength(best, request) > stopping)) {
    NoteDetourOfRollingStart(request, best,
                             [&](const PlanRequest& own) { return plan(own, corner_room); });
  }
  return best;
}

}  // namespace trackbed
