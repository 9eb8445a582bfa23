#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "src/vehicle/tyre_file_reader.h"

// Takes the Magic Formula coefficients from a tyre property file.
// 1. ReadCoefficients copies the coefficients by their names, such as PCX1 to p_cx1, and lists
//    missing coefficients.
// 2. NormalizeSigns corrects pairs of coefficients that some files give with both signs reversed.
//    Reversing both signs of such a pair does not change the tyre forces.
// 3. ApplyScaleFactors and ApplyPressure fold scale factors and the change of pressure into the
//    coefficients.
// 4. ApplySide mirrors the coefficients of a tyre measured on the right side.
// 5. CheckResult rejects coefficients that are out of range, and tyres whose stiffness or friction
//    at the nominal load is not positive.
// Source: Pacejka 2012, sections 4.3.2 and 4.3.3.
namespace trackbed {
namespace {

using M = MagicFormula;

/// Returns the key of a coefficient in a tyre property file, such as PCX1 for p_cx1.
std::string KeyOf(const char* field) {
  std::string key = InCapitals(field);
  key.erase(std::remove(key.begin(), key.end(), '_'), key.end());
  return key;
}

/// Whether a field is a coefficient of the Magic Formula, whose key in tyre property files follows
/// from the name of the field (KeyOf).
bool IsCoefficient(const MagicFormulaField& field) {
  return field.name[1] == '_' && (field.name[0] == 'p' || field.name[0] == 'r');
}

/// Whether only version 6.1 of the Magic Formula has the coefficient.
bool IsOfVersion6(double M::*field) {
  static const std::initializer_list<double M::*> fields{&M::p_ey5, &M::p_ky4, &M::p_ky5, &M::p_ky6,
                                                         &M::p_ky7, &M::r_bx3, &M::r_by4};
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

/// Returns the factor lambda' by which the vertical shifts of the force curves change with the
/// friction (Pacejka 2012, equation 4.E8).
double DigressiveFriction(double scale) {
  constexpr double kAMu = 10.0;
  return kAMu * scale / (1.0 + (kAMu - 1.0) * scale);
}

}  // namespace

void TyreFileReader::ReadCoefficients() {
  std::vector<std::string> missing;
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    const bool is_unused =
        (!is_6() && IsOfVersion6(field.value)) || (is_6() && field.value == &M::p_hy3);
    if (!IsCoefficient(field) || is_unused) {
      continue;
    }
    const std::string key = KeyOf(field.name);
    const std::optional<double> number = Number(key);
    result_.tyre.*field.value = number.value_or(result_.tyre.*field.value);
    if (!number && by_key_.count(key) == 0 && (field.required || field.value == &M::p_ky2)) {
      missing.push_back(key);
    }
  }
  if (by_key_.count("FNOMIN") == 0) {
    missing.emplace_back("FNOMIN");
  }
  if (!missing.empty()) {
    Fail(nullptr, fmt::format("{}", fmt::join(missing, ", ")),
         "missing; a tyre needs PCX1, PDX1, PKX1, PCY1, PDY1, PKY1, PKY2 and FNOMIN");
  }
}

void TyreFileReader::ReadLoadAndCamber() {
  load_scale_ = Factor({"LFZO", "LFZ0"});
  const double nominal = Number("FNOMIN").value_or(1.0);
  if (!(nominal > 0.0) || !(load_scale_ > 0.0)) {
    Fail(Find("FNOMIN"), "FNOMIN",
         fmt::format("the nominal load {} and its scale factor LFZO {} must be above 0", nominal,
                     load_scale_));
  }
  result_.tyre.f_z0 = nominal * force_ * load_scale_;
  const double low = Number("CAMMIN").value_or(0.0);
  const double high = Number("CAMMAX").value_or(0.0);
  if (const double most = std::max(std::abs(low), std::abs(high)) * angle_; most > 0.0) {
    result_.tyre.camber_max = most;
  }
}

/// Some files give pairs of coefficients with both signs reversed. Reversing both signs leaves the
/// tyre forces unchanged, because F = D sin(C atan(K/(C D) slip)) is even in D, and sin(2
/// atan(F_z/(p_ky2 F_z0))) is odd in p_ky2.
void TyreFileReader::NormalizeSigns() {
  MagicFormula& tyre = result_.tyre;
  if (tyre.p_dx1 < 0.0) {
    Multiply(-1.0, {&M::p_dx1, &M::p_dx2});
  }
  if (tyre.p_dy1 < 0.0) {
    Multiply(-1.0, {&M::p_dy1, &M::p_dy2, &M::r_vy1, &M::r_vy2, &M::r_vy3});
  }
  if (tyre.p_ky2 < 0.0) {
    Multiply(-1.0, {&M::p_ky1, &M::p_ky2, &M::p_ky5});
  }
}

void TyreFileReader::CheckCoefficients() {
  const MagicFormula& tyre = result_.tyre;
  const auto need = [&](bool holds, const char* key, double found, const char* what) {
    if (!holds) {
      Fail(Find(key), key, fmt::format("{} must be {}", found, what));
    }
  };
  need(tyre.p_cx1 > 0.0, "PCX1", tyre.p_cx1, "above 0");
  need(tyre.p_dx1 > 0.0, "PDX1", tyre.p_dx1, "above 0");
  need(tyre.p_kx1 > 0.0, "PKX1", tyre.p_kx1,
       "above 0; a file that was fitted to side forces alone needs longitudinal coefficients");
  need(tyre.p_cy1 > 0.0, "PCY1", tyre.p_cy1, "above 0");
  need(tyre.p_dy1 > 0.0, "PDY1", tyre.p_dy1, "other than 0");
  need(tyre.p_ky1 < 0.0, "PKY1", tyre.p_ky1,
       "below 0 in the axes of ISO 8855, in which a slip to the left gives a force to the right; "
       "convert a file in axes of SAE first");
  need(tyre.p_ky2 > 0.0, "PKY2", tyre.p_ky2, "other than 0");
  need(tyre.p_ky4 > 0.0, "PKY4", tyre.p_ky4, "above 0");
}

void TyreFileReader::ApplyScaleFactors() {
  const double mu_x = Factor({"LMUX"});
  const double mu_y = Factor({"LMUY"});
  Multiply(Factor({"LCX"}), {&M::p_cx1});
  Multiply(mu_x, {&M::p_dx1, &M::p_dx2});
  Multiply(Factor({"LEX"}), {&M::p_ex1, &M::p_ex2, &M::p_ex3});
  Multiply(Factor({"LKX", "LKXK"}), {&M::p_kx1, &M::p_kx2});
  Multiply(Factor({"LHX"}), {&M::p_hx1, &M::p_hx2});
  Multiply(Factor({"LVX"}) * (is_6() ? DigressiveFriction(mu_x) : mu_x), {&M::p_vx1, &M::p_vx2});
  Multiply(Factor({"LXAL", "LXA"}), {&M::r_bx1, &M::r_bx3});
  Multiply(Factor({"LCY"}), {&M::p_cy1});
  Multiply(mu_y, {&M::p_dy1, &M::p_dy2});
  Multiply(Factor({"LEY"}), {&M::p_ey1, &M::p_ey2});
  Multiply(Factor({"LKY", "LKYA"}), {&M::p_ky1});
  Multiply(Factor({"LHY"}), {&M::p_hy1, &M::p_hy2});
  Multiply(Factor({"LYKA", "LYK"}), {&M::r_by1, &M::r_by4});
  Multiply(Factor({"LVYKA", "LVYK"}), {&M::r_vy1, &M::r_vy2, &M::r_vy3});
  const double shift = is_6() ? DigressiveFriction(mu_y) : mu_y;
  Multiply(Factor({"LVY"}) * shift, {&M::p_vy1, &M::p_vy2});
  if (is_6()) {
    const double camber = Factor({"LKYC", "LKYG"});
    Multiply(camber, {&M::p_ky6, &M::p_ky7});
    Multiply(camber * shift, {&M::p_vy3, &M::p_vy4});
  } else {
    // The factors LGAX and LGAY multiply the camber in F_x0 and F_y0.
    const double camber_x = Factor({"LGAX"});
    const double camber_y = Factor({"LGAY"});
    Multiply(camber_x * camber_x, {&M::p_dx3});
    Multiply(camber_y * camber_y, {&M::p_dy3});
    Multiply(camber_y, {&M::p_ky3, &M::p_ey4, &M::p_hy3});
    Multiply(camber_y * shift, {&M::p_vy3, &M::p_vy4});
  }
  const MagicFormula& tyre = result_.tyre;
  for (const auto& [value, key] : {std::pair(tyre.p_cx1, "LCX"), std::pair(tyre.p_dx1, "LMUX"),
                                   std::pair(tyre.p_kx1, "LKX"), std::pair(tyre.p_cy1, "LCY"),
                                   std::pair(tyre.p_dy1, "LMUY"), std::pair(-tyre.p_ky1, "LKY")}) {
    if (!(value > 0.0)) {
      Fail(Find(key), key, "0 must be above 0, because the tyre would have no force");
    }
  }
}

/// Multiplies the coefficients by the polynomials of the pressure change dpi (Pacejka 2012,
/// equations 4.E13 to 4.E30).
void TyreFileReader::ApplyPressure() {
  if (!is_6()) {
    return;
  }
  const double nominal = Number("NOMPRES").value_or(0.0);
  const double pressure = Number("INFLPRES").value_or(nominal);
  const double dpi = nominal > 0.0 && pressure > 0.0 ? (pressure - nominal) / nominal : 0.0;
  const auto polynomial = [&](const char* first, const char* second) {
    const double linear = Number(first).value_or(0.0) * dpi;
    const double factor =
        1.0 + linear + (second == nullptr ? 0.0 : Number(second).value_or(0.0) * dpi * dpi);
    if (!(factor > 0.0)) {
      Fail(Find("INFLPRES"), "INFLPRES",
           fmt::format("{} changes the tyre by {} to a factor of {:.4g} of that at NOMPRES {}; "
                       "must be nearer to NOMPRES",
                       pressure, first, factor, nominal));
    }
    return factor;
  };
  Multiply(polynomial("PPX1", "PPX2"), {&M::p_kx1, &M::p_kx2});
  Multiply(polynomial("PPX3", "PPX4"), {&M::p_dx1, &M::p_dx2});
  Multiply(polynomial("PPY1", nullptr), {&M::p_ky1});
  Multiply(polynomial("PPY2", nullptr), {&M::p_ky2, &M::p_ky5});
  Multiply(polynomial("PPY3", "PPY4"), {&M::p_dy1, &M::p_dy2});
  Multiply(polynomial("PPY5", nullptr), {&M::p_ky6, &M::p_ky7});
}

/// Reads the relaxation lengths sigma at the nominal load from PTX1 and PTY1. Without these keys,
/// sigma = K/C, with the slip stiffness K and the stiffness C of the carcass.
void TyreFileReader::ReadRelaxation() {
  MagicFormula& tyre = result_.tyre;
  const std::optional<double> radius = Number("UNLOADED_RADIUS");
  const double scaled_radius = radius.value_or(0.0) * length_ * load_scale_;
  const double of_kappa = Factor({"LSGKP"});
  const double of_alpha = Factor({"LSGAL"});
  const double ptx1 = Number("PTX1").value_or(0.0);
  const double pty1 = Number("PTY1").value_or(0.0);
  const double pty2 = Number("PTY2").value_or(0.0);
  const double stiffness = force_ / length_;
  const double along = Number("LONGITUDINAL_STIFFNESS").value_or(0.0) * stiffness;
  const double across = Number("LATERAL_STIFFNESS").value_or(0.0) * stiffness;
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };

