// Lists the grid points that the searches of `trackbed falsify` propose. A table provides the
// result of a run at each point: scripts/falsification.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <exception>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "src/falsify/point_search.h"
#include "src/falsify/search_loop.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/falsify/falsify.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {
namespace {

/// The robustness at each point of a grid.
class Grid {
 public:
  Grid(const SearchSpace& space, const std::string& file) : space_(space) {
    const TextTable table = ReadTextCsv(file);
    const std::size_t keys = space.keys().size();
    const std::size_t column = ColumnOf(table, "robustness");
    for (std::size_t row = 0; row < table.rows().size(); ++row) {
      std::vector<long> steps;
      for (std::size_t i = 0; i < keys; ++i) {
        const SearchKey& key = space.keys()[i];
        const double value =
            CellNumber(table.rows()[row][ColumnOf(table, key.key)]).value_or(std::nan(""));
        steps.push_back(std::lround((value - key.from) / key.step));
      }
      points_[steps] = {row, CellNumber(table.rows()[row][column])};
    }
  }

  struct Point {
    std::size_t row = 0;
    std::optional<double> robustness;
  };

  [[nodiscard]] const Point& At(const UnitPoint& point) const {
    std::vector<long> steps;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const SearchKey& key = space_.keys()[i];
      steps.push_back(std::lround((space_.Value(i, point[i]) - key.from) / key.step));
    }
    const auto found = points_.find(steps);
    if (found == points_.end()) {
      throw RunError(fmt::format("the grid has no point at the steps {}", steps));
    }
    return found->second;
  }

  [[nodiscard]] std::size_t size() const { return points_.size(); }

 private:
  static std::size_t ColumnOf(const TextTable& table, const std::string& name) {
    for (std::size_t i = 0; i < table.columns().size(); ++i) {
      if (table.columns()[i] == name) {
        return i;
      }
    }
    throw RunError("the grid has no column " + name);
  }

  const SearchSpace& space_;
  std::map<std::vector<long>, Point> points_;
};

/// The rows of the grid in the order in which a search runs them, beginning with the nominal point.
std::vector<std::size_t> RowsOf(const SearchSpec& spec, const SearchSpace& space, const Grid& grid,
                                std::size_t most) {
  const Grid::Point& nominal = grid.At(space.nominal());
  std::vector<std::size_t> rows{nominal.row};
  std::set<std::size_t> known{nominal.row};
  const auto search = MakePointSearch(spec, space, nominal.robustness);
  FollowSearch(*search, space, [&](const std::vector<UnitPoint>& points) {
    std::optional<std::vector<std::optional<double>>> values(std::in_place);
    bool ends = false;
    for (const UnitPoint& point : points) {
      const Grid::Point& here = grid.At(point);
      if (known.insert(here.row).second) {
        rows.push_back(here.row);
      }
      values->push_back(here.robustness);
      ends = ends || rows.size() >= most || (spec.stop && here.robustness.value_or(1.0) < 0.0);
    }
    return ends ? std::nullopt : std::move(values);
  });
  return rows;
}

int Main(int count, char** arguments) {
  if (count != 5) {
    fmt::print(stderr,
               "usage: trackbed_falsification STUDY.yaml GRID.csv METHOD[,METHOD]... SEEDS\n");
    return 2;
  }
  const CheckedSearch search = CheckSearch(ReadStudy(arguments[1], {}, PossibleMetrics));
  for (const SearchKey& key : search.space.keys()) {
    if (key.step <= 0.0) {
      throw RunError(fmt::format("{} has no step", key.key));
    }
  }
  const Grid grid(search.space, arguments[2]);
  const int seeds = std::stoi(arguments[4]);
  fmt::print("method,stop,seed,rows\n");
  const std::string methods = std::string(arguments[3]) + ",";
  for (std::size_t at = 0; at < methods.size(); at = methods.find(',', at) + 1) {
    SearchSpec spec = *search.study.search;
    spec.method = methods.substr(at, methods.find(',', at) - at);
    spec.restarts = 0;
    spec.population = 0;
    spec.finish = "none";
    for (const bool stop : {true, false}) {
      spec.stop = stop;
      // A search that stops at the first violation may use as many runs as it needs.
      const std::size_t most = stop ? grid.size() : grid.size() / 10;
      spec.runs = static_cast<int>(most);
      for (int seed = 1; seed <= seeds; ++seed) {
        spec.seed = static_cast<std::uint64_t>(seed);
        fmt::print("{},{},{},{}\n", spec.method, stop ? 1 : 0, seed,
                   fmt::join(RowsOf(spec, search.space, grid, most), " "));
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace trackbed

int main(int count, char** arguments) {
  try {
    return trackbed::Main(count, arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
