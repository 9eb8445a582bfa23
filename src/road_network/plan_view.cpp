#include "src/road_network/plan_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

using tinyxml2::XMLElement;

// Bounds of coordinates in the file [m]; northings of UTM are below 1e7.
constexpr Bounds kCoordinate{-1e8, 1e8};
constexpr Bounds kGeometryLength{0.0, 1e6};  // Bounds of the length of a plan view geometry [m].
constexpr Bounds kBend{-1e3, 1e3};           // Bounds of the curvature of a plan view geometry
                                             // [1/m].
/// Largest difference between the start station of a geometry and the end station of the previous
/// geometry [m].
constexpr double kMaxStationGap = 0.1;
/// Length below which a geometry of the plan view is dropped, because such a short geometry is a
/// rounding error of the program that wrote the file [m].
constexpr double kMinGeometryLength = 1e-9;

/// Start pose and length of a geometry in the plan view, such as a line, an arc or a spiral.
struct GeometryPlace {
  Pose2 start;
  double length = 0.0;
};

using Curve = std::variant<Path, ParametricCubic>;

std::optional<Curve> MakeClothoid(const XmlFields& shape, const GeometryPlace& place, double from,
                                  double to) {
  constexpr double kMaxTurn = 1e3;  // [rad]
  if (const double turn = place.length * std::max(std::abs(from), std::abs(to)); turn > kMaxTurn) {
    shape.AddError("",
                   fmt::format("turns by up to {:.4g} rad; must be at most {}", turn, kMaxTurn));
    return std::nullopt;
  }
  return Path(place.start, {{.length = place.length,
                             .curvature = from,
                             .direction = 1,
                             .sharpness = (to - from) / place.length}});
}

std::optional<Curve> ReadParamPoly3(const XmlFields& shape, const GeometryPlace& place) {
  const std::array<double, 4> u{shape.Number("aU"), shape.Number("bU"), shape.Number("cU"),
                                shape.Number("dU")};
  const std::array<double, 4> v{shape.Number("aV"), shape.Number("bV"), shape.Number("cV"),
                                shape.Number("dV")};
  const std::string range = shape.OptionalText("pRange");
  if (!range.empty() && range != "arcLength" && range != "normalized") {
    shape.AddError("pRange", UnknownName(range, {"arcLength", "normalized"}));
    return std::nullopt;
  }
  const auto counts = [](double c) { return std::abs(c) > 1e-12; };
  const bool moves =
      std::any_of(u.begin() + 1, u.end(), counts) || std::any_of(v.begin() + 1, v.end(), counts);
  if (!moves) {
    shape.AddError("", "all coefficients of p are 0: the curve is a point");
    return std::nullopt;
  }
  ParametricCubic curve(u, v, range == "arcLength" ? place.length : 1.0, place.length);
  constexpr double kMaxStretch = 0.1;
  if (std::abs(curve.arc_length() / place.length - 1.0) > kMaxStretch) {
    shape.AddError("", fmt::format("the curve is {:.6g} m long, but its length is {:.6g} m",
                                   curve.arc_length(), place.length));
    return std::nullopt;
  }
  return curve;
}

std::optional<Curve> ReadCurve(const XmlFields& geometry, const GeometryPlace& place) {
  const XMLElement* child = geometry.element().FirstChildElement();
  while (child != nullptr && (std::string_view(child->Name()) == "userData" ||
                              std::string_view(child->Name()) == "include")) {
    child = child->NextSiblingElement();
  }
  if (child == nullptr) {
    geometry.AddError("", "without a shape: <line>, <arc>, <spiral>, <poly3> or <paramPoly3>");
    return std::nullopt;
  }
  const std::string name = child->Name();
  const XmlFields shape(*child, geometry.where() + "." + name, geometry.problems());
  if (name == "line") {
    return MakeClothoid(shape, place, 0.0, 0.0);
  }
  if (name == "arc") {
    const double curvature = shape.Number("curvature", kBend);
    return MakeClothoid(shape, place, curvature, curvature);
  }
  if (name == "spiral") {
    const double from = shape.Number("curvStart", kBend);
    return MakeClothoid(shape, place, from, shape.Number("curvEnd", kBend));
  }
  if (name == "poly3") {
    return ParametricCubic::OverU(
        {shape.Number("a"), shape.Number("b"), shape.Number("c"), shape.Number("d")}, place.length);
  }
  if (name == "paramPoly3") {
    return ReadParamPoly3(shape, place);
  }
  geometry.AddError(
      "", "unknown shape " + UnknownName(name, {"line", "arc", "spiral", "poly3", "paramPoly3"}));
  return std::nullopt;
}

}  // namespace

ReferenceLine ReadPlanView(const XmlFields& road, const Vec2& origin) {
  const XMLElement* plan_view = road.Child("planView");
  if (plan_view == nullptr || plan_view->FirstChildElement("geometry") == nullptr) {
    road.AddError("planView", "missing, or without <geometry>");
    return {};
  }
  std::vector<ReferenceLine::Piece> pieces;
  double end = 0.0;
  bool complete = true;
  ForEachChild(plan_view, "geometry", [&](const XMLElement& element, std::size_t index) {
    const XmlFields fields(element, fmt::format("{}.planView.geometry[{}]", road.where(), index),
                           road.problems());
    const double s = fields.Number("s", kGeometryLength);
    GeometryPlace place;
    place.start = {fields.Number("x", kCoordinate) - origin.x(),
                   fields.Number("y", kCoordinate) - origin.y(), fields.Number("hdg")};
    place.length = fields.Number("length", kGeometryLength);
    if (place.length < kMinGeometryLength) {
      return;
    }
    if (std::abs(s - end) > kMaxStationGap || (!pieces.empty() && s <= pieces.back().s)) {
      fields.AddError("s", fmt::format("{} m, but the geometry before ends at {} m", s, end));
    }
    end = s + place.length;
    if (std::optional<Curve> curve = ReadCurve(fields, place);
        curve && (pieces.empty() || s > pieces.back().s)) {
      pieces.push_back({s, place.length, place.start, *std::move(curve)});
    } else {
      complete = false;
    }
  });
  if (!complete) {
    return {};
  }
  if (pieces.empty()) {
    road.AddError("planView", "all geometries have the length 0");
    return {};
  }
  return ReferenceLine(std::move(pieces));
}

double ReadLength(const XmlFields& road, const ReferenceLine& reference) {
  XmlProblems own(road.problems().file());
  const double length = XmlFields(road.element(), road.where(), own).Number("length", {0.0, 1e6});
  if (reference.pieces().empty() || !road.problems().empty()) {
    road.problems().Append(own);
    return length;
  }
  const ReferenceLine::Piece& last = reference.pieces().back();
  const double end = last.s + last.length;
  if (own.empty() && std::abs(end - length) <= kMaxStationGap) {
    return length;
  }
  if (own.empty()) {
    own.Add(road.line(), road.where() + ".length",
            fmt::format("{} m, but its last geometry ends at {} m", length, end));
  }
  road.problems().AddFlaw(fmt::format("{}; the road is read up to {} m", own.First(), end));
  return end;
}

}  // namespace trackbed
