#include "trackbed/control/signal.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns an iterator to the signal's first knot beyond x.
auto Beyond(const std::vector<Vec2>& knots, double x) {
  return std::upper_bound(knots.begin(), knots.end(), x,
                          [](double value, const Vec2& knot) { return value < knot.x(); });
}

}  // namespace

double Signal::At(double x) const {
  TRACKBED_CHECK(!knots.empty(), "a signal without knots has no values");
  const auto after = Beyond(knots, x);
  if (after == knots.begin()) {
    return knots.front().y();
  }
  if (after == knots.end()) {
    return knots.back().y();
  }
  const Vec2& before = *(after - 1);
  const double share = (x - before.x()) / (after->x() - before.x());
  return std::lerp(before.y(), after->y(), share);
}

double Signal::Mean(double from, double to) const {
  if (!(to > from)) {
    return At(from);
  }
  // The trapezoidal rule is exact between two knots, because the signal is linear between knots.
  Vec2 last{from, At(from)};
  double area = 0.0;
  const auto add = [&](const Vec2& next) {
    area += 0.5 * (last.y() + next.y()) * (next.x() - last.x());
    last = next;
  };
  for (auto knot = Beyond(knots, from); knot != knots.end() && knot->x() < to; ++knot) {
    add(*knot);
  }
  add({to, At(to)});
  return area / (to - from);
}

bool Signal::IsStrictlyIncreasing() const {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!knots[i].allFinite() || (i > 0 && knots[i].x() <= knots[i - 1].x())) {
      return false;
    }
  }
  return true;
}

}  // namespace trackbed
