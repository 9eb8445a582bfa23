#pragma once

#include <memory>

struct mjModel_;
struct mjData_;

namespace trackbed {

/// MuJoCo's models and data that free themselves.
struct MujocoDeleter {
  void operator()(mjModel_* model) const;
  void operator()(mjData_* data) const;
};
using MujocoModel = std::unique_ptr<mjModel_, MujocoDeleter>;
using MujocoData = std::unique_ptr<mjData_, MujocoDeleter>;

/// A copy of the model; RunError when there is no memory for it.
MujocoModel CopyMujocoModel(const mjModel_& model);

/// Data for the model, in its initial configuration; RunError when there is no memory for it.
MujocoData MakeMujocoData(const mjModel_& model);

}  // namespace trackbed
