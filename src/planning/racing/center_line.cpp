#include "trackbed/planning/racing/center_line.h"

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/racing/track_line.h"

namespace trackbed {
namespace {

Plan PlanWith(const CenterLineOptions& /*options*/, const PlanRequest& request) {
  return FollowLine(request, TrackLine());
}

}  // namespace

void Visit(KeyVisitor& /*keys*/, CenterLineOptions& /*options*/) {}

PlannerEntry CenterLinePlanner() {
  return {.name = "center_line",
          .summary = "laps along the center line of a track",
          .defaults = CenterLineOptions{},
          .plan = PlanBy<CenterLineOptions, PlanWith>,
          .follows_track = true,
          .start_curvature = StartCurvatureOnTrack};
}

}  // namespace trackbed
