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

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// The largest magnitude that MuJoCo itself computes with.
constexpr double kLargest = 1e10;

/// A bound of the numbers under that name, whatever their sign, well beyond any vehicle.
struct Bound {
  std::string_view name;
  double largest;
};

/// Of numbers under <custom>, SI units.
constexpr std::array kCustomBounds{Bound{"steering_ratio", 1e3},
                                   Bound{"steering_wheel_rate", 1e3},
                                   Bound{"steering_rate", 1e3},
                                   Bound{"turning_radius", 1e3},
                                   Bound{"brake_torque", 1e5},
                                   Bound{"brake_torque_front", 1e5},
                                   Bound{"brake_torque_rear", 1e5},
                                   Bound{"drive_power", 1e7},
                                   Bound{"drag_area", 1e2},
                                   Bound{"side_area", 1e2},
                                   Bound{"center_of_pressure", 1e2},
                                   Bound{"F_z0", 1e6},
                                   Bound{"tyre_vertical_stiffness", 1e8},
                                   Bound{"tyre_vertical_damping", 1e6},
                                   Bound{"relaxation_length", 1e1},
                                   Bound{"rolling_resistance", 1.0},
                                   Bound{"camber_gain_front", 1e1},
                                   Bound{"camber_gain_rear", 1e1}};
constexpr double kLargestCoefficient = 1e3;  // of a tyre's Magic Formula: "p_cx1"

/// Of arrays of the compiled model, SI units.
constexpr std::array kModelBounds{
    Bound{"body_mass", 1e6},         Bound{"body_inertia", 1e9},   Bound{"body_pos", 1e5},
    Bound{"body_ipos", 1e5},         Bound{"jnt_pos", 1e5},        Bound{"jnt_stiffness", 1e9},
    Bound{"dof_damping", 1e7},       Bound{"dof_armature", 1e6},   Bound{"dof_frictionloss", 1e6},
    Bound{"geom_pos", 1e5},          Bound{"geom_size", 1e5},      Bound{"geom_friction", 1e2},
    Bound{"site_pos", 1e5},          Bound{"site_size", 1e5},      Bound{"qpos0", 1e5},
    Bound{"tendon_stiffness", 1e9},  Bound{"tendon_damping", 1e7}, Bound{"key_qpos", 1e6},
    Bound{"actuator_ctrlrange", 1e7}};
/// Those of them that must not be negative: they would feed energy in.
constexpr std::array<std::string_view, 6> kNotNegative{"jnt_stiffness",    "dof_damping",
                                                       "dof_armature",     "dof_frictionloss",
                                                       "tendon_stiffness", "tendon_damping"};

template <std::size_t count>
double BoundOf(std::string_view name, const std::array<Bound, count>& bounds, double otherwise) {
  const auto found = std::find_if(bounds.begin(), bounds.end(),
                                  [&](const Bound& bound) { return bound.name == name; });
  return found == bounds.end() ? otherwise : found->largest;
}

class ModelChecker {
 public:
  ModelChecker(const mjModel& model, const std::string& file) : m_(model), file_(file) {}

  void Check() {
    CheckArrays();
    CheckCustom();
    CheckOptions();
    CheckJointNames();
    if (!problems_.empty()) {
      throw InputError(FirstOf(std::move(problems_)));
    }
  }

 private:
  /// A broken number is often in many rows.
  static std::vector<Problem> FirstOf(std::vector<Problem> problems) {
    constexpr std::size_t kMost = 20;
    problems.resize(std::min(problems.size(), kMost));
    return problems;
  }

  void AddError(std::string name, std::string message) {
    problems_.push_back({file_, 0, 0, std::move(name), std::move(message)});
  }

  /// Its name, or "joint 3".
  [[nodiscard]] std::string Named(int type, const char* kind, int id) const {
    const char* name = mj_id2name(&m_, type, id);
    return name == nullptr ? fmt::format("{} {}", kind, id) : name;
  }

  /// Whose number is in row `row` of an array that has a row for each of `rows`.
  [[nodiscard]] std::string Owner(std::string_view rows, int row) const {
    struct Kind {
      std::string_view rows;
      int type;
      const char* name;
    };
    constexpr std::array kKinds{
        Kind{"nbody", mjOBJ_BODY, "body"},       Kind{"njnt", mjOBJ_JOINT, "joint"},
        Kind{"ngeom", mjOBJ_GEOM, "geom"},       Kind{"nsite", mjOBJ_SITE, "site"},
        Kind{"nu", mjOBJ_ACTUATOR, "actuator"},  Kind{"ntendon", mjOBJ_TENDON, "tendon"},
        Kind{"neq", mjOBJ_EQUALITY, "equality"}, Kind{"nkey", mjOBJ_KEY, "keyframe"},
        Kind{"nmesh", mjOBJ_MESH, "mesh"},       Kind{"ncam", mjOBJ_CAMERA, "camera"}};
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
    // Those of CheckCustom, and what MuJoCo derives from the others.
    constexpr std::array<std::string_view, 8> kOthers{
        "numeric_data", "body_subtreemass",  "body_invweight0", "dof_invweight0",
        "dof_M0",       "tendon_invweight0", "actuator_acc0",   "geom_rbound"};
    if (std::find(kOthers.begin(), kOthers.end(), array) != kOthers.end()) {
      return;
    }
    const double largest = BoundOf(array, kModelBounds, kLargest);
    const bool not_negative =
        std::find(kNotNegative.begin(), kNotNegative.end(), array) != kNotNegative.end();
    for (int i = 0; i < row_count * columns; ++i) {
      const double number = numbers[i];
      if (!(std::abs(number) <= largest) || (not_negative && number < 0.0)) {
        AddError(Owner(rows, i / columns),
                 fmt::format("{} is {:g}; must be {}", array, number,
                             not_negative ? fmt::format("from 0 to {:g}", largest)
                                          : fmt::format("within {:g} of 0", largest)));
      }
    }
  }

  /// Indices, flags and what is only drawn.
  template <typename Other>
  void CheckArray(std::string_view, std::string_view, const Other*, int, int) {}

  void CheckArrays() {
    const mjModel* m = &m_;
    MJMODEL_POINTERS_PREAMBLE(m)
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
      const double largest =
          BoundOf(name, kCustomBounds, is_coefficient ? kLargestCoefficient : kLargest);
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

  /// They are columns of CSV files, before their units.
  void CheckJointNames() {
    std::set<std::string, std::less<>> taken{"x", "y", "z"};  // those of the chassis
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

  const mjModel& m_;
  const std::string& file_;
  std::vector<Problem> problems_;
};

}  // namespace

void CheckModel(const mjModel& model, const std::string& file) {
  ModelChecker(model, file).Check();
}

}  // namespace trackbed
