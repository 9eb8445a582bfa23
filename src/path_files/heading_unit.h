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

/// How certain the unit of a column of headings is.
enum class HeadingUnit {
  kUnknown,       ///< Neither the user nor the column's name gives the unit.
  kNamedRadians,  ///< The column's name ends with "_rad"; the numbers may be degrees anyway.
  kGiven,         ///< The user gives the unit, or the column's name names degrees.
};

/// Decides from the direction of travel whether headings are measured from the x axis or from
/// north. The headings of `points` are in radians, positive to the left. If the headings fit
/// neither meaning but are degrees or compass headings, HeadingReading::problem states the remedy.
/// If headings fit no common meaning, the function reports a problem for a racing line
/// (`is_racing_line`). In other files, such headings are read as measured from the x axis.
///
/// If the unit is unknown, the heading values may be degrees. In a column that is named in radians,
/// only values beyond a whole turn may be degrees.
HeadingReading ReadHeadings(const PathPoints& points, bool is_racing_line, HeadingUnit unit);

}  // namespace trackbed
