#include "trackbed/planning/common/plan_diagnostics.h"

#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

using nlohmann::json;

json ToJson(const Vec2& point) {
  return {point.x(), point.y()};
}

/// Writes fields into a JSON object.
class JsonWriter : public DiagnosticsVisitor {
 public:
  explicit JsonWriter(json& object) : object_(object) {}

  [[nodiscard]] bool full() const override { return true; }

  void Number(const char* name, double value) override { object_[name] = value; }
  void Integer(const char* name, std::int64_t value) override { object_[name] = value; }
  void Flag(const char* name, bool value) override { object_[name] = value; }
  void Text(const char* name, const std::string& value) override { object_[name] = value; }
  void Numbers(const char* name, const std::vector<double>& values) override {
    object_[name] = values;
  }
  void Point(const char* name, const Vec2& value) override { object_[name] = ToJson(value); }
  void Points(const char* name, const std::vector<Vec2>& values) override {
    json& list = object_[name] = json::array();
    for (const Vec2& value : values) {
      list.push_back(ToJson(value));
    }
  }

 protected:
  void VisitSection(const char* name, const Inside& inside) override {
    json& section = object_[name] = json::object();
    JsonWriter writer(section);
    inside(writer);
  }

  void VisitList(const char* name, std::size_t size, const Element& element) override {
    json& list = object_[name] = json::array();
    for (std::size_t i = 0; i < size; ++i) {
      json& entry = list.emplace_back(json::object());
      JsonWriter writer(entry);
      element(writer, i);
    }
  }

 private:
  json& object_;
};

/// Distance and heading error between car and path at the end of an open-loop run along a stretch.
struct StretchEnd {
  double distance = 0.0;
  double heading_error = 0.0;
};

void Visit(DiagnosticsVisitor& out, const StretchEnd& end) {
  out.Number("end_distance_m", end.distance);
  out.Number("end_heading_error_rad", end.heading_error);
}

}  // namespace

const char* ToString(PassingSide passing_side) {
  return passing_side == PassingSide::kInner ? "inner" : "outer";
}

void Visit(DiagnosticsVisitor& out, const AvoidedStretch& stretch) {
  out.Point("obstacle_m", stretch.obstacle);
  out.Text("passing_side", ToString(stretch.passing_side));
  out.Number("clearance_m", stretch.clearance);
  out.Number("leave_s_m", stretch.stations.from);
  out.Number("return_s_m", stretch.stations.to);
  out.Number("steering_max_rad", stretch.steering_max);
  out.Number("steering_rate_max_radps", stretch.steering_rate_max);
  Visit(out, stretch.method);
  if (out.full()) {
    out.Number("speed_mps", stretch.speed);
    out.Number("length_m", stretch.length);
    out.Number("lateral_acceleration_max_mps2", stretch.lateral_acceleration_max);
    out.Points("control_points_m", stretch.control_points);
    out.Section("open_loop", StretchEnd{stretch.end_distance, stretch.end_heading_error});
  }
}

void Visit(DiagnosticsVisitor& out, const PlannedWait& wait) {
  out.Number("s_m", wait.s);
  out.Number("duration_s", wait.duration);
}

void Visit(DiagnosticsVisitor& out, const Plan& plan) {
  const PlanDiagnostics& own = plan.diagnostics;
  Visit(out, own.planner);
  if (plan.ok() || !own.turns.empty()) {
    out.List("turns", own.turns);
  }
  if (own.corners) {
    out.List("corners", *own.corners);
  }
  if (own.direction_changes) {
    out.Integer("changes_of_direction", *own.direction_changes);
  }
  if (!plan.stops.empty()) {
    out.Numbers("stops_m", plan.stops);
  }
  if (!plan.waits.empty()) {
    out.List("waits", plan.waits);
  }
  if (own.stop_distance) {
    out.Number("stop_distance_m", *own.stop_distance);
  }
  if (own.open_loop) {
    out.Section("open_loop", *own.open_loop);
  }
  if (own.speed_profile) {
    out.Section("speed_profile", *own.speed_profile);
  }
  if (!own.avoided.empty()) {
    out.List("avoid", own.avoided);
  }
  if (own.replan.has_value()) {
    out.Section("replan", own.replan);
  } else if (!plan.blocked.empty()) {
    out.Text("blocked", plan.blocked);
  }
}

json DiagnosticsJson(const Plan& plan) {
  json object = json::object();
  JsonWriter writer(object);
  Visit(writer, plan);
  return object;
}

}  // namespace trackbed
