#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "src/vehicle/tyre_file_entries.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/tyre_file.h"

namespace trackbed {

struct TyreUnit;

/// Reads the entries of a tyre property file into a tyre.
class TyreFileReader {
 public:
  /// Splits the text of a tyre property file into entries. `name` is the file's name in messages,
  /// and must outlive the reader.
  /// The constructor throws InputError if a line is malformed.
  TyreFileReader(std::string_view text, const std::string& name);

  /// Returns the tyre. Throws InputError in the same cases as ReadTyreFile. Call Read
  /// once.
  TyreFile Read();

 private:
  using Field = double MagicFormula::*;

  void Fail(const TyreFileEntry* entry, const std::string& key, std::string message);
  void Note(std::string_view note) { result_.notes.emplace_back(note); }

  /// Returns the entry of a key in the tyre file; null if the file has no such entry. Adds a
  /// problem if the tyre file has the key twice with different values.
  const TyreFileEntry* Find(const std::string& key);
  std::optional<double> Number(const std::string& key);
  /// Returns the scale factor that the file gives under one of the names; 1 if the file has none of
  /// the names. Adds a problem if the scale factor in the file is below 0.
  double Factor(std::initializer_list<const char*> names);
  void Multiply(double factor, std::initializer_list<Field> fields);

  void CheckType();
  double FindVersion();
  double VersionOfFormat(const TyreFileEntry& entry);
  double VersionOfFit(const TyreFileEntry& entry);
  double Unit(const char* key, const std::vector<TyreUnit>& units);
  void ReadUnits();
  void ReadCoefficients();
  void ReadLoadAndCamber();
  void NormalizeSigns();
  void CheckCoefficients();
  void ApplyScaleFactors();
  void ApplyPressure();
  void ReadRelaxation();
  void ReadVertical();
  void ReadRollingResistance();
  void ApplySide();
  void CheckResult();
  void NoteIgnored();

  [[nodiscard]] bool is_6() const { return result_.tyre.version >= 6.0; }

  const std::string& name_;
  ProblemList problems_;
  std::vector<TyreFileEntry> entries_;
  std::map<std::string, std::vector<const TyreFileEntry*>> by_key_;
  std::set<const TyreFileEntry*> used_;
  TyreFile result_;
  double length_ = 1.0;  // Unit of length [m].
  double force_ = 1.0;   // Unit of force [N].
  double angle_ = 1.0;   // Unit of angles [rad].
  double time_ = 1.0;    // Unit of time [s].
  double load_scale_ = 1.0;
};

}  // namespace trackbed
