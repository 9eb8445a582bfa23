#include "src/sim/tyre_reader.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <vector>

#include "src/sim/car_parts.h"
#include "trackbed/core/spelling.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {
namespace {

/// Returns the three names of a tyre coefficient: for both axles, for the front axle and for the
/// rear axle.
std::array<std::string, 3> CoefficientNames(const MagicFormulaField& field) {
  const std::string name = field.name;
  return {name, name + "_front", name + "_rear"};
}

/// Adds an error for each tyre coefficient whose name is unknown, which is either misspelled or not
/// supported.
void CheckNames(const Numerics& numerics) {
  std::vector<std::string> known;
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    const auto names = CoefficientNames(field);
    known.insert(known.end(), names.begin(), names.end());
  }
  const mjModel& model = numerics.model();
  for (int id = 0; id < model.nnumeric; ++id) {
    const std::string name = model.names + model.name_numericadr[id];
    const bool is_coefficient = name.size() > 2 && name[1] == '_' &&
                                std::string("pqrstl").find(name[0]) != std::string::npos;
    if (is_coefficient && std::find(known.begin(), known.end(), name) == known.end()) {
      numerics.AddError(name, "unknown tyre coefficient " + UnknownName(name, known));
    }
  }
}

void CheckTyre(const Numerics& numerics, const MagicFormula& tyre, const char* axle) {
  const auto need = [&](bool holds, const char* name, const char* what, double found) {
    if (!holds) {
      numerics.AddError(fmt::format("{} ({})", name, axle),
                        fmt::format("must be {}, found {:.4g}", what, found));
    }
  };
  need(tyre.p_cx1 > 0.0, "p_cx1", "above 0", tyre.p_cx1);
  need(tyre.p_dx1 > 0.0, "p_dx1", "above 0", tyre.p_dx1);
  need(tyre.p_kx1 > 0.0, "p_kx1", "above 0", tyre.p_kx1);
  need(tyre.p_cy1 > 0.0, "p_cy1", "above 0", tyre.p_cy1);
  need(tyre.p_dy1 > 0.0, "p_dy1", "above 0", tyre.p_dy1);
  need(tyre.p_ky1 < 0.0, "p_ky1",
       "below 0: a positive slip angle, with the tyre moving to the left, gives a force to the "
       "right",
       tyre.p_ky1);
  need(tyre.p_ky2 >= 0.0, "p_ky2", "at least 0", tyre.p_ky2);
  need(tyre.p_ky4 > 0.0, "p_ky4", "above 0", tyre.p_ky4);
  need(tyre.version == 0.0 || tyre.version == 5.2 || tyre.version == 6.1, "magic_formula_version",
       "0, 5.2 or 6.1", tyre.version);
  need(tyre.camber_max > 0.0, "camber_max", "above 0", tyre.camber_max);
  need(tyre.relaxation_length > 0.0, "relaxation_length", "above 0", tyre.relaxation_length);
  need(tyre.relaxation_length_x >= 0.0, "relaxation_length_x", "at least 0",
       tyre.relaxation_length_x);
  need(tyre.rolling_resistance >= 0.0, "rolling_resistance", "at least 0", tyre.rolling_resistance);
  const bool needs_load = tyre.p_ky2 != 0.0 || tyre.p_dx2 != 0.0 || tyre.p_dy2 != 0.0 ||
                          tyre.p_kx2 != 0.0 || tyre.p_kx3 != 0.0 || tyre.p_ky7 != 0.0;
  need(tyre.f_z0 >= 0.0 && (tyre.f_z0 > 0.0 || !needs_load), "F_z0",
       "above 0: p_ky2, p_dx2 and p_dy2 need the nominal load", tyre.f_z0);
}

}  // namespace

bool Numerics::Has(const std::string& name) const {
  return mj_name2id(&model_, mjOBJ_NUMERIC, name.c_str()) >= 0;
}

const double* Numerics::Find(const std::string& name, int count) const {
  const int id = mj_name2id(&model_, mjOBJ_NUMERIC, name.c_str());
  if (id >= 0 && model_.numeric_size[id] != count) {
    AddError(name, fmt::format("has {} numbers; must have {}", model_.numeric_size[id], count));
    return nullptr;
  }
  return id < 0 ? nullptr : model_.numeric_data + model_.numeric_adr[id];
}

std::span<const double> Numerics::List(const std::string& name) const {
  const int id = mj_name2id(&model_, mjOBJ_NUMERIC, name.c_str());
  return id < 0 ? std::span<const double>{}
                : std::span(model_.numeric_data + model_.numeric_adr[id],
                            static_cast<std::size_t>(model_.numeric_size[id]));
}

void Numerics::Read(const std::string& name, double& value) const {
  if (const double* number = Find(name, 1)) {
    value = *number;
  }
}

std::optional<CarTyres> ReadTyres(const Numerics& numerics) {
  CarTyres tyres;
  bool any = false;
  std::vector<std::string> missing;
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    const auto [both, front, rear] = CoefficientNames(field);
    const std::string own[] = {front, rear};
    for (std::size_t axle = 0; axle < tyres.axle.size(); ++axle) {
      double& value = tyres.axle[axle].*field.value;
      numerics.Read(both, value);
      numerics.Read(own[axle], value);
      const bool given = numerics.Has(both) || numerics.Has(own[axle]);
      // The model describes a tyre if it has a coefficient of the Magic Formula; other tyre numbers
      // such as the relaxation length alone do not describe a tyre.
      any = any || (given && (both.starts_with("p_") || both.starts_with("r_")));
      if (field.required && !given) {
        missing.push_back(own[axle]);
      }
    }
  }
  CheckNames(numerics);
  numerics.Read("camber_gain_front", tyres.camber_gain[0]);
  numerics.Read("camber_gain_rear", tyres.camber_gain[1]);
  numerics.Read("tyre_vertical_stiffness", tyres.vertical_stiffness);
  numerics.Read("tyre_vertical_damping", tyres.vertical_damping);
  if (!any) {
    return std::nullopt;
  }
  for (const std::string& name : missing) {
    numerics.AddError(name, fmt::format("missing; a tyre needs {}", kNeededCoefficients));
  }
  if (missing.empty()) {
    CheckTyre(numerics, tyres.axle[0], "front");
    CheckTyre(numerics, tyres.axle[1], "rear");
  }
  return tyres;
}

}  // namespace trackbed
