#pragma once

#include <memory>

struct mjModel_;
struct mjData_;

namespace trackbed {

/// Defines owning pointers to MuJoCo's models and data.
struct MujocoDeleter {
  void operator()(mjModel_* model) const;
  void operator()(mjData_* data) const;
};
using MujocoModel = std::unique_ptr<mjModel_, MujocoDeleter>;
using MujocoData = std::unique_ptr<mjData_, MujocoDeleter>;

/// Copies a MuJoCo model. Throws RunError if there is not enough memory.
MujocoModel CopyMujocoModel(const mjModel_& model);

/// Creates an mjData for the model, in the initial configuration. Throws RunError if there is not
/// enough memory.
MujocoData MakeMujocoData(const mjModel_& model);

/// Copies the complete state of a simulation of the model. Throws RunError if there is not enough
/// memory.
MujocoData CopyMujocoData(const mjModel_& model, const mjData_& data);

}  // namespace trackbed
