#include "trackbed/scenario/log_map_text.h"

#include <yaml-cpp/yaml.h>

#include "src/scenario/yaml_writer.h"

namespace trackbed {

std::string LogMapText(LogMap map) {
  YAML::Emitter out;
  YamlWriter writer(out);
  out << YAML::BeginMap;
  Visit(writer, map);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace trackbed
