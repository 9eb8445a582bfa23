#include "trackbed/vehicle/magic_formula.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trackbed {
namespace {

/// Width of the range of camber angles over which the sign function of the camber is smoothed
/// [rad].
constexpr double kCamberSign = 5e-4;
/// Largest camber angle in the formula, to which larger angles are clamped [rad]. Tyre measurements
/// extend up to a camber angle of about 6 degrees. Without the clamp, the squared camber in the
/// formula would increase the grip of a car more and more while the car rolls over.
constexpr double kMaxCamber = 0.1;

/// Evaluates the function f(u) = C atan(u - E (u - atan u)) of the Magic Formula.
double Shape(double c, double e, double u) {
  return c * std::atan(u - e * (u - std::atan(u)));
}

/// Returns the weighting factor for combined slip. The factor describes how the slip in the other
/// direction, `slip`, reduces a tyre force. The weighting factor is 1 if the slip in the other
/// direction is zero.
double Weight(double b, double c, double e, double shift, double slip) {
  const double kept = std::cos(Shape(c, e, b * (slip + shift)));
  return shift == 0.0 ? kept : kept / std::cos(Shape(c, e, b * shift));
}

/// Returns the factor by which slips on a road with the friction factor `road` are multiplied to
/// get similar slips on a road with the factor 1. The factor is 1/road, but no slip is enlarged
/// beyond that of a locked wheel, kappa = -1, or of a wheel that moves sideways, alpha = pi/2. Both
/// slips have the same factor, because their ratio is the direction in which the tyre slides.
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

/// Returns the friction coefficient mu. The friction coefficient is linear in the load change, but
/// at least a tenth of the nominal value.
double Friction(double at_nominal, double per_load, double load_change) {
  return std::max(at_nominal + per_load * load_change, 0.1 * at_nominal);
}

}  // namespace

const std::vector<MagicFormulaField>& MagicFormulaFields() {
  using M = MagicFormula;
  static const std::vector<MagicFormulaField> fields{
      {"p_cx1", &M::p_cx1, true},
      {"p_dx1", &M::p_dx1, true},
      {"p_dx2", &M::p_dx2, false},
      {"p_dx3", &M::p_dx3, false},
      {"p_ex1", &M::p_ex1, false},
      {"p_kx1", &M::p_kx1, true},
      {"p_hx1", &M::p_hx1, false},
      {"p_vx1", &M::p_vx1, false},
      {"r_bx1", &M::r_bx1, false},
      {"r_bx2", &M::r_bx2, false},
      {"r_cx1", &M::r_cx1, false},
      {"r_ex1", &M::r_ex1, false},
      {"r_hx1", &M::r_hx1, false},
      {"p_cy1", &M::p_cy1, true},
      {"p_dy1", &M::p_dy1, true},
      {"p_dy2", &M::p_dy2, false},
      {"p_dy3", &M::p_dy3, false},
      {"p_ey1", &M::p_ey1, false},
      {"p_ky1", &M::p_ky1, true},
      {"p_ky2", &M::p_ky2, false},
      {"p_hy1", &M::p_hy1, false},
      {"p_hy3", &M::p_hy3, false},
      {"p_vy1", &M::p_vy1, false},
      {"p_vy3", &M::p_vy3, false},
      {"r_by1", &M::r_by1, false},
      {"r_by2", &M::r_by2, false},
      {"r_by3", &M::r_by3, false},
      {"r_cy1", &M::r_cy1, false},
      {"r_ey1", &M::r_ey1, false},
      {"r_hy1", &M::r_hy1, false},
      {"r_vy1", &M::r_vy1, false},
      {"r_vy3", &M::r_vy3, false},
      {"r_vy4", &M::r_vy4, false},
      {"r_vy5", &M::r_vy5, false},
      {"r_vy6", &M::r_vy6, false},
      {"F_z0", &M::f_z0, false},
      {"relaxation_length", &M::relaxation_length, false},
      {"rolling_resistance", &M::rolling_resistance, false},
  };
  return fields;
}

TyreFriction PeakFriction(const MagicFormula& t, double load) {
  const double load_change = LoadChange(t, load);
  const auto reached = [](double shape) {
    return std::sin(0.5 * std::numbers::pi * std::min(1.0, shape));
  };
  return {Friction(t.p_dx1, t.p_dx2, load_change) * reached(t.p_cx1),
          Friction(t.p_dy1, t.p_dy2, load_change) * reached(t.p_cy1)};
}

