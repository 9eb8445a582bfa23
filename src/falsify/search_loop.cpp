#include "src/falsify/search_loop.h"

namespace trackbed {

void FollowSearch(PointSearch& search, const SearchSpace& space, const RunBatch& run) {
  for (;;) {
    std::vector<UnitPoint> points = search.Ask();
    if (points.empty()) {
      return;
    }
    for (UnitPoint& point : points) {
      point = space.Snap(point);
    }
    const auto values = run(points);
    if (!values) {
      return;
    }
    search.Tell(*values);
  }
}

}  // namespace trackbed
