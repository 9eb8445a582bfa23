#include "src/scenario/scenario_yaml.h"

#include "src/scenario/local_origin.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_writer.h"

namespace trackbed {

std::string YamlOf(const Scenario& resolved) {
  Scenario written = InFileCoordinates(resolved, /*with_files=*/false);
  YAML::Emitter out;
  out << YAML::BeginMap;
  YamlWriter writer(out);
  Visit(writer, written);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace trackbed
