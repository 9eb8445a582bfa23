#pragma once

#include <cmath>
#include <optional>

#include "trackbed/drive/run_log.h"

/// Functions that interpolate a quantity of a log. The argument `of` of the interpolating functions
/// is a function that returns the quantity of one log row.
namespace trackbed {

/// Interpolates a quantity of a log linearly between log rows at `time` [s]. Times before the first
/// row yield the value of the first row, and times after the last row yield the value of the last
/// row.
template <typename Of>
double ValueAt(const RunLog& log, double time, const Of& of) {
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const double t = log.rows[i].state.time;
    if (t >= time) {
      const double before = log.rows[i - 1].state.time;
      const double share = time <= before ? 0.0 : (time - before) / (t - before);
      return std::lerp(of(log.rows[i - 1]), of(log.rows[i]), share);
    }
  }
  return of(log.rows.back());
}

/// Returns the first time [s] at or after row `from` at which the quantity of the log is at least
/// `level`. Returns nullopt if the quantity never reaches `level`.
template <typename Of>
std::optional<double> TimeOfReaching(const RunLog& log, std::size_t from, double level,
                                     const Of& of) {
  for (std::size_t i = from; i < log.rows.size(); ++i) {
    const double value = of(log.rows[i]);
    if (value >= level) {
      const double time = log.rows[i].state.time;
      if (i == from) {
        return time;
      }
      const double before = of(log.rows[i - 1]);
      return std::lerp(log.rows[i - 1].state.time, time, (level - before) / (value - before));
    }
  }
  return std::nullopt;
}

}  // namespace trackbed
