#include "render/runtime_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

TEST(RuntimeLibrary, FindsFunctions) {
  const RuntimeLibrary library("libm.so.6", "libc6");
  EXPECT_EQ(library.Find<double(double)>("floor")(2.5), 2.0);
}

TEST(RuntimeLibrary, NamesWhatIsMissing) {
  const auto message = [](auto load) -> std::string {
    try {
      load();
    } catch (const RunError& error) {
      return error.what();
    }
    return "no RunError";
  };
  EXPECT_THAT(message([] { RuntimeLibrary("libnowhere.so.3", "libnowhere3"); }),
              testing::StartsWith(
                  "cannot load libnowhere.so.3 (Debian's package libnowhere3): libnowhere.so.3: "));
  const RuntimeLibrary library("libm.so.6", "libc6");
  EXPECT_THAT(message([&] { static_cast<void>(library.Find<int()>("no_such_function")); }),
              testing::HasSubstr("no_such_function"));
}

}  // namespace
}  // namespace trackbed::render
