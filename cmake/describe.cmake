set(described ${VERSION})
if(GIT)
  execute_process(
    COMMAND ${GIT} -C ${SOURCE_DIR} describe --tags --always --dirty
    OUTPUT_VARIABLE git_says
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
    RESULT_VARIABLE failed)
  if(NOT failed AND git_says)
    set(described "${VERSION} (${git_says})")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#include "trackbed/core/version.h"

namespace trackbed {

const char* Version() { return "@described@"; }

}  // namespace trackbed
]] @ONLY)