  double sigma_y =
      pty2 != 0.0 ? pty1 * std::sin(2.0 * std::atan(1.0 / pty2)) * scaled_radius * of_alpha : 0.0;
  if (!positive(sigma_y) && across > 0.0) {
    sigma_y = CorneringStiffness(tyre, tyre.f_z0) / across;
  }
  double sigma_x = ptx1 * scaled_radius * of_kappa;
  if (!positive(sigma_x) && along > 0.0) {
    sigma_x = SlipStiffness(tyre, tyre.f_z0) / along;
  }
  if (positive(sigma_y)) {
    tyre.relaxation_length = sigma_y;
  }
  if (positive(sigma_x)) {
    tyre.relaxation_length_x = sigma_x;
  }
  if (positive(sigma_y) && positive(sigma_x)) {
    Note(fmt::format("relaxation lengths {:.3g} m along and {:.3g} m across, at the nominal load",
                     sigma_x, sigma_y));
  } else {
    Note(fmt::format("gives no relaxation length {}; the tyre has {:.3g} m",
                     positive(sigma_y)   ? "of the slip ratio (PTX1 or LONGITUDINAL_STIFFNESS)"
                     : positive(sigma_x) ? "of the slip angle (PTY1 and PTY2, or LATERAL_STIFFNESS)"
                                         : "(PTX1, PTY1 and PTY2, or stiffnesses)",
                     tyre.relaxation_length));
  }
}

