#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/analysis/verdict.h"
#include "trackbed/core/table.h"
#include "trackbed/scenario/log_columns.h"
#include "trackbed/scenario/scenario.h"

/// Writes the local origin of a run into the run's results (docs/conventions.md).
namespace trackbed {

/// Returns the table with two more columns for the local origin of its positions. Returns the table
/// unchanged if the origin is (0, 0).
inline Table WithOrigin(const Table& table, const Vec2& origin) {
  if (origin == Vec2::Zero()) {
    return table;
  }
  std::vector<std::string> columns = table.columns();
  columns.insert(columns.end(), kOriginColumns.begin(), kOriginColumns.end());
  Table stated(std::move(columns));
  std::vector<double> cells;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    cells.clear();
    for (std::size_t column = 0; column < table.columns().size(); ++column) {
      cells.push_back(table.at(row, column));
    }
    cells.insert(cells.end(), {origin.x(), origin.y()});
    stated.AddRow(cells);
  }
  return stated;
}

/// Adds a note to the verdict that states the scenario's local origin, unless it is (0, 0).
inline void NoteOrigin(const Scenario& scenario, Verdict& verdict) {
  if (const Vec2 origin = OriginOf(scenario); origin != Vec2::Zero()) {
    verdict.notes.push_back(
        fmt::format("local origin ({}, {}) m: positions in messages, plan, log and pictures count "
                    "from it",
                    origin.x(), origin.y()));
  }
}

/// Returns the local origin as JSON: x and y [m].
inline nlohmann::ordered_json OriginJson(const Vec2& origin) {
  return nlohmann::ordered_json::array({origin.x(), origin.y()});
}

}  // namespace trackbed
