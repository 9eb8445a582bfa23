#include "src/report/scene_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "src/report/base64.h"
#include "src/report/numbers.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/sim/vehicle_shape.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

template <typename Numbers>
ordered_json RoundedList(const Numbers& values) {
  ordered_json json = ordered_json::array();
  for (const double value : values) {
    json.push_back(Rounded(value));
  }
  return json;
}

ordered_json JointJson(const ShapeJoint& joint) {
  if (joint.type == ShapeJoint::Type::kFree) {
    return {{"type", "free"}};
  }
  return {{"type", joint.type == ShapeJoint::Type::kSlide ? "slide" : "hinge"},
          {"axis", RoundedList(joint.axis)},
          {"pos", RoundedList(joint.anchor)},
          {"channel", joint.channel}};
}

template <typename Word>
void AppendLittleEndian(Word word, std::string& bytes) {
  for (std::size_t i = 0; i < sizeof(Word); ++i) {
    bytes += static_cast<char>((std::uint32_t{word} >> (8U * i)) & 0xFFU);
  }
}

std::string Floats(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    AppendLittleEndian(std::bit_cast<std::uint32_t>(static_cast<float>(value)), bytes);
  }
  return Base64(bytes);
}

}  // namespace

ordered_json FloatsJson(const std::vector<double>& values) {
  return {{"f4", Floats(values)}};
}

ordered_json ChannelJson(const std::vector<double>& values) {
  // coarsest acceptable resolution of the int16 format [m], [rad]; one millimeter is less than a
  // pixel
  constexpr double kFine = 1e-3;
  constexpr double kSteps = 65535.0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (values.empty() || *high - *low > kSteps * kFine) {
    return FloatsJson(values);
  }
  // If all values of a channel are equal, the scale and all integers of its encoding are 0.
  const double scale = (*high - *low) / kSteps;
  const double middle = 0.5 * (*high + *low);
  std::string bytes;
  for (const double value : values) {
    const double steps = scale > 0.0 ? std::round((value - middle) / scale) : 0.0;
    const auto whole = static_cast<std::int16_t>(std::clamp(steps, -32767.0, 32767.0));
    AppendLittleEndian(static_cast<std::uint16_t>(whole), bytes);
  }
  return {{"i2", Base64(bytes)}, {"offset", middle}, {"scale", scale}};
}

ordered_json VehicleJson(const fs::path& file) {
  const VehicleShape shape =
      ReadVehicleShape(ComposeScene(run_folder::RequireFile(file), {}), file.string());
  ordered_json json{{"bodies", ordered_json::array()},
                    {"geoms", ordered_json::array()},
                    {"meshes", ordered_json::array()}};
  for (const ShapeBody& body : shape.bodies) {
    ordered_json joints = ordered_json::array();
    std::transform(body.joints.begin(), body.joints.end(), std::back_inserter(joints), JointJson);
    json["bodies"].push_back({{"parent", body.parent},
                              {"pos", RoundedList(body.position)},
                              {"quat", RoundedList(body.quaternion)},
                              {"joints", joints}});
  }
  for (const ShapeGeom& geom : shape.geoms) {
    json["geoms"].push_back({{"body", geom.body},
                             {"type", geom.type},
                             {"size", RoundedList(geom.size)},
                             {"pos", RoundedList(geom.position)},
                             {"quat", RoundedList(geom.quaternion)},
                             {"rgba", RoundedList(geom.rgba)},
                             {"mesh", geom.mesh}});
  }
  for (const ShapeMesh& mesh : shape.meshes) {
    json["meshes"].push_back({{"vertices", RoundedList(mesh.vertices)}, {"faces", mesh.faces}});
  }
  return json;
}

std::vector<std::size_t> RowsOfMotion(const std::vector<double>& times, std::size_t row_limit) {
  if (times.empty()) {
    return {};
  }
  constexpr double kRate = 30.0;  // [1/s]
  const double duration = times.back() - times.front();
  const double most = std::min(static_cast<double>(std::max<std::size_t>(row_limit, 2)),
                               std::max(2.0, std::ceil(duration * kRate)));
  const auto step =
      static_cast<std::size_t>(std::max(1.0, std::ceil(static_cast<double>(times.size()) / most)));
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < times.size(); row += step) {
    rows.push_back(row);
  }
  if (rows.back() + 1 < times.size()) {
    rows.push_back(times.size() - 1);
  }
  return rows;
}

ordered_json MotionJson(const fs::path& states, const ordered_json& vehicle, const World& world,
                        std::size_t row_limit) {
  std::vector<std::string> joints;
  for (const ordered_json& body : vehicle.at("bodies")) {
    for (const ordered_json& joint : body.at("joints")) {
      if (joint.contains("channel")) {
        joints.push_back(joint.at("channel").get<std::string>());
      }
    }
  }
  const Table table = ReadCsvExcerpt(run_folder::RequireFile(states),
                                     {"t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"}, joints)
                          .table;
  const std::vector<double> times = table.Column("t_s");
  if (times.empty()) {
    throw InputError(Problem{.file = states.string(), .message = "no rows"});
  }
  const std::vector<std::size_t> rows = RowsOfMotion(times, row_limit);
  const auto chosen = [&](const std::string& column) {
    const std::vector<double> all = table.Column(column);
    std::vector<double> values;
    for (const std::size_t row : rows) {
      values.push_back(all[row]);
    }
    return values;
  };
  ordered_json json{{"t", FloatsJson(chosen("t_s"))}, {"channels", ordered_json::object()}};
  for (const std::string& column : table.columns()) {
    if (column != "t_s") {
      json["channels"][column] = ChannelJson(chosen(column));
    }
  }
  if (!IsCalm(world.wind)) {
    const std::vector<double> x = chosen("x_m");
    const std::vector<double> y = chosen("y_m");
    const std::vector<double> t = chosen("t_s");
    std::vector<double> wind_x;
    std::vector<double> wind_y;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const Vec2 wind = WindAt(world, Vec2(x[i], y[i]), t[i]);
      wind_x.push_back(wind.x());
      wind_y.push_back(wind.y());
    }
    json["wind"] = {{"x", ChannelJson(wind_x)}, {"y", ChannelJson(wind_y)}};
  }
  return json;
}

ordered_json GroundJson(const World& world, double low_x, double low_y, double high_x,
                        double high_y) {
  if (IsFlat(world.ground)) {
    return nullptr;
  }
  constexpr double kMargin = 60.0;  // width of the visible ground around the driven paths [m]
  constexpr double kMaxGridLines = 160.0;
  const double span = std::max(high_x - low_x, high_y - low_y) + 2.0 * kMargin;
  const double step = std::max(1.0, span / kMaxGridLines);
  const auto count = [&](double low, double high) {
    return static_cast<int>(std::ceil((high - low + 2.0 * kMargin) / step)) + 1;
  };
  const int columns = count(low_x, high_x);
  const int lines = count(low_y, high_y);
  std::vector<double> heights;
  for (int line = 0; line < lines; ++line) {
    for (int column = 0; column < columns; ++column) {
      heights.push_back(GroundHeight(
          world, Vec2(low_x - kMargin + step * column, low_y - kMargin + step * line)));
    }
  }
  return {{"x", Rounded(low_x - kMargin)},
          {"y", Rounded(low_y - kMargin)},
          {"step", Rounded(step)},
          {"columns", columns},
          {"z", ChannelJson(heights)}};
}

}  // namespace trackbed
