#include "src/sim/model_check.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include "src/sim/mujoco_compat.h"
#include "trackbed/core/error.h"

// Checks every number of a compiled model against a table of bounds. The arrays to check come from
// MuJoCo's macro MJMODEL_POINTERS; numbers under <custom> are checked by name. After the arrays of
// the model, CheckModel checks the options, the joint names and the actuators. Throws one
// InputError that lists up to 20 problems, each with the name of its object.
namespace trackbed {
namespace {

/// Largest magnitude of a number that MuJoCo accepts in a simulation.
constexpr double kMaxMagnitude = 1e10;

/// Largest accepted magnitude of the model's numbers with this name, far beyond that of any
/// vehicle.
struct Bound {
  std::string_view name;
  double largest;
};

/// Bounds of the model's numbers under <custom>, in SI units.
constexpr std::array kCustomBounds{
    Bound{"steering_ratio", 1e3}, Bound{"steering_wheel_rate", 1e3}, Bound{"steering_rate", 1e3},
    Bound{"turning_radius", 1e3}, Bound{"brake_torque", 1e5}, Bound{"brake_torque_front", 1e5},
    Bound{"brake_torque_rear", 1e5}, Bound{"drive_power", 1e7}, Bound{"drag_area", 1e2},
    Bound{"side_area", 1e2}, Bound{"center_of_pressure", 1e2}, Bound{"F_z0", 1e6},
    Bound{"tyre_vertical_stiffness", 1e8}, Bound{"tyre_vertical_damping", 1e6},
    Bound{"relaxation_length", 1e1}, Bound{"rolling_resistance", 1.0},
    // The coefficients r_bx3 and r_by4 multiply the square of the camber, which is at most 0.1.
    Bound{"r_bx3", 1e6}, Bound{"r_by4", 1e6}, Bound{"camber_gain_front", 1e1},
    Bound{"camber_gain_rear", 1e1}};
// bound of a tyre's Magic Formula coefficients, such as "p_cx1"
constexpr double kMaxCoefficient = 1e3;

/// Bounds of the numbers in arrays of the compiled model, in SI units; the table contains the
/// arrays whose numbers come from the model file. MuJoCo computes all other arrays from the arrays
/// in this table, or uses them only for drawing. Arrays that the installed version of MuJoCo does
/// not have are skipped.
constexpr std::array kModelBounds{Bound{"qpos0", 1e5},
                                  Bound{"qpos_spring", kMaxMagnitude},
                                  Bound{"body_pos", 1e5},
                                  Bound{"body_quat", kMaxMagnitude},
                                  Bound{"body_ipos", 1e5},
                                  Bound{"body_iquat", kMaxMagnitude},
                                  Bound{"body_mass", 1e6},
                                  Bound{"body_inertia", 1e9},
                                  Bound{"body_gravcomp", kMaxMagnitude},
                                  Bound{"body_user", kMaxMagnitude},
                                  Bound{"jnt_solref", kMaxMagnitude},
                                  Bound{"jnt_solimp", kMaxMagnitude},
                                  Bound{"jnt_pos", 1e5},
                                  Bound{"jnt_axis", kMaxMagnitude},
                                  Bound{"jnt_stiffness", 1e9},
                                  Bound{"jnt_stiffnesspoly", 1e12},
                                  Bound{"jnt_springyield", kMaxMagnitude},
                                  Bound{"jnt_range", kMaxMagnitude},
                                  Bound{"jnt_actfrcrange", kMaxMagnitude},
                                  Bound{"jnt_margin", kMaxMagnitude},
                                  Bound{"jnt_user", kMaxMagnitude},
                                  Bound{"dof_solref", kMaxMagnitude},
                                  Bound{"dof_solimp", kMaxMagnitude},
                                  Bound{"dof_frictionloss", 1e6},
                                  Bound{"dof_armature", 1e6},
                                  Bound{"dof_damping", 1e7},
                                  Bound{"dof_dampingpoly", kMaxMagnitude},
                                  Bound{"geom_solmix", kMaxMagnitude},
                                  Bound{"geom_solref", kMaxMagnitude},
                                  Bound{"geom_solimp", kMaxMagnitude},
                                  Bound{"geom_size", 1e5},
                                  Bound{"geom_pos", 1e5},
                                  Bound{"geom_quat", kMaxMagnitude},
                                  Bound{"geom_friction", 1e2},
                                  Bound{"geom_margin", kMaxMagnitude},
                                  Bound{"geom_gap", kMaxMagnitude},
                                  Bound{"geom_surfacevel", kMaxMagnitude},
                                  Bound{"geom_adhesion", kMaxMagnitude},
                                  Bound{"geom_user", kMaxMagnitude},
                                  Bound{"site_size", 1e5},
                                  Bound{"site_pos", 1e5},
                                  Bound{"site_quat", kMaxMagnitude},
                                  Bound{"site_user", kMaxMagnitude},
                                  Bound{"cam_pos", kMaxMagnitude},
                                  Bound{"cam_quat", kMaxMagnitude},
                                  Bound{"light_pos", kMaxMagnitude},
                                  Bound{"light_dir", kMaxMagnitude},
                                  Bound{"hfield_size", kMaxMagnitude},
                                  Bound{"pair_solref", kMaxMagnitude},
                                  Bound{"pair_solreffriction", kMaxMagnitude},
                                  Bound{"pair_solimp", kMaxMagnitude},
                                  Bound{"pair_margin", kMaxMagnitude},
                                  Bound{"pair_gap", kMaxMagnitude},
                                  Bound{"pair_friction", kMaxMagnitude},
                                  Bound{"eq_solref", kMaxMagnitude},
                                  Bound{"eq_solimp", kMaxMagnitude},
                                  Bound{"eq_data", kMaxMagnitude},
                                  Bound{"tendon_width", kMaxMagnitude},
                                  Bound{"tendon_solref_lim", kMaxMagnitude},
                                  Bound{"tendon_solimp_lim", kMaxMagnitude},
                                  Bound{"tendon_solref_fri", kMaxMagnitude},
                                  Bound{"tendon_solimp_fri", kMaxMagnitude},
                                  Bound{"tendon_range", kMaxMagnitude},
                                  Bound{"tendon_actfrcrange", kMaxMagnitude},
                                  Bound{"tendon_margin", kMaxMagnitude},
                                  Bound{"tendon_stiffness", 1e9},
                                  Bound{"tendon_stiffnesspoly", 1e12},
                                  Bound{"tendon_damping", 1e7},
                                  Bound{"tendon_dampingpoly", kMaxMagnitude},
                                  Bound{"tendon_armature", 1e6},
                                  Bound{"tendon_frictionloss", kMaxMagnitude},
                                  Bound{"tendon_lengthspring", kMaxMagnitude},
                                  Bound{"tendon_springyield", kMaxMagnitude},
                                  Bound{"tendon_user", kMaxMagnitude},
                                  Bound{"wrap_prm", kMaxMagnitude},
                                  Bound{"actuator_cranklength", kMaxMagnitude},
                                  Bound{"actuator_dynprm", kMaxMagnitude},
                                  Bound{"actuator_gainprm", kMaxMagnitude},
                                  Bound{"actuator_biasprm", kMaxMagnitude},
                                  Bound{"actuator_actrange", kMaxMagnitude},
                                  Bound{"actuator_delay", kMaxMagnitude},
                                  Bound{"actuator_damping", 1e7},
                                  Bound{"actuator_dampingpoly", kMaxMagnitude},
                                  Bound{"actuator_armature", 1e6},
                                  Bound{"actuator_user", kMaxMagnitude},
                                  Bound{"actuator_forcerange", kMaxMagnitude},
                                  Bound{"actuator_ctrlrange", 1e7},
                                  Bound{"actuator_gear", kMaxMagnitude},
                                  Bound{"actuator_lengthrange", kMaxMagnitude},
                                  Bound{"key_time", kMaxMagnitude},
                                  Bound{"key_qpos", 1e6},
                                  Bound{"key_qvel", kMaxMagnitude},
                                  Bound{"key_act", kMaxMagnitude},
                                  Bound{"key_mpos", kMaxMagnitude},
                                  Bound{"key_mquat", kMaxMagnitude},
                                  Bound{"key_ctrl", kMaxMagnitude}};
/// Arrays whose numbers must not be negative; negative numbers would add energy to the simulation.
constexpr std::array<std::string_view, 9> kNonNegative{
    "jnt_stiffness",  "dof_damping",     "dof_armature",     "dof_frictionloss", "tendon_stiffness",
    "tendon_damping", "tendon_armature", "actuator_damping", "actuator_armature"};

template <std::size_t count>
const Bound* FindBound(std::string_view name, const std::array<Bound, count>& bounds) {
  const auto found = std::find_if(bounds.begin(), bounds.end(),
                                  [&](const Bound& bound) { return bound.name == name; });
  return found == bounds.end() ? nullptr : &*found;
}

class ModelChecker {
 public:
  ModelChecker(const mjModel& model, const std::string& file) : m_(model), file_(file) {}