void TyreFileReader::ReadVertical() {
  const std::optional<double> stiffness = Number("VERTICAL_STIFFNESS");
  const std::optional<double> damping = Number("VERTICAL_DAMPING");
  if (stiffness && *stiffness > 0.0) {
    result_.vertical_stiffness = *stiffness * force_ / length_;
  }
  if (damping && *damping >= 0.0) {
    result_.vertical_damping = *damping * force_ * time_ / length_;
  }
}

void TyreFileReader::CheckResult() {
  const MagicFormula& tyre = result_.tyre;
  const auto need = [&](const std::string& key, double value, double largest) {
    if (!(std::abs(value) <= largest)) {
      Fail(Find(key), key,
           fmt::format("is {:.4g} in SI units with its scale factors and pressure; must be within "
                       "{:g} of 0",
                       value, largest));
    }
  };
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    if (IsCoefficient(field)) {
      // The coefficients r_bx3 and r_by4 multiply the square of the camber, which is at most 0.1.
      const bool is_of_square = field.value == &M::r_bx3 || field.value == &M::r_by4;
      need(KeyOf(field.name), tyre.*field.value, is_of_square ? 1e6 : 1e3);
    }
  }
  need("FNOMIN", tyre.f_z0, 1e6);
  need("QSY1", tyre.rolling_resistance, 1.0);
  need(Find("PTY1") != nullptr ? "PTY1" : "LATERAL_STIFFNESS", tyre.relaxation_length, 10.0);
  need(Find("PTX1") != nullptr ? "PTX1" : "LONGITUDINAL_STIFFNESS", tyre.relaxation_length_x, 1e3);
  need("VERTICAL_STIFFNESS", result_.vertical_stiffness.value_or(0.0), 1e8);
  need("VERTICAL_DAMPING", result_.vertical_damping.value_or(0.0), 1e6);
  for (const auto& [key, value] : {std::pair("PEX1", tyre.p_ex1), std::pair("PEY1", tyre.p_ey1)}) {
    if (value > 1.0) {
      Note(
          fmt::format("{} is {:.4g} with its scale factor; the equations hold the curvature "
                      "factor at 1 at most",
                      key, value));
    }
  }
  if (!problems_.empty()) {
    return;
  }
  const TyreFriction friction = PeakFriction(tyre, tyre.f_z0);
  for (const auto& [value, key, what] :
       {std::tuple(SlipStiffness(tyre, tyre.f_z0), "PKX1", "slip stiffness"),
        std::tuple(CorneringStiffness(tyre, tyre.f_z0), "PKY1", "cornering stiffness"),
        std::tuple(friction.longitudinal, "PDX1", "longitudinal friction"),
        std::tuple(friction.lateral, "PDY1", "lateral friction")}) {
    if (!(std::isnormal(value) && value > 0.0)) {
      Fail(Find(key), key,
           fmt::format("the {} at the nominal load is {}; must be a finite number above 0", what,
                       value));
    }
  }
}

