#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>

namespace trackbed::render {

/// Owns an mjvScene and frees the scene on destruction.
class SceneHandle {
 public:
  SceneHandle(const mjModel& model, std::int64_t max_geoms) {
    mjv_defaultScene(&scene_);
    mjv_makeScene(&model, &scene_, static_cast<int>(max_geoms));
  }
  ~SceneHandle() { mjv_freeScene(&scene_); }
  SceneHandle(const SceneHandle&) = delete;
  SceneHandle& operator=(const SceneHandle&) = delete;

  [[nodiscard]] mjvScene& get() { return scene_; }

 private:
  mjvScene scene_;
};

}  // namespace trackbed::render
