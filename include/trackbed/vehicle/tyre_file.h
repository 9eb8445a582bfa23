#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trackbed/vehicle/magic_formula.h"

/// Reads tyre property files (*.tir), in which tyre makers and test benches publish the
/// coefficients of the Magic Formula.
namespace trackbed {

/// Largest size of a tyre property file [bytes]; files of tyre makers have about 20 kB.
inline constexpr std::size_t kMaxTyreFileBytes = std::size_t{4} << 20U;
/// Largest number of entries of a tyre property file; files of tyre makers have about 300.
inline constexpr std::size_t kMaxTyreFileEntries = 10000;

/// The tyre that a property file describes, in SI units. The coefficients of a tyre property file
/// are those of a tyre on the left side of the car; a tyre on the right side is its mirror image.
struct TyreFile {
  /// Magic Formula coefficients, already multiplied by the file's scale factors and corrected for
  /// the file's inflation pressure.
  MagicFormula tyre;
  std::optional<double> vertical_stiffness;  ///< Vertical stiffness [N/m], > 0.
  std::optional<double> vertical_damping;    ///< Vertical damping [N s/m], >= 0.
  /// Notes for users on how the file was read, including the ignored entries.
  std::vector<std::string> notes;
};

/// Reads a tyre property file of PAC2002, MF5.0 to MF5.2 or MF6.0 to MF6.2.
///
/// In steady slip, pure or combined and with camber, EvaluateTyreForce returns the forces F_x and
/// F_y of the file. The forces from EvaluateTyreForce agree with the equations of the tyre file at
/// all loads where the friction coefficients and the slip stiffness per load are at least a tenth
/// of their nominal values. The file's relaxation lengths apply at the nominal load; a file of
/// MF6.1 specifies the relaxation lengths by the stiffnesses of the carcass. ReadTyreFile ignores
/// these properties of a tyre: aligning and overturning moments, turn slip, the loaded radius, and
/// the changes of relaxation and rolling resistance with load and speed. The notes list each
/// ignored section and each ignored entry, except entries without effect (an ordinary number 0, a
/// scale factor 1).
///
/// A file has lines `[SECTION]` and `KEY = value`. The value of an entry in a tyre property file is
/// a number or a text in quotes; an empty value counts as missing. Comments in a tyre property file
/// begin with `$` or `!`. Upper and lower case in a tyre property file are equivalent. Lines that
/// begin with `{` and rows of numbers are tables, which are ignored. Lengths, forces, times and
/// angles are converted from the units of the file.
///
/// Errors: throws InputError, with line and key, if the text is malformed, if the file is not of a
/// supported version, or if the file exceeds kMaxTyreFileBytes or kMaxTyreFileEntries. Also throws
/// InputError if a needed coefficient is missing or outside its range, or if a unit is unknown.
/// Throws RunError if the file cannot be read.
TyreFile ReadTyreFile(const std::filesystem::path& file);

/// Reads a tyre property file like ReadTyreFile, but from the text of the file. Error messages use
/// `name` as the name of the file.
TyreFile ParseTyreFile(std::string_view text, const std::string& name);

/// Returns the numbers of the <custom> section of a car's file that describe the tyres `front` and
/// `rear` of the two axles (SceneOptions::tyre_numbers). A number that is equal for both axles has
/// a name without suffix; the names of other numbers end in _front or _rear. TyreNumbers returns
/// the means of both axles' vertical stiffness and damping.
std::vector<std::pair<std::string, double>> TyreNumbers(const TyreFile& front,
                                                        const TyreFile& rear);

}  // namespace trackbed
