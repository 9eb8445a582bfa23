// Calls of the public functions of geometry and paths.

#include <cmath>

#include "tests/properties/entries.h"
#include "trackbed/core/angle.h"
#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/bezier.h"
#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/reference.h"
#include "trackbed/path/smooth_curvature.h"

namespace properties {

using namespace trackbed;

const Path& Bend() {
  static const Path path({}, {{.length = 20.0},
                              {.length = 10.0, .curvature = 0.0, .sharpness = 0.01},
                              {.length = 15.0, .curvature = 0.1}});
  return path;
}

std::vector<Entry> OfGeometry() {
  return {
      {"WrapAngle", [](double x) { return WrapAngle(x); }},
      {"AngleDifference", [](double x) { return AngleDifference(1.0, x); }},
      {"Direction", [](double x) { return SumOf(Direction(x)); }},
      {"Compose",
       [](double x) {
         return SumOf(Compose({x, 0.0, 0.0}, {1.0, 0.0, 0.0}));
       }},
      {"ToWorld",
       [](double x) {
         return SumOf(ToWorld({0.0, 0.0, x}, {1.0, 0.0}));
       }},
      {"ToLocal",
       [](double x) {
         return SumOf(ToLocal({0.0, x, 0.0}, {1.0, 0.0}));
       }},
      {"MoveOnArc distance", [](double x) { return SumOf(MoveOnArc({}, x, 1.0)); }},
      {"MoveOnArc turn", [](double x) { return SumOf(MoveOnArc({}, 1.0, x)); }},
      {"Contains",
       [](double x) {
         return Contains(kBox, {x, 2.0}) ? kWell : kNone;
       }},
      {"Separation place",
       [](double x) {
         return Separation(kBox, {{x, 0.0, 0.0}, 1.0, 1.0});
       }},
      {"Separation yaw",
       [](double x) {
         return Separation(kBox, {{9.0, 0.0, x}, 1.0, 1.0});
       }},
      {"Separation size",
       [](double x) {
         return Separation(kBox, {{9.0, 0.0, 0.0}, x, 1.0});
       }},
      {"Distance",
       [](double x) {
         return Distance(kBox, {{x, 0.0, 0.0}, 1.0, 1.0});
       }},
      {"Distance of a line",
       [](double x) {
         return Distance({9.0, x}, {9.0, 2.0}, kBox);
       }},
      {"Distance width",
       [](double x) {
         return Distance({9.0, 0.0}, {9.0, 2.0}, {{}, 1.0, x});
       }},
  };
}

std::vector<Entry> OfPaths() {
  return {
      {"Path start",
       [](double x) {
         return Path({x, 0.0, 0.0}, {{.length = 1.0}}).length();
       }},
      {"Path length", [](double x) { return Path({}, {{.length = x}}).length(); }},
      {"Path curvature",
       [](double x) { return Path({}, {{.length = 1.0, .curvature = x}}).length(); }},
      {"Path sharpness",
       [](double x) {
         return Path({}, {{.length = 1.0, .curvature = 0.0, .direction = 1, .sharpness = x}})
             .length();
       }},
      {"Path::At", [](double x) { return SumOf(Bend().At(x).pose); }},
      {"Path::BendAt", [](double x) { return Bend().BendAt(x).curvature; }},
      {"Path::BendAt of an arc",
       [](double x) {
         return Path({}, {{1.0, 0.2, 1}}).BendAt(x).curvature;
       }},
      {"Path::Project x",
       [](double x) {
         return Bend().Project({x, 0.0, 0.0}).s;
       }},
      {"Path::Project yaw",
       [](double x) {
         return Bend().Project({1.0, 0.0, x}).s;
       }},
      {"Path::Project from",
       [](double x) {
         return Bend().Project({1.0, 0.0, 0.0}, {x, 3.0}).s;
       }},
      {"Path::Sample", [](double x) { return static_cast<double>(Bend().Sample(x).size()); }},
      {"Path::Cut from",
       [](double x) {
         return static_cast<double>(Bend().Cut({x, 30.0}).size());
       }},
      {"Path::Cut to",
       [](double x) {
         return static_cast<double>(Bend().Cut({0.0, x}).size());
       }},
      {"SplitIntoLegs",
       [](double x) {
         return static_cast<double>(SplitIntoLegs(Bend(), {x, 2.0}).size());
       }},
      {"SegmentsThrough s",
       [](double x) {
         return SegmentsThrough({{}, {x, 0.0, 0.0}}).front().length;
       }},
      {"SegmentsThrough yaw",
       [](double x) {
         return SegmentsThrough({{}, {1.0, x, 0.0}}).front().sharpness;
       }},
  };
}

std::vector<Entry> OfSpeeds() {
  const SpeedLimits limits{3.0, 1.0, 1.5};
  return {
      {"SpeedProfile s",
       [](double x) {
         return SpeedProfile({{x, 1.0}}).knots().front().speed;
       }},
      {"SpeedProfile speed",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, x}}).knots().front().speed;
       }},
      {"SpeedAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).SpeedAt(x);
       }},
      {"AccelerationAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).AccelerationAt(x);
       }},
      {"TimeAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).TimeAt(x);
       }},
      {"StationAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).StationAt(x);
       }},
      {"StopAtEnd length",
       [=](double x) { return StopAtEnd(x, 1.0, limits).knots().back().speed; }},
      {"StopAtEnd start speed",
       [=](double x) { return StopAtEnd(20.0, x, limits).knots().back().speed; }},
      {"StopAtEnd speed",
       [](double x) {
         return StopAtEnd(20.0, 1.0, {x, 1.0, 1.0}).knots().back().speed;
       }},
      {"StopAtEnd acceleration",
       [](double x) {
         return StopAtEnd(20.0, 1.0, {3.0, x, 1.0}).knots().back().speed;
       }},
      {"StopAtEnd deceleration",
       [](double x) {
         return StopAtEnd(20.0, 1.0, {3.0, 1.0, x}).knots().back().speed;
       }},
      {"StopAtEnd cap",
       [=](double x) {
         return StopAtEnd(20.0, 1.0, limits, {{5.0, 10.0, x}}).knots().back().speed;
       }},
      {"StopAtEnd cap from",
       [=](double x) {
         return StopAtEnd(20.0, 1.0, limits, {{x, 10.0, 1.0}}).knots().back().speed;
       }},
      {"StopAtCusps stop",
       [=](double x) { return StopAtCusps(Bend(), 1.0, limits, {}, {x}).knots().back().speed; }},
      {"Excerpt",
       [](double x) {
         return Excerpt(SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}), {x, 1.0}).knots().back().s;
       }},
  };
}

