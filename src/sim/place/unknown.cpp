#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// A program that was linked to static libraries without CMake: nothing says where the package is.
const char* PlaceOfData() {
  throw InputError(Problem{
      .message = "the folder of models/ and scenarios/ is not known: set the environment variable "
                 "TRACKBED_DATA to it (`pkg-config --variable=pkgdatadir trackbed` prints it)"});
}

}  // namespace trackbed
