#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <string>

#include "render/image.h"

namespace trackbed::render {

/// Decodes a picture with libpng; png_test uses another reader.
inline Image DecodePng(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Image image;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0) {
    png.format = PNG_FORMAT_RGB;
    image.Resize(static_cast<int>(png.width), static_cast<int>(png.height));
    png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr);
  }
  EXPECT_STREQ(png.message, "");
  return image;
}

}  // namespace trackbed::render