std::vector<Entry> OfCurves() {
  return {
      {"SmoothCurvature", [](double x) { return SmoothCurvature(Bend(), x).length(); }},
      {"Bezier point",
       [](double x) {
         return BezierCurve({{0.0, x}, {1.0, 0.0}}).Length();
       }},
      {"Bezier spacing",
       [](double x) {
         return BezierCurve({{0.0, 0.0}, {1.0, 0.0}}).Points(x, 0.0).back().s;
       }},
      {"Bezier At",
       [](double x) {
         return SumOf(BezierCurve({{0.0, 0.0}, {1.0, 0.0}}).At(x));
       }},
      {"ToFrenet",
       [](double x) {
         const auto state = ToFrenet(Bend(), {.pose = {x, 0.0, 0.0}});
         return state ? state->d : kNone;
       }},
      {"ToFrenet speed",
       [](double x) {
         const auto state = ToFrenet(Bend(), {.pose = {}, .speed = x});
         return state ? state->s_rate : kNone;
       }},
      {"FromFrenet",
       [](double x) {
         const auto motion = FromFrenet(Bend(), {.s = 1.0, .d = x});
         return motion ? SumOf(motion->pose) : kNone;
       }},
      {"FromFrenet s",
       [](double x) {
         const auto motion = FromFrenet(Bend(), {.s = x});
         return motion ? SumOf(motion->pose) : kNone;
       }},
  };
}

}  // namespace properties
