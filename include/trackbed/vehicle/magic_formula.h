#pragma once

#include <vector>

/// The Magic Formula tyre: forces in the contact patch from slip (Pacejka 2012; the PAC2002 subset
/// that CommonRoad's multi-body model uses (Althoff et al. 2017), with load sensitivity).
///
/// Axes of the wheel at the ground: x where it points, y to its left, z up. Symbols:
///   F_z    load [N]
///   kappa  slip ratio (Omega R - v_x)/|v_x|, driving positive
///   alpha  slip angle atan(v_y/|v_x|) of the contact point, positive when it moves to the left
///   gamma  camber, positive when the wheel's top leans to the left [rad]
/// Pure slip, with D = mu F_z, B = K/(C D), f(u) = C atan(u - E (u - atan u)):
///   F_x0 = D_x sin f(B_x (kappa + S_hx)) + S_vx     K_x = p_kx1 F_z
///   F_y0 = D_y sin f(B_y (alpha + S_hy)) + S_vy     K_y = p_ky1 F_z, or with load sensitivity
///                                                   K_y = p_ky1 F_z0 sin(2 atan(F_z/(p_ky2 F_z0)))
/// Combined slip: F_x = G_x(alpha) F_x0, F_y = G_y(kappa) F_y0 + S_vyk, each G a cosine of the
/// other slip (coefficients r_*).
namespace trackbed {

/// Coefficients under their standard names. Coefficients that are not given are 0 and have no
/// effect.
struct MagicFormula {
  double p_cx1 = 0.0;  ///< shape, > 0
  double p_dx1 = 0.0;  ///< friction mu_x, > 0
  double p_dx2 = 0.0;  ///< its change with load
  double p_dx3 = 0.0;  ///< its change with camber
  double p_ex1 = 0.0;  ///< curvature, <= 1
  double p_kx1 = 0.0;  ///< slip stiffness over load, > 0
  double p_hx1 = 0.0;  ///< horizontal shift
  double p_vx1 = 0.0;  ///< vertical shift over load
  double r_bx1 = 0.0;  ///< combined slip: F_x under alpha
  double r_bx2 = 0.0;
  double r_cx1 = 0.0;
  double r_ex1 = 0.0;
  double r_hx1 = 0.0;
  double p_cy1 = 0.0;  ///< shape, > 0
  double p_dy1 = 0.0;  ///< friction mu_y, > 0
  double p_dy2 = 0.0;  ///< its change with load
  double p_dy3 = 0.0;  ///< its change with camber
  double p_ey1 = 0.0;  ///< curvature, <= 1
  double p_ky1 = 0.0;  ///< cornering stiffness over load, < 0
  double p_ky2 = 0.0;  ///< load of the largest cornering stiffness over F_z0; 0: linear in the load
  double p_hy1 = 0.0;  ///< horizontal shift, with the sign of the camber
  double p_hy3 = 0.0;
  double p_vy1 = 0.0;  ///< vertical shift over load, with the sign of the camber
  double p_vy3 = 0.0;
  double r_by1 = 0.0;  ///< combined slip: F_y under kappa
  double r_by2 = 0.0;
  double r_by3 = 0.0;
  double r_cy1 = 0.0;
  double r_ey1 = 0.0;
  double r_hy1 = 0.0;
  double r_vy1 = 0.0;  ///< side force that kappa causes
  double r_vy3 = 0.0;
  double r_vy4 = 0.0;
  double r_vy5 = 0.0;
  double r_vy6 = 0.0;
  double f_z0 = 0.0;                ///< nominal load F_z0 [N]; needed by p_dx2, p_dy2 and p_ky2
  double relaxation_length = 0.3;   ///< sigma: rolling distance to 63 % of a slip change [m], > 0
  double rolling_resistance = 0.0;  ///< moment over load and radius
};

/// A coefficient by its name in a car's file.
struct MagicFormulaField {
  const char* name;
  double MagicFormula::*value;
  bool required;
};

/// All coefficients.
const std::vector<MagicFormulaField>& MagicFormulaFields();

struct TyreSlip {
  double ratio = 0.0;   ///< kappa
  double angle = 0.0;   ///< alpha [rad]
  double camber = 0.0;  ///< gamma [rad]; clamped to +-0.1
  /// Factor of the shifts, -1 to 1: they change sign with the rolling direction and vanish at
  /// standstill.
  double shift = 1.0;
};

struct TyreForce {
  double longitudinal = 0.0;  ///< F_x, on the car [N]
  double lateral = 0.0;       ///< F_y, on the car [N]
};

/// The force at steady slip. `road` > 0 is the factor of the road on both friction coefficients; it
/// does not affect stiffness.
///
/// Guarantees: no force without load (F_z <= 0). F_y is odd in (alpha, gamma), except for the r_*
/// shifts, which represent the asymmetry of a tyre. With r_* the combined force may exceed the
/// friction ellipse, a property of the model (CommonRoad's BMW: 12 %); without them it is scaled
/// onto the ellipse. The sign of gamma in the shifts is smoothed over half a mrad, because a jump
/// would be unphysical. Excludes aligning moment and turn slip. Cost: about 0.2 us.
TyreForce EvaluateTyreForce(const MagicFormula& tyre, double load, double road,
                            const TyreSlip& slip);

/// The largest longitudinal and lateral forces over the load, on a road of factor 1.
struct TyreFriction {
  double longitudinal = 0.0;
  double lateral = 0.0;
};

/// The peaks D/F_z of pure slip at `load`, without camber and shifts; with a shape C below 1 the
/// peak is D sin(C pi/2) instead of D.
TyreFriction PeakFriction(const MagicFormula& tyre, double load);

/// C_alpha = -dF_y/dalpha at zero slip [N/rad], > 0.
double CorneringStiffness(const MagicFormula& tyre, double load);

/// C_kappa = dF_x/dkappa at zero slip [N], > 0.
double SlipStiffness(const MagicFormula& tyre, double load);

}  // namespace trackbed