  void Check() {
    CheckArrays();
    CheckCustom();
    CheckOptions();
    CheckJointNames();
    CheckActuators();
    if (!problems_.empty()) {
      throw InputError(FirstOf(std::move(problems_)));
    }
  }

 private:
  /// Keeps only the first problems of an array, since an invalid number is often repeated in many
  /// of its rows.
  static std::vector<Problem> FirstOf(std::vector<Problem> problems) {
    constexpr std::size_t kMaxProblems = 20;
    problems.resize(std::min(problems.size(), kMaxProblems));
    return problems;
  }

  void AddError(std::string name, std::string message) {
    problems_.push_back({file_, 0, 0, std::move(name), std::move(message)});
  }

  /// Returns the name of an object, or a text such as "joint 3" if the object has no name.
  [[nodiscard]] std::string Named(int type, const char* kind, int id) const {
    const char* name = mj_id2name(&m_, type, id);
    return name == nullptr ? fmt::format("{} {}", kind, id) : name;
  }

  /// Returns the name of the object that is described by row `row` of an array. `rows` is the name
  /// of the mjModel field with the number of rows.
  [[nodiscard]] std::string Owner(std::string_view rows, int row) const {
    struct Kind {
      std::string_view rows;
      int type;
      const char* name;
    };
    constexpr std::array kKinds{
        Kind{"nbody", mjOBJ_BODY, "body"},        Kind{"njnt", mjOBJ_JOINT, "joint"},
        Kind{"ngeom", mjOBJ_GEOM, "geom"},        Kind{"nsite", mjOBJ_SITE, "site"},
        Kind{"nu", mjOBJ_ACTUATOR, "actuator"},   Kind{"nactuator", mjOBJ_ACTUATOR, "actuator"},
        Kind{"nout", mjOBJ_ACTUATOR, "actuator"}, Kind{"ntendon", mjOBJ_TENDON, "tendon"},
        Kind{"neq", mjOBJ_EQUALITY, "equality"},  Kind{"nkey", mjOBJ_KEY, "keyframe"},
        Kind{"nmesh", mjOBJ_MESH, "mesh"},        Kind{"ncam", mjOBJ_CAMERA, "camera"}};
    if (rows == "nv") {
      return Named(mjOBJ_JOINT, "joint", m_.dof_jntid[row]);
    }
    for (const Kind& kind : kKinds) {
      if (kind.rows == rows) {
        return Named(kind.type, kind.name, row);
      }
    }
    return fmt::format("{} {}", rows, row);
  }

