#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "src/vehicle/tyre_file_reader.h"
#include "trackbed/core/file.h"

// Reads a tyre property file in four steps. First, the file is split into entries. Next, the
// version of the Magic Formula is determined from PROPERTY_FILE_FORMAT, FITTYP or, without both,
// from the coefficients. The coefficients are then multiplied by the scale factors and inflation
// pressure factors of this version (Adams/Tire's PAC2002; Pacejka 2012, section 4.3.2). Finally, a
// tyre of the right side is mirrored. A note lists the file entries that no step has used.
namespace trackbed {

struct TyreUnit {
  const char* name;
  double factor;
};

namespace {

const std::vector<TyreUnit>& LengthUnits() {
  static const std::vector<TyreUnit> units{
      {"METER", 1.0},   {"METERS", 1.0},      {"METRE", 1.0},   {"M", 1.0},
      {"MM", 1e-3},     {"MILLIMETER", 1e-3}, {"CM", 1e-2},     {"CENTIMETER", 1e-2},
      {"KM", 1e3},      {"KILOMETER", 1e3},   {"INCH", 0.0254}, {"IN", 0.0254},
      {"FOOT", 0.3048}, {"FT", 0.3048},       {"FEET", 0.3048}};
  return units;
}

const std::vector<TyreUnit>& ForceUnits() {
  static const std::vector<TyreUnit> units{{"NEWTON", 1.0},
                                           {"NEWTONS", 1.0},
                                           {"N", 1.0},
                                           {"KNEWTON", 1e3},
                                           {"KILONEWTON", 1e3},
                                           {"KN", 1e3},
                                           {"POUND_FORCE", 4.4482216152605},
                                           {"LBF", 4.4482216152605},
                                           {"KG_FORCE", 9.80665},
                                           {"KILOGRAM_FORCE", 9.80665},
                                           {"KGF", 9.80665},
                                           {"DYNE", 1e-5}};
  return units;
}

const std::vector<TyreUnit>& AngleUnits() {
  static const std::vector<TyreUnit> units{{"RADIANS", 1.0},
                                           {"RADIAN", 1.0},
                                           {"RAD", 1.0},
                                           {"DEGREES", std::numbers::pi / 180.0},
                                           {"DEGREE", std::numbers::pi / 180.0},
                                           {"DEG", std::numbers::pi / 180.0}};
  return units;
}

const std::vector<TyreUnit>& TimeUnits() {
  static const std::vector<TyreUnit> units{
      {"SECOND", 1.0},       {"SECONDS", 1.0}, {"SEC", 1.0},  {"S", 1.0},      {"MS", 1e-3},
      {"MILLISECOND", 1e-3}, {"MINUTE", 60.0}, {"MIN", 60.0}, {"HOUR", 3600.0}};
  return units;
}

}  // namespace

TyreFileReader::TyreFileReader(std::string_view text, const std::string& name)
    : name_(name), entries_(SplitTyreFile(text, name, problems_)) {
  problems_.ThrowIfAny();
  for (const TyreFileEntry& entry : entries_) {
    // In a tyre property file, a unit and a quantity may have the same key, such as MASS.
    by_key_[entry.section == "UNITS" ? "UNITS " + entry.key : entry.key].push_back(&entry);
  }
}

TyreFile TyreFileReader::Read() {
  CheckType();
  result_.tyre.version = FindVersion();
  ReadUnits();
  problems_.ThrowIfAny();
  ReadCoefficients();
  ReadLoadAndCamber();
  problems_.ThrowIfAny();
  NormalizeSigns();
  CheckCoefficients();
  problems_.ThrowIfAny();
  ApplyScaleFactors();
  ApplyPressure();
  ReadRelaxation();
  ReadVertical();
  ReadRollingResistance();
  ApplySide();
  CheckResult();
  problems_.ThrowIfAny();
  NoteIgnored();
  return std::move(result_);
}

void TyreFileReader::Fail(const TyreFileEntry* entry, const std::string& key, std::string message) {
  problems_.Add({.file = name_,
                 .line = entry == nullptr ? 0 : entry->line,
                 .key = key,
                 .message = std::move(message)});
}

const TyreFileEntry* TyreFileReader::Find(const std::string& key) {
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) {
    return nullptr;
  }
  const std::vector<const TyreFileEntry*>& same = found->second;
  used_.insert(same.begin(), same.end());
  for (const TyreFileEntry* other : same) {
    if (other->number != same.front()->number ||
        (!other->number && other->text != same.front()->text)) {
      Fail(other, key,
           fmt::format("is {} here and {} on line {}; remove one", other->text, same.front()->text,
                       same.front()->line));
      break;
    }
  }
  return same.front();
}

