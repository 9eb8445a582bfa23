#pragma once

#include <mujoco/mujoco.h>

#include <concepts>

/// Hides the API differences between MuJoCo versions from the drawing functions. The API
/// differences that concern the simulation are handled in src/sim/mujoco_compat.h.
namespace trackbed::render::mj {

/// Returns the index of a material's color texture; -1 if the material has no color texture. Since
/// MuJoCo 3.2, a material can have several textures, one per role.
inline int ColorTexture(const mjModel& model, int material) {
#if mjVERSION_HEADER >= 320
  const int* of_roles = model.mat_texid + mjNTEXROLE * material;
  return of_roles[mjTEXROLE_RGB] >= 0 ? of_roles[mjTEXROLE_RGB] : of_roles[mjTEXROLE_RGBA];
#else
  return model.mat_texid[material];
#endif
}

/// Pixel values of a texture, row by row.
struct TexturePixels {
  mjtByte* first;
  int channels;  ///< number of bytes per pixel; the first three bytes are red, green and blue
};

template <std::same_as<mjModel> Model>
TexturePixels Pixels(Model& model, int texture) {
  if constexpr (requires { model.tex_data; }) {
    return {model.tex_data + model.tex_adr[texture], model.tex_nchannel[texture]};
  } else {
    return {model.tex_rgb + model.tex_adr[texture], 3};
  }
}

/// Removes the texture from a shape. RemoveTexture removes the shape's material, because since
/// MuJoCo 3.2 the texture belongs to the material.
template <std::same_as<mjvGeom> Geom>
void RemoveTexture(Geom& geom) {
  if constexpr (requires { geom.matid; }) {
    geom.matid = -1;
  }
  if constexpr (requires { geom.texid; }) {
    geom.texid = -1;
  }
}

template <std::same_as<mjvLight> Light>
bool IsDirectional(const Light& light) {
  if constexpr (requires { light.directional; }) {
    return light.directional != 0;
  } else {
    constexpr int kDirectional = 1;  // mjLIGHT_DIRECTIONAL
    return light.type == kDirectional;
  }
}

}  // namespace trackbed::render::mj
