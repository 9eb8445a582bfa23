#include <gtest/gtest.h>

#include "render/camera.h"
#include "trackbed/scenario/cameras.h"

namespace trackbed::render {
namespace {

TEST(CameraTable, PlacesEveryCameraThatScenariosMayName) {
  ASSERT_EQ(CameraTable().size(), CameraNames().size());
  for (std::size_t i = 0; i < CameraTable().size(); ++i) {
    EXPECT_EQ(CameraTable()[i].name, CameraNames()[i].name);
  }
}

}  // namespace
}  // namespace trackbed::render