std::optional<double> TyreFileReader::Number(const std::string& key) {
  const TyreFileEntry* entry = Find(key);
  if (entry == nullptr) {
    return std::nullopt;
  }
  if (!entry->number) {
    Fail(entry, key, fmt::format("'{}' is not a finite number", entry->text));
  }
  return entry->number;
}

double TyreFileReader::Factor(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const std::optional<double> number = Number(name)) {
      if (*number < 0.0) {
        Fail(Find(name), name, fmt::format("{} must be at least 0", *number));
      }
      return *number;
    }
  }
  return 1.0;
}

void TyreFileReader::Multiply(double factor, std::initializer_list<Field> fields) {
  for (const Field field : fields) {
    result_.tyre.*field *= factor;
  }
}

void TyreFileReader::CheckType() {
  const TyreFileEntry* type = Find("FILE_TYPE");
  if (type != nullptr && InCapitals(type->text) != "TIR") {
    Fail(type, "FILE_TYPE",
         fmt::format("'{}' is not a tyre property file; must be 'tir'", type->text));
  }
  for (const char* key : {"FILE_VERSION", "FILE_FORMAT", "TYPE", "COMMENT"}) {
    static_cast<void>(Find(key));
  }
  if (entries_.empty()) {
    Fail(nullptr, "", "has no entries; a tyre property file has lines such as PCX1 = 1.6");
  }
}

/// Returns the version that PROPERTY_FILE_FORMAT states; 0 if the format does not determine the
/// version.
double TyreFileReader::VersionOfFormat(const TyreFileEntry& entry) {
  const std::string format = InCapitals(entry.text);
  static const std::map<std::string, double> versions{
      {"PAC2002", 5.2}, {"MF_05", 5.2}, {"MF-05", 5.2},           {"MF05", 5.2},
      {"MF_52", 5.2},   {"MF52", 5.2},  {"MF5.2", 5.2},           {"MF-TYRE", 0.0},
      {"MF_TYRE", 0.0}, {"USER", 0.0},  {"MF_SWIFT", 0.0},        {"MF-SWIFT", 0.0},
      {"MF_61", 6.1},   {"MF61", 6.1},  {"MF6.1", 6.1},           {"MF_62", 6.1},
      {"MF62", 6.1},    {"MF6.2", 6.1}, {"MF-TYRE/MF-SWIFT", 0.0}};
  const auto found = versions.find(format);
  if (found == versions.end()) {
    Fail(&entry, "PROPERTY_FILE_FORMAT",
         fmt::format("'{}' has other equations; supported are PAC2002, MF5.0 to MF5.2 ('MF_05') "
                     "and MF6.0 to MF6.2 ('MF_61')",
                     entry.text));
    return 5.2;
  }
  return found->second;
}

double TyreFileReader::VersionOfFit(const TyreFileEntry& entry) {
  const double fit = entry.number.value_or(0.0);
  if (fit == 5.0 || fit == 6.0 || fit == 52.0) {
    return 5.2;
  }
  if (fit == 60.0 || fit == 61.0 || fit == 62.0) {
    return 6.1;
  }
  Fail(&entry, "FITTYP",
       fmt::format("{} has other equations; supported are 5, 6 and 52 (MF5.0 to MF5.2), and 60, 61 "
                   "and 62 (MF6.0 to MF6.2)",
                   entry.text));
  return 5.2;
}

double TyreFileReader::FindVersion() {
  const TyreFileEntry* format = Find("PROPERTY_FILE_FORMAT");
  const TyreFileEntry* fit = Find("FITTYP");
  if (const TyreFileEntry* leaning = Find("PCY2")) {
    Fail(leaning, "PCY2",
         "belongs to the formula of motorcycle tyres, which is not supported; must be a file of "
         "PAC2002, MF5.2 or MF6.1");
  }
  const double stated = format == nullptr ? 0.0 : VersionOfFormat(*format);
  const double fitted = fit == nullptr ? 0.0 : VersionOfFit(*fit);
  if (stated != 0.0 && fitted != 0.0 && stated != fitted) {
    Fail(fit, "FITTYP",
         fmt::format("{} contradicts PROPERTY_FILE_FORMAT '{}' on line {}; remove the wrong one",
                     fit->text, format->text, format->line));
  }
  if (fitted != 0.0 || stated != 0.0) {
    const double version = fitted != 0.0 ? fitted : stated;
    Note(fmt::format("read as {} ({})", version == 5.2 ? "PAC2002 or MF5.2" : "MF6.1",
                     fitted != 0.0 ? "FITTYP " + fit->text : format->text));
    return version;
  }
  const bool has_6 = by_key_.count("PKY6") > 0 || by_key_.count("PPY1") > 0;
  Note(fmt::format("states no version; read as {}, because it has {} PKY6 or PPY1",
                   has_6 ? "MF6.1" : "PAC2002 or MF5.2", has_6 ? "" : "no"));
  return has_6 ? 6.1 : 5.2;
}

