#include "src/sim/object_name.h"

#include <fmt/format.h>

namespace trackbed {

std::string ObjectName(const mjModel& model, int type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name == nullptr || *name == '\0' ? fmt::format("number {}", id)
                                          : fmt::format("'{}'", name);
}

}  // namespace trackbed