  void CheckArray(std::string_view array, std::string_view rows, const mjtNum* numbers,
                  int row_count, int columns) {
    const Bound* bound = FindBound(array, kModelBounds);
    if (bound == nullptr) {
      return;
    }
    const double largest = bound->largest;
    const bool non_negative =
        std::find(kNonNegative.begin(), kNonNegative.end(), array) != kNonNegative.end();
    const bool is_inertia = array == "body_mass" || array == "body_inertia";
    for (int i = 0; i < row_count * columns; ++i) {
      const double number = numbers[i];
      // Skip bodies that are fixed to the world, such as walls: they never accelerate.
      if (is_inertia && m_.body_weldid[i / columns] == 0 && std::isfinite(number)) {
        continue;
      }
      if (!(std::abs(number) <= largest) || (non_negative && number < 0.0)) {
        AddError(Owner(rows, i / columns),
                 fmt::format("{} is {:g}; must be {}", array, number,
                             non_negative ? fmt::format("from 0 to {:g}", largest)
                                          : fmt::format("within {:g} of 0", largest)));
      }
    }
  }

  /// Skips arrays of the model that contain indices, flags, or numbers used only for drawing.
  template <typename Other>
  void CheckArray(std::string_view, std::string_view, const Other*, int, int) {}

  void CheckArrays() {
    const mjModel* m = &m_;
    // Since MuJoCo 3.11, the sizes in mjModel have 64 bits, but the macro MJMODEL_POINTERS still
    // uses 32-bit sizes.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
    MJMODEL_POINTERS_PREAMBLE(m)
#pragma GCC diagnostic pop
#define X(type, name, rows, columns) \
  CheckArray(#name, #rows, m->name, static_cast<int>(m->rows), columns);
    MJMODEL_POINTERS
#undef X
  }

  void CheckCustom() {
    for (int id = 0; id < m_.nnumeric; ++id) {
      const std::string name = Named(mjOBJ_NUMERIC, "numeric", id);
      const bool is_coefficient = name.size() > 2 && name[1] == '_' &&
                                  std::string_view("pqrstl").find(name[0]) != std::string::npos;
      const Bound* bound = FindBound(name, kCustomBounds);
      const double largest = bound != nullptr ? bound->largest
                             : is_coefficient ? kMaxCoefficient
                                              : kMaxMagnitude;
      for (int i = 0; i < m_.numeric_size[id]; ++i) {
        const double number = m_.numeric_data[m_.numeric_adr[id] + i];
        if (!(std::abs(number) <= largest)) {
          AddError(name, fmt::format("is {:g}; must be within {:g} of 0", number, largest));
        }
      }
    }
  }

  void CheckOptions() {
    const mjOption& option = m_.opt;
    const mjtNum* g = option.gravity;
    if (!(g[0] == 0.0 && g[1] == 0.0 && g[2] < 0.0 && g[2] >= -100.0)) {
      AddError("option", fmt::format("gravity {:g} {:g} {:g} must point down, 0 0 -9.81, with at "
                                     "most 100 m/s^2",
                                     g[0], g[1], g[2]));
    }
    const auto check = [&](const char* name, double number, double largest) {
      if (!(number >= 0.0 && number <= largest)) {
        AddError("option",
                 fmt::format("{} is {:g}; must be from 0 to {:g}", name, number, largest));
      }
    };
    check("density", option.density, 2000.0);
    check("viscosity", option.viscosity, 10.0);
    for (const mjtNum wind : option.wind) {
      check("wind", std::abs(wind), 100.0);
    }
    check("impratio", option.impratio, 1e4);
  }

  /// Joint names become column names of CSV files, followed by the unit.
  void CheckJointNames() {
    // column names that are reserved for the chassis position
    std::set<std::string, std::less<>> taken{"x", "y", "z"};
    for (int joint = 0; joint < m_.njnt; ++joint) {
      const int type = m_.jnt_type[joint];
      if (type != mjJNT_HINGE && type != mjJNT_SLIDE) {
        continue;
      }
      const std::string name = Named(mjOBJ_JOINT, "joint", joint);
      const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view(" _.:-").find(static_cast<char>(c)) != std::string_view::npos;
      };
      if (!std::all_of(name.begin(), name.end(), plain)) {
        AddError(name,
                 "the joint's name is a column of logs; must have letters, digits, spaces and "
                 "_ . : - only");
      } else if (type == mjJNT_SLIDE && !taken.insert(name).second) {
        AddError(name, "the joint's column would be that of the chassis' position; rename it");
      }
    }
  }

  /// Each actuator must have one control, so that the indices of actuators and controls agree.
  void CheckActuators() {
    if (!mj::HasOneControlEach(m_)) {
      AddError("actuator",
               "an actuator has several controls or forces (gain type so3, or on a ball joint); "
               "must have one of each");
    }
  }

  const mjModel& m_;
  const std::string& file_;
  std::vector<Problem> problems_;
};

}  // namespace

void CheckModel(const mjModel& model, const std::string& file) {
  ModelChecker(model, file).Check();
}

}  // namespace trackbed