double CorneringStiffness(const MagicFormula& tyre, double load) {
  if (!(tyre.p_ky2 > 0.0)) {
    return -tyre.p_ky1 * load;
  }
  const double x = load / (tyre.p_ky2 * tyre.f_z0);
  // 2 x / (1 + x^2) is sin(2 atan(x)) in closed form.
  return -tyre.p_ky1 * tyre.f_z0 * 2.0 * x / (1.0 + x * x);
}

double SlipStiffness(const MagicFormula& tyre, double load) {
  return tyre.p_kx1 * load;
}

TyreForce EvaluateTyreForce(const MagicFormula& t, double load, double road, const TyreSlip& slip) {
  if (!(load > 0.0)) {
    return {};
  }
  const double gamma = std::clamp(slip.camber, -kMaxCamber, kMaxCamber);
  // Multiply the shift by the smoothed sign of the camber gamma, so that the shift has the
  // direction of the camber.
  const double side =
      slip.shift * gamma / std::sqrt(gamma * gamma + kCamberSign * kCamberSign);  // sgn gamma
  const double lean = std::abs(gamma);
  const double load_change = LoadChange(t, load);

  const double mu_x =
      road * Friction(t.p_dx1, t.p_dx2, load_change) * (1.0 - t.p_dx3 * gamma * gamma);
  const double d_x = mu_x * load;
  const double b_x = SlipStiffness(t, load) / (t.p_cx1 * d_x);
  const double shift_x = slip.shift * t.p_hx1;
  const double kappa_x = slip.ratio + shift_x;
  const double s_vx = slip.shift * road * load * t.p_vx1;
  const double f_x0 = d_x * std::sin(Shape(t.p_cx1, t.p_ex1, b_x * kappa_x)) + s_vx;

  const double mu_y =
      road * Friction(t.p_dy1, t.p_dy2, load_change) * (1.0 - t.p_dy3 * gamma * gamma);
  const double d_y = mu_y * load;
  const double b_y = -CorneringStiffness(t, load) / (t.p_cy1 * d_y);
  const double shift_y = side * (t.p_hy1 + t.p_hy3 * lean);
  const double alpha_y = slip.angle + shift_y;
  const double s_vy = side * road * load * (t.p_vy1 + t.p_vy3 * lean);
  const double f_y0 = d_y * std::sin(Shape(t.p_cy1, t.p_ey1, b_y * alpha_y)) + s_vy;

  if (t.r_bx1 == 0.0 && t.r_by1 == 0.0) {
    const double norm = std::hypot(f_x0 / d_x, f_y0 / d_y);
    return {f_x0 / std::max(1.0, norm), f_y0 / std::max(1.0, norm)};
  }
  // A tyre slides at smaller slips on a slippery road. The pure forces take this into account by
  // B = K/(C D), the weighting factors of combined slip by similar slips. The shifts belong to the
  // slips, so the sums kappa + S_hx and alpha + S_hy are multiplied.
  const double similar = SimilarSlip(slip, road);
  const double kappa = similar * slip.ratio + (similar - 1.0) * shift_x;
  const double alpha = similar * slip.angle + (similar - 1.0) * shift_y;
  const double b_xa = t.r_bx1 * CosAtan(t.r_bx2 * kappa);
  const double b_yk = t.r_by1 * CosAtan(t.r_by2 * (alpha - t.r_by3));
  const double d_vyk = mu_y * load * (t.r_vy1 + t.r_vy3 * gamma) * CosAtan(t.r_vy4 * alpha);
  const double s_vyk = d_vyk == 0.0 ? 0.0 : d_vyk * std::sin(t.r_vy5 * std::atan(t.r_vy6 * kappa));
  return {Weight(b_xa, t.r_cx1, t.r_ex1, t.r_hx1, alpha) * f_x0,
          Weight(b_yk, t.r_cy1, t.r_ey1, t.r_hy1, kappa) * f_y0 + s_vyk};
}

double FrictionUse(const MagicFormula& t, double load, double road, double camber,
                   const TyreForce& force) {
  if (!(load > 0.0)) {
    return 0.0;
  }
  const double gamma = std::clamp(camber, -kMaxCamber, kMaxCamber);
  const double load_change = LoadChange(t, load);
  const double mu_x =
      road * Friction(t.p_dx1, t.p_dx2, load_change) * (1.0 - t.p_dx3 * gamma * gamma);
  const double mu_y =
      road * Friction(t.p_dy1, t.p_dy2, load_change) * (1.0 - t.p_dy3 * gamma * gamma);
  return std::hypot(force.longitudinal / (mu_x * load), force.lateral / (mu_y * load));
}

}  // namespace trackbed
