#include "render/car_box.h"

#include <optional>

namespace trackbed::render {
namespace {

/// Returns the x coordinate of the rear end of the trailer in the vehicle frame, at a hitch angle
/// of 0 [m]; nullopt without a trailer.
std::optional<double> TrailerEnd(const mjModel& model) {
  const int body = mj_name2id(&model, mjOBJ_BODY, "trailer");
  std::optional<double> end;
  for (int geom = 0; body >= 0 && geom < model.ngeom; ++geom) {
    if (model.geom_bodyid[geom] == body && model.geom_type[geom] == mjGEOM_BOX) {
      const double own =
          model.body_pos[3 * body] + model.geom_pos[3 * geom] - model.geom_size[3 * geom];
      end = std::min(end.value_or(own), own);
    }
  }
  return end;
}

}  // namespace

CarBox FindCarBox(const mjModel& model) {
  const int site = mj_name2id(&model, mjOBJ_SITE, "footprint");
  if (site < 0 || model.site_type[site] != mjGEOM_BOX) {
    return {};
  }
  const mjtNum* size = model.site_size + 3 * site;
  const double middle = model.site_pos[3 * site];
  const double rear = middle - size[0];
  return {.middle = middle,
          .half_length = size[0],
          .half_width = size[1],
          .height = 2.0 * size[2],
          .towed = rear - TrailerEnd(model).value_or(rear)};
}

}  // namespace trackbed::render
