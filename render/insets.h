#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// A two-dimensional view that an inset can show instead of a second camera.
struct FlatView {
  std::string_view name;
  std::string_view summary;
  /// Draws the recording at `time` [s] in this view, into the picture.
  void (*draw)(const Recording& recording, Image& image, Font& font, double time);
};

/// Returns the registry of flat views.
const std::vector<FlatView>& FlatViewTable();

/// Content of an inset: either a camera or a flat view.
struct Inset {
  const Camera* camera = nullptr;
  const FlatView* view = nullptr;
};

/// Finds a camera or a flat view by name. If no camera or view has this name, throws InputError for
/// the option `inset`, which suggests the most similar name.
Inset FindInset(const std::string& name);

}  // namespace trackbed::render
