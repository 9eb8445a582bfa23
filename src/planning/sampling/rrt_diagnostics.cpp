#include "trackbed/planning/sampling/rrt_diagnostics.h"

namespace trackbed {

void Visit(DiagnosticsVisitor& out, const RrtLeg& leg) {
  out.Text("status", ToString(leg.status));
  out.Integer("iterations", leg.iterations);
  out.Integer("nodes", leg.nodes);
  out.Number("length_m", leg.length);
  if (leg.sweeps) {
    out.Integer("sweeps", *leg.sweeps);
  }
  if (out.full()) {
    out.Points("path_m", leg.path);
    if (leg.sweeps) {
      out.Points("smooth_m", leg.smooth);
    }
  }
}

void Visit(DiagnosticsVisitor& out, const RrtTreeFindings& own) {
  out.Text("status", ToString(own.status));
  out.Number("length_m", own.score.length);
  out.Number("wind_m", own.score.wind);
  out.Number("total_m", own.score.total);
  if (own.remaining) {
    out.Flag("partial", true);
    out.Number("left_m", *own.remaining);
  }
  out.Text("reason", own.reason);
}

void Visit(DiagnosticsVisitor& out, const RrtDiagnostics& own) {
  out.List("legs", own.legs);
  out.List("trees", own.trees);
  out.Integer("chosen", own.chosen);
  if (own.partial) {
    out.Flag("partial", true);
    out.Integer("next_waypoint", own.partial->waypoint);
    out.Number("left_m", own.partial->remaining);
    if (out.full()) {
      out.Text("partial_reason", own.partial->reason);
    }
  }
}

}  // namespace trackbed