double TyreFileReader::Unit(const char* key, const std::vector<TyreUnit>& units) {
  const TyreFileEntry* entry = Find(fmt::format("UNITS {}", key));
  if (entry == nullptr) {
    return 1.0;
  }
  const std::string name = InCapitals(entry->text);
  for (const TyreUnit& unit : units) {
    if (name == unit.name) {
      return unit.factor;
    }
  }
  std::vector<std::string> names;
  for (const TyreUnit& unit : units) {
    names.emplace_back(unit.name);
  }
  Fail(entry, key,
       fmt::format("unknown unit '{}'; allowed: {}", entry->text, fmt::join(names, ", ")));
  return 1.0;
}

void TyreFileReader::ReadUnits() {
  length_ = Unit("LENGTH", LengthUnits());
  force_ = Unit("FORCE", ForceUnits());
  angle_ = Unit("ANGLE", AngleUnits());
  time_ = Unit("TIME", TimeUnits());
  for (const char* key : {"UNITS MASS", "UNITS PRESSURE"}) {
    static_cast<void>(Find(key));
  }
}

/// Adds a note that lists the unused entries of the tyre file by section. The note on unused
/// entries leaves out entries whose values have no effect.
void TyreFileReader::NoteIgnored() {
  const MagicFormula& tyre = result_.tyre;
  if (tyre.r_bx1 == 0.0 && tyre.r_by1 == 0.0) {
    Note(
        "has no coefficients of combined slip (RBX1, RBY1); combined forces are scaled to the "
        "friction ellipse");
  }
  std::vector<std::string> sections;  // in the order of the file
  std::map<std::string, std::vector<std::string>> ignored;
  std::map<std::string, bool> is_partial;
  for (const TyreFileEntry& entry : entries_) {
    const bool is_used = used_.count(&entry) > 0;
    is_partial[entry.section] = is_partial[entry.section] || is_used;
    const bool is_scale = entry.section.starts_with("SCALING");
    if (is_used || entry.number == (is_scale ? 1.0 : 0.0) || entry.section == "MDI_HEADER") {
      continue;
    }
    std::vector<std::string>& keys = ignored[entry.section];
    if (keys.empty()) {
      sections.push_back(entry.section);
    }
    keys.push_back(entry.key);
  }
  std::string list;
  constexpr std::size_t kMaxNote = 3000;  // longest list [bytes]
  for (const std::string& section : sections) {
    list += fmt::format(
        "{}[{}]{}", list.empty() ? "" : "; ", section,
        is_partial[section] ? fmt::format(" {}", fmt::join(ignored[section], ", ")) : "");
    if (list.size() > kMaxNote) {
      list.resize(kMaxNote);
      list += "...";
      break;
    }
  }
  if (!list.empty()) {
    Note("ignored: " + list);
  }
}

TyreFile ParseTyreFile(std::string_view text, const std::string& name) {
  return TyreFileReader(text, name).Read();
}

TyreFile ReadTyreFile(const std::filesystem::path& file) {
  return ParseTyreFile(ReadFile(file, kMaxTyreFileBytes), file.string());
}

std::vector<std::pair<std::string, double>> TyreNumbers(const TyreFile& front,
                                                        const TyreFile& rear) {
  std::vector<std::pair<std::string, double>> numbers;
  const MagicFormula plain;
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    const double ahead = front.tyre.*field.value;
    const double behind = rear.tyre.*field.value;
    if (ahead == behind) {
      if (field.required || ahead != plain.*field.value) {
        numbers.emplace_back(field.name, ahead);
      }
    } else {
      numbers.emplace_back(fmt::format("{}_front", field.name), ahead);
      numbers.emplace_back(fmt::format("{}_rear", field.name), behind);
    }
  }
  const auto add = [&](const char* name, std::optional<double> a, std::optional<double> b) {
    if (a || b) {
      numbers.emplace_back(name, 0.5 * (a.value_or(b.value_or(0.0)) + b.value_or(a.value_or(0.0))));
    }
  };
  add("tyre_vertical_stiffness", front.vertical_stiffness, rear.vertical_stiffness);
  add("tyre_vertical_damping", front.vertical_damping, rear.vertical_damping);
  return numbers;
}

}  // namespace trackbed
