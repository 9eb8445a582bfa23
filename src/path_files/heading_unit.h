#pragma once

#include <string>

#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// How a column of headings is read.
struct HeadingReading {
  double offset = 0.0;  ///< Angle to add to the headings [rad]: 0, or pi/2 for angles from north.
  std::string note;     ///< Text: how the headings are measured; may be empty.
  std::string problem;  ///< Why the headings are refused, for the user; empty if accepted.
};

/// Decides from the direction of travel whether headings are measured from the x axis or from
/// north. The headings of `points` are in radians, positive to the left. If the headings fit
/// neither meaning but are degrees or compass headings, HeadingReading::problem states the remedy.
/// If headings fit no common meaning, the function reports a problem for a racing line
/// (`is_racing_line`). In other files, such headings are read as measured from the x axis.
///
/// If `is_unit_known` is false, the heading values may be degrees.
HeadingReading ReadHeadings(const PathPoints& points, bool is_racing_line, bool is_unit_known);

}  // namespace trackbed
