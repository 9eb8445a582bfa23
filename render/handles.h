#pragma once

#include <mujoco/mujoco.h>

#include <memory>

namespace trackbed::render {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelHandle = std::unique_ptr<mjModel, FreeModel>;
using DataHandle = std::unique_ptr<mjData, FreeData>;

/// mjvScene that frees itself.
class SceneHandle {
 public:
  SceneHandle(const mjModel& model, int max_geoms) {
    mjv_defaultScene(&scene_);
    mjv_makeScene(&model, &scene_, max_geoms);
  }
  ~SceneHandle() { mjv_freeScene(&scene_); }
  SceneHandle(const SceneHandle&) = delete;
  SceneHandle& operator=(const SceneHandle&) = delete;

  [[nodiscard]] mjvScene& get() { return scene_; }

 private:
  mjvScene scene_;
};

/// While one lives, an error inside MuJoCo is a RunError and its warnings are dropped; before and
/// after, MuJoCo's handlers are whatever they were. MuJoCo's own handler would wait for a key, and
/// its warnings would go to a file in the current folder.
class MuJoCoErrorsAsExceptions {
 public:
  MuJoCoErrorsAsExceptions();
  ~MuJoCoErrorsAsExceptions();
  MuJoCoErrorsAsExceptions(const MuJoCoErrorsAsExceptions&) = delete;
  MuJoCoErrorsAsExceptions& operator=(const MuJoCoErrorsAsExceptions&) = delete;

 private:
  void (*error_)(const char*);
  void (*warning_)(const char*);
};

}  // namespace trackbed::render