void TyreFileReader::ReadRollingResistance() {
  const double rolling = Number("QSY1").value_or(0.0) * Factor({"LMY"});
  result_.tyre.rolling_resistance = std::max(0.0, rolling);
  if (rolling < 0.0) {
    Note(fmt::format("QSY1 {} would drive the wheel; the tyre has no rolling resistance", rolling));
  }
}

/// Mirrors a tyre that was measured on the right side: F_y(alpha, gamma) of the left tyre is
/// -F_y(-alpha, -gamma) of the right tyre. If the file declares the tyre symmetric, sets the
/// asymmetric coefficients to 0.
void TyreFileReader::ApplySide() {
  const TyreFileEntry* entry = Find("TYRESIDE");
  const std::string side = entry == nullptr ? "LEFT" : InCapitals(entry->text);
  const std::initializer_list<Field> odd{&M::p_hy1, &M::p_hy2, &M::p_vy1, &M::p_vy2, &M::p_ey3,
                                         &M::r_hx1, &M::r_by3, &M::r_vy1, &M::r_vy2};
  if (side == "RIGHT") {
    Multiply(-1.0, odd);
    Note("measured on the right side; mirrored for the left side");
  } else if (side == "SYMMETRIC" || side == "SYMMETRICAL") {
    Multiply(0.0, odd);
  } else if (entry == nullptr || side == "UNKNOWN") {
    Note("states no side; read as measured on the left side");
  } else if (side != "LEFT") {
    Fail(entry, "TYRESIDE",
         fmt::format("'{}' must be 'LEFT', 'RIGHT' or 'SYMMETRIC'", entry->text));
  }
}

}  // namespace trackbed
