#include "trackbed/vehicle/magic_formula.h"

#include <algorithm>
#include <cmath>
#include <numbers>

// Evaluates the Magic Formula: forces of a tyre at given slips, load, camber and road friction.
// 1. On a slippery road, the slips are multiplied by at most the reciprocal of the road's friction
//    factor, so that the curves of force over slip keep their shape (similarity method, section
//    4.2).
// 2. In pure slip, each tyre force is F = D sin(C atan(u - E (u - atan u))) + S_v with u = B (slip
//    + S_h), where B, C, D and E are the factors and S_h and S_v the shifts of the Magic Formula.
// 3. In combined slip, each tyre force is multiplied by a weight G that depends on the slip in the
//    other direction.
// 4. Friction and stiffness of a tyre stay above a tenth of their nominal values, even at extreme
//    loads and cambers.
// Source: Pacejka 2012, section 4.3.2 (MF5.2, and MF6.1 where the version is 6.1).
namespace trackbed {
namespace {

/// Width of the range of camber angles over which the sign function of the camber is smoothed
/// [rad].
constexpr double kCamberSign = 5e-4;

/// Evaluates the function f(u) = C atan(u - E (u - atan u)) of the Magic Formula.
double Shape(double c, double e, double u) {
  return c * std::atan(u - e * (u - std::atan(u)));
}

/// Returns the weighting factor for combined slip. The weighting factor describes how the slip in
/// the other direction, `slip`, reduces a tyre force. The weighting factor is 1 if the slip in the
/// other direction is zero.
double Weight(double b, double c, double e, double shift, double slip) {
  const double kept = std::cos(Shape(c, e, b * (slip + shift)));
  return shift == 0.0 ? kept : kept / std::cos(Shape(c, e, b * shift));
}

/// Returns the factor by which slips on a road with the friction factor `road` are multiplied to
/// get similar slips on a road with the factor 1. SimilarSlip divides slips by the friction factor
/// `road`. This division enlarges a slip at most to that of a locked wheel (abs(kappa) = 1) or of a
/// wheel that moves sideways (abs(alpha) = pi/2). The slip ratio and the slip angle have the same
/// factor, because their ratio is the direction in which the tyre slides.
double SimilarSlip(const TyreSlip& slip, double road) {
  if (road >= 1.0) {
    return 1.0 / road;
  }
  constexpr double kSideways = std::numbers::pi / 2.0;
  const double share = std::max(std::abs(slip.ratio), std::abs(slip.angle) / kSideways);
  return share > road ? std::max(1.0, 1.0 / share) : 1.0 / road;
}

/// Returns the cosine of atan(x).
double CosAtan(double x) {
  return 1.0 / std::sqrt(1.0 + x * x);
}

/// Returns the relative load change (F_z - F_z0)/F_z0 from the nominal load F_z0.
double LoadChange(const MagicFormula& tyre, double load) {
  return tyre.f_z0 > 0.0 ? (load - tyre.f_z0) / tyre.f_z0 : 0.0;
}

/// Returns a friction coefficient or a stiffness that is linear in the load change, limited to at
/// least a tenth of its value at the nominal load.
double AtLeastTenth(double at_nominal, double per_load, double load_change) {
  return std::max(at_nominal + per_load * load_change, 0.1 * at_nominal);
}

/// Returns the sign of x; 0 if x is 0.
double Sign(double x) {
  return static_cast<double>(x > 0.0) - static_cast<double>(x < 0.0);
}

/// Returns the camber, clamped to the tyre's range, with the sign convention of the tyre's
/// coefficients.
double CamberInFormula(const MagicFormula& tyre, double camber) {
  const double gamma = std::clamp(camber, -tyre.camber_max, tyre.camber_max);
  return tyre.version > 0.0 ? -gamma : gamma;
}

bool IsVersion6(const MagicFormula& tyre) {
  return tyre.version >= 6.0;
}

/// Returns the slip angle alpha or, in version 6.1 of the Magic Formula, its tangent.
double LateralSlip(const MagicFormula& tyre, double angle) {
  return IsVersion6(tyre) ? std::tan(angle) : angle;
}

/// Returns the camber gamma or, in version 6.1 of the Magic Formula, its sine.
double LateralCamber(const MagicFormula& tyre, double gamma) {
  return IsVersion6(tyre) ? std::sin(gamma) : gamma;
}

/// Returns the factor 1 - `change` by which the camber changes friction or stiffness. The camber
/// factor is limited to at least a tenth, because tyre files are valid for small cambers only.
double CamberFactor(double change) {
  return std::max(1.0 - change, 0.1);
}

/// Returns the cornering stiffness -K_y [N/rad] at the camber `lean` (LateralCamber). The cornering
/// stiffness is at least a thousandth of -p_ky1 F_z, so it is positive for every load F_z.
double LateralStiffness(const MagicFormula& tyre, double load, double lean) {
  const double by_camber = CamberFactor(tyre.p_ky3 * std::abs(lean));
  if (!(tyre.p_ky2 > 0.0)) {
    return -tyre.p_ky1 * load * by_camber;
  }
  const double best = std::max(tyre.p_ky2 + tyre.p_ky5 * lean * lean, 0.1 * tyre.p_ky2);
  const double x = load / (best * tyre.f_z0);
  // The fraction 2 x / (1 + x^2) equals sin(2 atan(x)).
  const double rise =
      tyre.p_ky4 == 2.0 ? 2.0 * x / (1.0 + x * x) : std::sin(tyre.p_ky4 * std::atan(x));
  return -tyre.p_ky1 * std::max(tyre.f_z0 * rise * by_camber, 1e-3 * load);
}

/// Returns D_x = mu_x F_z.
double LongitudinalPeak(const MagicFormula& t, double load, double road, double gamma,
                        double load_change) {
  return road * AtLeastTenth(t.p_dx1, t.p_dx2, load_change) *
         CamberFactor(t.p_dx3 * gamma * gamma) * load;
}

/// Returns D_y = mu_y F_z.
double LateralPeak(const MagicFormula& t, double load, double road, double gamma,
                   double load_change) {
  const double lean = LateralCamber(t, gamma);
  return road * AtLeastTenth(t.p_dy1, t.p_dy2, load_change) * CamberFactor(t.p_dy3 * lean * lean) *
         load;
}

/// The force of a tyre in pure slip.
struct PureForce {
  double force = 0.0;  // F_x0 or F_y0 [N].
  double peak = 0.0;   // D [N].
  double shift = 0.0;  // S_h.
};

PureForce LongitudinalForce(const MagicFormula& t, double load, double road, double gamma,
                            const TyreSlip& slip) {
  const double load_change = LoadChange(t, load);
  PureForce x{.peak = LongitudinalPeak(t, load, road, gamma, load_change),
              .shift = slip.shift * (t.p_hx1 + t.p_hx2 * load_change)};
  const double b = SlipStiffness(t, load) / (t.p_cx1 * x.peak);
  const double kappa = slip.ratio + x.shift;
  const double e = std::min(1.0, (t.p_ex1 + (t.p_ex2 + t.p_ex3 * load_change) * load_change) *
                                     (1.0 - t.p_ex4 * Sign(kappa)));
  const double s_v = slip.shift * road * load * (t.p_vx1 + t.p_vx2 * load_change);
  x.force = x.peak * std::sin(Shape(t.p_cx1, e, b * kappa)) + s_v;
  return x;
}

/// Shifts of the lateral force curve: the horizontal shift S_hy and the relative vertical shift
/// S_vy/(road F_z), with the road's friction factor `road`.
struct LateralShifts {
  double horizontal = 0.0;
  double vertical = 0.0;
};

LateralShifts ShiftsOf(const MagicFormula& t, double load, double lean, double stiffness,
                       double shift) {
  if (t.version == 0.0) {
    // Multiply the vertical shift by the smoothed sign of the camber, so that the shift has the
    // direction of the camber.
    const double side =
        shift * lean / std::sqrt(lean * lean + kCamberSign * kCamberSign);  // sgn gamma
    return {side * (t.p_hy1 + t.p_hy3 * std::abs(lean)),
            side * (t.p_vy1 + t.p_vy3 * std::abs(lean))};
  }
  const double load_change = LoadChange(t, load);
  const double by_camber = (t.p_vy3 + t.p_vy4 * load_change) * lean;
  // K_y = -stiffness
  const double camber_shift =
      IsVersion6(t) ? load * (by_camber - (t.p_ky6 + t.p_ky7 * load_change) * lean) / stiffness
                    : t.p_hy3 * lean;
  return {shift * (t.p_hy1 + t.p_hy2 * load_change + camber_shift),
          shift * (t.p_vy1 + t.p_vy2 * load_change + by_camber)};
}

PureForce LateralForce(const MagicFormula& t, double load, double road, double gamma,
                       const TyreSlip& slip) {
  const double load_change = LoadChange(t, load);
  const double lean = LateralCamber(t, gamma);
  const double stiffness = LateralStiffness(t, load, lean);
  const LateralShifts shifts = ShiftsOf(t, load, lean, stiffness, slip.shift);
  PureForce y{.peak = LateralPeak(t, load, road, gamma, load_change), .shift = shifts.horizontal};
  const double b = -stiffness / (t.p_cy1 * y.peak);
  const double alpha = LateralSlip(t, slip.angle) + y.shift;
  const double e =
      std::min(1.0, (t.p_ey1 + t.p_ey2 * load_change) *
                        (1.0 + t.p_ey5 * lean * lean - (t.p_ey3 + t.p_ey4 * lean) * Sign(alpha)));
  y.force = y.peak * std::sin(Shape(t.p_cy1, e, b * alpha)) + road * load * shifts.vertical;
  return y;
}

}  // namespace

const std::vector<MagicFormulaField>& MagicFormulaFields() {
  using M = MagicFormula;
  static const std::vector<MagicFormulaField> fields{
      {"magic_formula_version", &M::version, false},
      {"p_cx1", &M::p_cx1, true},
      {"p_dx1", &M::p_dx1, true},
      {"p_dx2", &M::p_dx2, false},
      {"p_dx3", &M::p_dx3, false},
      {"p_ex1", &M::p_ex1, false},
      {"p_ex2", &M::p_ex2, false},
      {"p_ex3", &M::p_ex3, false},
      {"p_ex4", &M::p_ex4, false},
      {"p_kx1", &M::p_kx1, true},
      {"p_kx2", &M::p_kx2, false},
      {"p_kx3", &M::p_kx3, false},
      {"p_hx1", &M::p_hx1, false},
      {"p_hx2", &M::p_hx2, false},
      {"p_vx1", &M::p_vx1, false},
      {"p_vx2", &M::p_vx2, false},
      {"r_bx1", &M::r_bx1, false},
      {"r_bx2", &M::r_bx2, false},
      {"r_bx3", &M::r_bx3, false},
      {"r_cx1", &M::r_cx1, false},
      {"r_ex1", &M::r_ex1, false},
      {"r_ex2", &M::r_ex2, false},
      {"r_hx1", &M::r_hx1, false},
      {"p_cy1", &M::p_cy1, true},
      {"p_dy1", &M::p_dy1, true},
      {"p_dy2", &M::p_dy2, false},
      {"p_dy3", &M::p_dy3, false},
      {"p_ey1", &M::p_ey1, false},
      {"p_ey2", &M::p_ey2, false},
      {"p_ey3", &M::p_ey3, false},
      {"p_ey4", &M::p_ey4, false},
      {"p_ey5", &M::p_ey5, false},
      {"p_ky1", &M::p_ky1, true},
      {"p_ky2", &M::p_ky2, false},
      {"p_ky3", &M::p_ky3, false},
      {"p_ky4", &M::p_ky4, false},
      {"p_ky5", &M::p_ky5, false},
      {"p_ky6", &M::p_ky6, false},
      {"p_ky7", &M::p_ky7, false},
      {"p_hy1", &M::p_hy1, false},
      {"p_hy2", &M::p_hy2, false},
      {"p_hy3", &M::p_hy3, false},
      {"p_vy1", &M::p_vy1, false},
      {"p_vy2", &M::p_vy2, false},
      {"p_vy3", &M::p_vy3, false},
      {"p_vy4", &M::p_vy4, false},
      {"r_by1", &M::r_by1, false},
      {"r_by2", &M::r_by2, false},
      {"r_by3", &M::r_by3, false},
      {"r_by4", &M::r_by4, false},
      {"r_cy1", &M::r_cy1, false},
      {"r_ey1", &M::r_ey1, false},
      {"r_ey2", &M::r_ey2, false},
      {"r_hy1", &M::r_hy1, false},
      {"r_hy2", &M::r_hy2, false},
      {"r_vy1", &M::r_vy1, false},
      {"r_vy2", &M::r_vy2, false},
      {"r_vy3", &M::r_vy3, false},
      {"r_vy4", &M::r_vy4, false},
      {"r_vy5", &M::r_vy5, false},
      {"r_vy6", &M::r_vy6, false},
      {"F_z0", &M::f_z0, false},
      {"camber_max", &M::camber_max, false},
      {"relaxation_length", &M::relaxation_length, false},
      {"relaxation_length_x", &M::relaxation_length_x, false},
      {"rolling_resistance", &M::rolling_resistance, false},
  };
  return fields;
}

TyreFriction PeakFriction(const MagicFormula& t, double load) {
  const double load_change = LoadChange(t, load);
  const auto reached = [](double shape) {
    return std::sin(0.5 * std::numbers::pi * std::min(1.0, shape));
  };
  return {AtLeastTenth(t.p_dx1, t.p_dx2, load_change) * reached(t.p_cx1),
          AtLeastTenth(t.p_dy1, t.p_dy2, load_change) * reached(t.p_cy1)};
}

double CorneringStiffness(const MagicFormula& tyre, double load) {
  return LateralStiffness(tyre, load, 0.0);
}

double SlipStiffness(const MagicFormula& t, double load) {
  if (t.p_kx2 == 0.0 && t.p_kx3 == 0.0) {
    return t.p_kx1 * load;
  }
  const double load_change = LoadChange(t, load);
  return load * AtLeastTenth(t.p_kx1, t.p_kx2, load_change) * std::exp(t.p_kx3 * load_change);
}

TyreForce EvaluateTyreForce(const MagicFormula& t, double load, double road, const TyreSlip& slip) {
  if (!(load > 0.0)) {
    return {};
  }
  const double gamma = CamberInFormula(t, slip.camber);
  const double load_change = LoadChange(t, load);
  const PureForce x = LongitudinalForce(t, load, road, gamma, slip);
  const PureForce y = LateralForce(t, load, road, gamma, slip);
  if (t.r_bx1 == 0.0 && t.r_by1 == 0.0) {
    const double norm = std::hypot(x.force / x.peak, y.force / y.peak);
    return {x.force / std::max(1.0, norm), y.force / std::max(1.0, norm)};
  }
  // On a slippery road, a tyre begins to slide at smaller slips. In pure slip, the tyre forces
  // account for the road's friction by the stiffness factor B = K/(C D), with the slip stiffness K.
  // The weighting factors of combined slip are evaluated at the similar slips on a road with the
  // factor 1 (SimilarSlip). The similarity factor multiplies the shifted slips kappa + S_hx and
  // alpha + S_hy, because the horizontal shifts S_hx and S_hy count as parts of the slips.
  const double similar = SimilarSlip(slip, road);
  const double kappa = similar * slip.ratio + (similar - 1.0) * x.shift;
  const double alpha = similar * LateralSlip(t, slip.angle) + (similar - 1.0) * y.shift;
  const double lean = LateralCamber(t, gamma);
  const double b_xa = (t.r_bx1 + t.r_bx3 * lean * lean) * CosAtan(t.r_bx2 * kappa);
  const double b_yk = (t.r_by1 + t.r_by4 * lean * lean) * CosAtan(t.r_by2 * (alpha - t.r_by3));
  const double d_vyk =
      y.peak * (t.r_vy1 + t.r_vy2 * load_change + t.r_vy3 * lean) * CosAtan(t.r_vy4 * alpha);
  const double s_vyk = d_vyk == 0.0 ? 0.0 : d_vyk * std::sin(t.r_vy5 * std::atan(t.r_vy6 * kappa));
  const double e_xa = std::min(1.0, t.r_ex1 + t.r_ex2 * load_change);
  const double e_yk = std::min(1.0, t.r_ey1 + t.r_ey2 * load_change);
  return {Weight(b_xa, t.r_cx1, e_xa, t.r_hx1, alpha) * x.force,
          Weight(b_yk, t.r_cy1, e_yk, t.r_hy1 + t.r_hy2 * load_change, kappa) * y.force + s_vyk};
}

double FrictionUse(const MagicFormula& t, double load, double road, double camber,
                   const TyreForce& force) {
  if (!(load > 0.0)) {
    return 0.0;
  }
  const double gamma = CamberInFormula(t, camber);
  const double load_change = LoadChange(t, load);
  return std::hypot(force.longitudinal / LongitudinalPeak(t, load, road, gamma, load_change),
                    force.lateral / LateralPeak(t, load, road, gamma, load_change));
}

}  // namespace trackbed
