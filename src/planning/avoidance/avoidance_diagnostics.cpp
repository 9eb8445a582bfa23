#include "trackbed/planning/avoidance/avoidance_diagnostics.h"

namespace trackbed {
namespace {

/// Data for the part of plan.json about the tree search for the path past the obstacle.
struct TreeRecord {
  const BezierAvoidanceDiagnostics& own;
};

void Visit(DiagnosticsVisitor& out, const TreeRecord& tree) {
  out.Text("status", ToString(tree.own.tree_status));
  out.Integer("iterations", tree.own.tree_iterations);
  out.Integer("nodes", tree.own.tree_nodes);
  if (tree.own.tree_status == RrtStarStatus::kFound) {
    out.Number("cost_m", tree.own.tree_cost);
    out.Points("path_m", tree.own.tree_path);
  }
}

/// Data for the part of plan.json about the search that moved the control points of the curve.
struct RepairRecord {
  const BezierAvoidanceDiagnostics& own;
};

void Visit(DiagnosticsVisitor& out, const RepairRecord& search) {
  out.Text("method", search.own.search_method);
  out.Integer("evaluations", search.own.search_evaluations);
  out.Number("objective", search.own.search_objective);
}

struct ListingTreeRecord {
  const ListingAvoidanceDiagnostics& own;
};

void Visit(DiagnosticsVisitor& out, const ListingTreeRecord& tree) {
  out.Integer("nodes", tree.own.tree_nodes);
  out.Number("goal_distance_m", tree.own.goal_distance);
  out.Number("final_y_m", tree.own.final_y);
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const OnePointCheck& check) {
  out.Number("distance_m", check.distance);
  out.Flag("passed", check.passed);
}

void Visit(DiagnosticsVisitor& out, const BezierAvoidanceDiagnostics& own) {
  out.Text("method", "bezier");
  out.Integer("curves_tried", own.curves_tried);
  if (out.full()) {
    out.Section("rrt_star", TreeRecord{own});
    out.Section("search", RepairRecord{own});
    out.Section("one_point_check", own.one_point_check);
  }
}

void Visit(DiagnosticsVisitor& out, const ListingAvoidanceDiagnostics& own) {
  out.Text("method", "listing");
  out.Integer("obstacle_sixth", own.obstacle_sixth);
  if (out.full()) {
    out.Section("rrt_star", ListingTreeRecord{own});
    out.Section("one_point_check", own.one_point_check);
  }
}

}  // namespace trackbed
