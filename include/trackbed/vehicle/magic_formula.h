#pragma once

#include <vector>

/// The Magic Formula tyre: forces in the contact patch from slip (Pacejka 2012; the PAC2002 subset
/// that CommonRoad's multi-body model uses (Althoff et al. 2017), with load sensitivity).
///
/// Axes of the wheel at the ground: x in the direction of the wheel, y to its left, z up. Symbols:
///   F_z    load [N]
///   kappa  slip ratio (Omega R - v_x)/|v_x|, driving positive
///   alpha  slip angle atan(v_y/|v_x|) of the contact point, positive when it moves to the left
///   gamma  camber, positive when the wheel's top leans to the left [rad]
/// Pure slip, with D = mu F_z, B = K/(C D), f(u) = C atan(u - E (u - atan u)):
///   F_x0 = D_x sin f(B_x (kappa + S_hx)) + S_vx     K_x = p_kx1 F_z
///   F_y0 = D_y sin f(B_y (alpha + S_hy)) + S_vy     K_y = p_ky1 F_z, or with load sensitivity
///                                                   K_y = p_ky1 F_z0 sin(2 atan(F_z/(p_ky2 F_z0)))
/// Combined slip: F_x = G_x(alpha) F_x0, F_y = G_y(kappa) F_y0 + S_vyk, where each G is a cosine of
/// the other slip, with the coefficients r_*.
namespace trackbed {

/// Coefficients under their standard names. A coefficient that is not given is 0 and has no effect.
struct MagicFormula {
  double p_cx1 = 0.0;  ///< Shape factor, > 0.
  double p_dx1 = 0.0;  ///< Friction mu_x, > 0.
  double p_dx2 = 0.0;  ///< Change of mu_x with load.
  double p_dx3 = 0.0;  ///< Change of mu_x with camber.
  double p_ex1 = 0.0;  ///< Curvature factor, <= 1.
  double p_kx1 = 0.0;  ///< Slip stiffness divided by load, > 0.
  double p_hx1 = 0.0;  ///< Horizontal shift.
  double p_vx1 = 0.0;  ///< Vertical shift divided by load.
  double r_bx1 = 0.0;  ///< Combined slip: influence of alpha on F_x.
  double r_bx2 = 0.0;
  double r_cx1 = 0.0;
  double r_ex1 = 0.0;
  double r_hx1 = 0.0;
  double p_cy1 = 0.0;  ///< Shape factor, > 0.
  double p_dy1 = 0.0;  ///< Friction mu_y, > 0.
  double p_dy2 = 0.0;  ///< Change of mu_y with load.
  double p_dy3 = 0.0;  ///< Change of mu_y with camber.
  double p_ey1 = 0.0;  ///< Curvature factor, <= 1.
  double p_ky1 = 0.0;  ///< Cornering stiffness divided by load, < 0.
  /// Load at which the cornering stiffness is largest, divided by F_z0. With 0, the stiffness is
  /// proportional to the load.
  double p_ky2 = 0.0;
  double p_hy1 = 0.0;  ///< Horizontal shift, with the sign of the camber.
  double p_hy3 = 0.0;
  double p_vy1 = 0.0;  ///< Vertical shift divided by load, with the sign of the camber.
  double p_vy3 = 0.0;
  double r_by1 = 0.0;  ///< Combined slip: influence of kappa on F_y.
  double r_by2 = 0.0;
  double r_by3 = 0.0;
  double r_cy1 = 0.0;
  double r_ey1 = 0.0;
  double r_hy1 = 0.0;
  double r_vy1 = 0.0;  ///< Combined slip: side force caused by kappa.
  double r_vy3 = 0.0;
  double r_vy4 = 0.0;
  double r_vy5 = 0.0;
  double r_vy6 = 0.0;
  double f_z0 = 0.0;  ///< Nominal load F_z0 [N], needed by p_dx2, p_dy2 and p_ky2.
  /// Relaxation length sigma: distance over which the slip reaches 63 % of a change [m], > 0.
  double relaxation_length = 0.3;
  double rolling_resistance = 0.0;  ///< Rolling resistance moment divided by load and radius.
};

/// A coefficient with its name in a car's file.
struct MagicFormulaField {
  const char* name;
  double MagicFormula::*value;
  bool required;
};

/// All coefficients of the Magic Formula.
const std::vector<MagicFormulaField>& MagicFormulaFields();

struct TyreSlip {
  double ratio = 0.0;   ///< Slip ratio kappa.
  double angle = 0.0;   ///< Slip angle alpha [rad].
  double camber = 0.0;  ///< Camber gamma [rad], clamped to +-0.1.
  /// Factor on the horizontal and vertical shifts, from -1 to 1. The shifts change sign with the
  /// rolling direction and vanish at standstill.
  double shift = 1.0;
};

struct TyreForce {
  double longitudinal = 0.0;  ///< Force F_x on the car [N].
  double lateral = 0.0;       ///< Force F_y on the car [N].
};

/// Computes the tyre force at constant slip. The argument `road` > 0 is the road's factor on both
/// friction coefficients; the factor does not affect the stiffness.
///
/// Guarantees: there is no force without load (F_z <= 0). The lateral force F_y is an odd function
/// of (alpha, gamma), except for the r_* shifts, which represent the asymmetry of a tyre. With r_*
/// coefficients, the combined force may exceed the friction ellipse, by 12 % for CommonRoad's BMW.
/// The excess is a property of the model. Without r_* coefficients, a force outside the friction
/// ellipse is scaled back onto the ellipse. The sign of gamma in the shifts is smoothed over half a
/// mrad, because a jump would be unphysical. Aligning moment and turn slip are not included. Cost:
/// about 0.2 us.
TyreForce EvaluateTyreForce(const MagicFormula& tyre, double load, double road,
                            const TyreSlip& slip);

/// The largest longitudinal and lateral forces divided by the load, on a road of factor 1.
struct TyreFriction {
  double longitudinal = 0.0;
  double lateral = 0.0;
};

/// Returns the peak friction D/F_z for pure slip at `load`, without camber and shifts. With a shape
/// factor C below 1, the peak force is D sin(C pi/2) instead of D.
TyreFriction PeakFriction(const MagicFormula& tyre, double load);

/// Returns the cornering stiffness C_alpha = -dF_y/dalpha at zero slip [N/rad], > 0.
double CorneringStiffness(const MagicFormula& tyre, double load);

/// Returns the slip stiffness C_kappa = dF_x/dkappa at zero slip [N], > 0.
double SlipStiffness(const MagicFormula& tyre, double load);

}  // namespace trackbed
