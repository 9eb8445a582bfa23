#pragma once

#include <vector>

/// The Magic Formula tyre model, which computes the forces in the contact patch from the slip
/// (Pacejka 2012, section 4.3.2). The model has the forces of PAC2002, MF5.2 and MF6.1 in steady
/// slip, and the subset of PAC2002 that CommonRoad's multi-body model uses (Althoff et al. 2017).
///
/// The axes of the wheel are x in the direction of the wheel, y to the wheel's left, and z up, with
/// the origin on the ground. The symbols are:
///   F_z: load [N]; dfz: load change (F_z - F_z0)/F_z0.
///   kappa: slip ratio (Omega R - v_x)/|v_x|, positive when driving.
///   alpha: slip angle atan(v_y/|v_x|) of the contact point [rad], positive if v_y is to the left.
///   gamma: camber [rad], positive if the top of the wheel leans to the left.
/// The forces in pure slip are, with D = mu F_z, B = K/(C D), f(u) = C atan(u - E (u - atan u)):
///   F_x0 = D_x sin f(B_x (kappa + S_hx)) + S_vx     K_x = F_z (p_kx1 + p_kx2 dfz) exp(p_kx3 dfz)
///   F_y0 = D_y sin f(B_y (alpha + S_hy)) + S_vy     K_y = p_ky1 F_z, or with load sensitivity
///                                                   K_y = p_ky1 F_z0 sin(2 atan(F_z/(p_ky2 F_z0)))
/// The forces in combined slip are F_x = G_x(alpha) F_x0 and F_y = G_y(kappa) F_y0 + S_vyk. Each
/// combined-slip factor G (G_x or G_y) is a cosine function of the slip in the other direction,
/// with the coefficients r_*.
///
/// The road's friction factor `road` multiplies the friction coefficients mu_x and mu_y and the
/// vertical shifts S_vx and S_vy. In the factors G and the shift S_vyk, the slips kappa + S_hx and
/// alpha + S_hy are divided by the road's friction factor `road`. The slips in G and S_vyk are
/// divided by more than `road` if kappa or alpha would otherwise exceed full sliding, |kappa| = 1
/// or |alpha| = pi/2. Up to full sliding, the tyre force satisfies
///   F(road, kappa, alpha) = road F(1, (kappa + S_hx)/road - S_hx, (alpha + S_hy)/road - S_hy),
/// as in the similarity method (Pacejka 2012, section 4.2). If the slip is scaled with the road's
/// friction factor, a tyre uses the same fraction of the friction ellipse on every road.
namespace trackbed {

/// The coefficients of the Magic Formula, under their standard names. A coefficient that a car's
/// file does not specify is 0 and has no effect.
struct MagicFormula {
  /// The equations to which the coefficients belong: 0 for CommonRoad's, 5.2 for PAC2002 and MF5.2,
  /// 6.1 for MF6.1. In version 0, the shift coefficients p_hy1 and p_vy1 have the sign of the
  /// camber. In versions 5.2 and 6.1, the shift coefficients p_hy1 and p_vy1 are constant. The
  /// coefficients assume that the camber gamma is positive if the top of the wheel leans to the
  /// right, as in ISO 8855; EvaluateTyreForce reverses the sign of gamma. In version 6.1,
  /// tan(alpha) and sin(gamma) replace the slip angle alpha and the camber gamma in the lateral
  /// force F_y and in the combined-slip factors G.
  double version = 0.0;
  double p_cx1 = 0.0;  ///< Shape factor C of the formula, > 0.
  double p_dx1 = 0.0;  ///< Longitudinal friction coefficient mu_x at nominal load, > 0.
  double p_dx2 = 0.0;  ///< Change of the friction coefficient mu_x with the load.
  double p_dx3 = 0.0;  ///< Change of the friction coefficient mu_x with the camber.
  double p_ex1 = 0.0;  ///< Curvature factor E of the formula; values above 1 count as 1.
  double p_ex2 = 0.0;  ///< Change of the curvature factor E with the load; E is at most 1.
  double p_ex3 = 0.0;  ///< Change of the curvature factor E with the square of the load change.
  double p_ex4 = 0.0;  ///< Change of the curvature factor E with the sign of the slip ratio.
  double p_kx1 = 0.0;  ///< Longitudinal slip stiffness divided by the load, > 0.
  double p_kx2 = 0.0;  ///< Change of the slip stiffness with the load.
  double p_kx3 = 0.0;  ///< Exponential change of the slip stiffness with the load.
  double p_hx1 = 0.0;  ///< Horizontal shift.
  double p_hx2 = 0.0;
  double p_vx1 = 0.0;  ///< Vertical shift of F_x divided by the load.
  double p_vx2 = 0.0;
  double r_bx1 = 0.0;  ///< Coefficient of combined slip: influence of the slip angle alpha on F_x.
  double r_bx2 = 0.0;
  double r_bx3 = 0.0;
  double r_cx1 = 0.0;
  double r_ex1 = 0.0;
  double r_ex2 = 0.0;
  double r_hx1 = 0.0;
  double p_cy1 = 0.0;  ///< Shape factor C of the formula, > 0.
  double p_dy1 = 0.0;  ///< Lateral friction coefficient mu_y at nominal load, > 0.
  double p_dy2 = 0.0;  ///< Change of the friction coefficient mu_y with the load.
  double p_dy3 = 0.0;  ///< Change of the friction coefficient mu_y with the camber.
  double p_ey1 = 0.0;  ///< Curvature factor E of the formula; values above 1 count as 1.
  double p_ey2 = 0.0;  ///< Change of the curvature factor E with the load; E is at most 1.
  double p_ey3 = 0.0;  ///< Change of the curvature factor E with the sign of the slip angle.
  double p_ey4 = 0.0;  ///< Change of the curvature factor E with camber and sign of the slip angle.
  double p_ey5 = 0.0;  ///< Change of the curvature factor E with the square of the camber.
  double p_ky1 = 0.0;  ///< Cornering stiffness divided by the load, < 0.
  /// Load at which the cornering stiffness is largest, divided by F_z0. If p_ky2 is 0, the
  /// cornering stiffness is proportional to the load.
  double p_ky2 = 0.0;
  /// Change of the cornering stiffness with the magnitude |gamma| of the camber.
  double p_ky3 = 0.0;
  /// Factor that replaces the 2 in the formula of the cornering stiffness K_y, > 0.
  double p_ky4 = 2.0;
  double p_ky5 = 0.0;  ///< Change of p_ky2 with the square of the camber.
  double p_ky6 = 0.0;  ///< Camber stiffness divided by the load, in version 6.1.
  double p_ky7 = 0.0;  ///< Change of the camber stiffness with the load.
  double p_hy1 = 0.0;  ///< Horizontal shift S_hy of F_y; its sign depends on `version`.
  double p_hy2 = 0.0;
  double p_hy3 = 0.0;  ///< Horizontal shift of F_y in proportion to the camber; not in version 6.1.
  double p_vy1 = 0.0;  ///< Vertical shift of F_y divided by the load; its sign depends on
                       ///< `version`.
  double p_vy2 = 0.0;
  double p_vy3 = 0.0;  ///< Vertical shift of F_y in proportion to the camber.
  double p_vy4 = 0.0;
  double r_by1 = 0.0;  ///< Coefficient of combined slip: influence of the slip ratio kappa on F_y.
  double r_by2 = 0.0;
  double r_by3 = 0.0;
  double r_by4 = 0.0;
  double r_cy1 = 0.0;
  double r_ey1 = 0.0;
  double r_ey2 = 0.0;
  double r_hy1 = 0.0;
  double r_hy2 = 0.0;
  double r_vy1 = 0.0;  ///< Coefficient of combined slip: side force caused by the slip ratio kappa.
  double r_vy2 = 0.0;
  double r_vy3 = 0.0;
  double r_vy4 = 0.0;
  double r_vy5 = 0.0;
  double r_vy6 = 0.0;
  /// Nominal tyre load F_z0 [N]; required if a coefficient of the load change or p_ky2 is used.
  double f_z0 = 0.0;
  /// Largest camber in the formula [rad], > 0; larger cambers are clamped. Tyre measurements extend
  /// up to a camber of about 6 degrees. Without the clamp of the camber, the squared camber in the
  /// formula would increase the grip of a car more and more while the car rolls over.
  double camber_max = 0.1;
  /// Relaxation length sigma of the tyre [m], > 0: after a sudden change of slip, the rolling
  /// distance over which the tyre's slip reaches 63 % of the change.
  double relaxation_length = 0.3;
  /// Relaxation length of the slip ratio [m], >= 0; 0: the same as relaxation_length.
  double relaxation_length_x = 0.0;
  /// Rolling resistance moment of the wheel, divided by its load and radius.
  double rolling_resistance = 0.0;
};

/// A coefficient of the Magic Formula, with its name in a car's file.
struct MagicFormulaField {
  const char* name;
  double MagicFormula::*value;
  bool required;
};

/// Returns all coefficients of the Magic Formula.
const std::vector<MagicFormulaField>& MagicFormulaFields();

struct TyreSlip {
  double ratio = 0.0;   ///< Slip ratio kappa.
  double angle = 0.0;   ///< Slip angle alpha [rad].
  double camber = 0.0;  ///< Camber gamma of the wheel [rad], clamped to +-camber_max.
  /// Factor on the horizontal and vertical shifts of the tyre force curves, from -1 to 1. With this
  /// factor, the shifts of the tyre force curves change sign with the rolling direction and vanish
  /// at standstill.
  double shift = 1.0;
};

struct TyreForce {
  double longitudinal = 0.0;  ///< Longitudinal force F_x on the car [N].
  double lateral = 0.0;       ///< Lateral force F_y on the car [N].
};

/// Computes the force of a tyre with constant slip. The argument `road`, > 0, is the friction
/// factor of the road, by which the tyre's longitudinal and lateral friction coefficients are
/// multiplied. The road's friction factor does not affect the tyre's stiffnesses.
///
/// Guarantees: the tyre force is 0 if the tyre has no load (F_z <= 0). The lateral force F_y is an
/// odd function of slip angle and camber, except for the r_* shifts, which represent the asymmetry
/// of a tyre. With r_* coefficients, the combined force may exceed the friction ellipse, for
/// example by 12 % for an upright tyre of CommonRoad's BMW, at every friction factor. The excess of
/// the combined force over the friction ellipse is a property of the r_* coefficients. For a tyre
/// without r_* coefficients, a force outside the friction ellipse is scaled back onto the ellipse.
/// The shifts of the tyre force depend on the sign of the camber gamma; this dependence is smoothed
/// over half a mrad, because a jump would be unphysical. The aligning moment and turn slip are not
/// modeled. Cost: about 0.2 us.
TyreForce EvaluateTyreForce(const MagicFormula& tyre, double load, double road,
                            const TyreSlip& slip);

/// Returns the fraction of the friction ellipse that `force` uses, hypot(F_x/D_x, F_y/D_y) with D =
/// mu F_z. The friction factor of the road is `road` > 0, and the camber is `camber` [rad]. The
/// used fraction of the friction ellipse is 0 for a tyre without load (F_z <= 0). For a sliding
/// tyre, the used fraction of the friction ellipse is about 1. The used fraction of a tyre with r_*
/// coefficients may exceed 1 (EvaluateTyreForce).
double FrictionUse(const MagicFormula& tyre, double load, double road, double camber,
                   const TyreForce& force);

/// The largest longitudinal and lateral force of a tyre, divided by the load, on a road with the
/// friction factor 1.
struct TyreFriction {
  double longitudinal = 0.0;
  double lateral = 0.0;
};

/// Returns the peak friction for pure slip at `load`, without camber and shifts: the peak force D
/// divided by the load F_z. If the shape factor C is below 1, the largest force of the tyre is D
/// sin(C pi/2) instead of the peak factor D.
TyreFriction PeakFriction(const MagicFormula& tyre, double load);

/// Returns the cornering stiffness C_alpha = -dF_y/dalpha at zero slip [N/rad], > 0.
double CorneringStiffness(const MagicFormula& tyre, double load);

/// Returns the slip stiffness C_kappa = dF_x/dkappa at zero slip [N], > 0.
double SlipStiffness(const MagicFormula& tyre, double load);

}  // namespace trackbed
