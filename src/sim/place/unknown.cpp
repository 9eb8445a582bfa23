#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// Used by a program linked to static libraries without CMake, for which the package's folder is
/// unknown.
const char* PlaceOfData() {
  throw InputError(Problem{
      .message = "the folder of models/ and scenarios/ is not known: set the environment variable "
                 "TRACKBED_DATA to it (`pkg-config --variable=pkgdatadir trackbed` prints it)"});
}

}  // namespace trackbed
