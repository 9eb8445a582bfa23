#include "trackbed/analysis/json_file.h"

#include <nlohmann/json.hpp>

#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/file.h"

namespace trackbed {

using nlohmann::ordered_json;

void VisitJson(const std::filesystem::path& file,
               const std::function<void(const ordered_json&)>& visit, Problem problem) {
  try {
    visit(ordered_json::parse(ReadFile(run_folder::RequireFile(file))));
  } catch (const nlohmann::json::exception& error) {
    problem.file = file.string();
    if (problem.message.empty()) {
      problem.message = error.what();
    }
    throw InputError(std::move(problem));
  }
}

std::vector<Vec2> GateCones(const ordered_json& plan) {
  std::vector<Vec2> cones;
  for (const ordered_json& gate : plan.value("gates", ordered_json::array())) {
    for (const ordered_json& cone : gate.at("cones_m")) {
      cones.emplace_back(cone.at(0).get<double>(), cone.at(1).get<double>());
    }
  }
  return cones;
}

}  // namespace trackbed
