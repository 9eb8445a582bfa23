#include "trackbed/analysis/mcap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using nlohmann::json;

const std::string kMagic{"\x89MCAP0\r\n"};

/// What stands in a file, read anew after the format's specification.
struct Contents {
  struct Channel {
    std::string topic;
    std::string schema;
  };
  struct Message {
    std::string topic;
    std::uint32_t sequence;
    std::uint64_t time;
    json content;
  };
  std::map<std::uint16_t, std::string> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<Message> messages;
  std::vector<int> codes;  // of all records
};

class Bytes {
 public:
  explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}
  template <typename Number>
  Number Take() {
    Number number = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      number = static_cast<Number>(
          number |
          static_cast<Number>(static_cast<Number>(static_cast<unsigned char>(bytes_.at(at_ + i)))
                              << (8 * i)));
    }
    at_ += sizeof(Number);
    return number;
  }
  std::string Take(std::size_t count) {
    at_ += count;
    EXPECT_LE(at_, bytes_.size());
    return bytes_.substr(at_ - count, count);
  }
  std::string Text() { return Take(Take<std::uint32_t>()); }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

Contents Read(const std::string& file) {
  Contents contents;
  EXPECT_TRUE(file.starts_with(kMagic) && file.ends_with(kMagic));
  Bytes bytes(file.substr(kMagic.size(), file.size() - 2 * kMagic.size()));
  while (bytes.left() > 0) {
    const auto code = bytes.Take<std::uint8_t>();
    Bytes record(bytes.Take(bytes.Take<std::uint64_t>()));
    contents.codes.push_back(code);
    if (code == 0x03) {
      const auto id = record.Take<std::uint16_t>();
      contents.schemas[id] = record.Text();
      EXPECT_EQ(record.Text(), "jsonschema");
      EXPECT_EQ(json::parse(record.Text()).at("type"), "object");
    } else if (code == 0x04) {
      const auto id = record.Take<std::uint16_t>();
      const auto schema = record.Take<std::uint16_t>();
      contents.channels[id] = {record.Text(), contents.schemas.at(schema)};
      EXPECT_EQ(record.Text(), "json");
      EXPECT_EQ(record.Take<std::uint32_t>(), 0U);
    } else if (code == 0x05) {
      const auto channel = record.Take<std::uint16_t>();
      const auto sequence = record.Take<std::uint32_t>();
      const auto time = record.Take<std::uint64_t>();
      EXPECT_EQ(record.Take<std::uint64_t>(), time);
      contents.messages.push_back({contents.channels.at(channel).topic, sequence, time,
                                   json::parse(record.Take(record.left()))});
      continue;
    } else {
      continue;
    }
    EXPECT_EQ(record.left(), 0U);
  }
  return contents;
}

RunResult DriveAndPass() {
  Scenario scenario =
      ReadScenario(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "overtake.yaml");
  scenario.mission.waypoints = {{0.0, 0.0}, {120.0, 0.0}};
  scenario.drive.plants = {"kinematic"};
  scenario.expect = {};
  return RunMission(scenario);
}

TEST(Mcap, HoldsTheRun) {
  const RunResult run = DriveAndPass();
  const RunLog& log = run.logs.at(0);
  const Contents contents = Read(ToMcap(run));
  EXPECT_EQ(contents.codes.front(), 0x01);
  EXPECT_EQ(contents.codes.at(contents.codes.size() - 2), 0x0F);
  EXPECT_EQ(contents.codes.back(), 0x02);
  std::map<std::string, std::vector<const Contents::Message*>> by_topic;
  std::uint64_t before = 0;
  for (const Contents::Message& message : contents.messages) {
    EXPECT_GE(message.time, before);
    before = message.time;
    EXPECT_EQ(message.sequence, by_topic[message.topic].size());
    by_topic[message.topic].push_back(&message);
  }
  ASSERT_EQ(by_topic["/kinematic/tf"].size(), log.rows.size());
  ASSERT_EQ(by_topic["/kinematic/log"].size(), log.rows.size());
  ASSERT_EQ(by_topic["/kinematic/plan"].size(), log.changes.size() + 1);
  EXPECT_EQ(by_topic["/kinematic/footprint"].size(), 1U);
  const Table table = ToTable(log);
  for (const std::size_t i : {std::size_t{0}, log.rows.size() / 3, log.rows.size() - 1}) {
    const VehicleState& state = log.rows[i].state;
    const json& tf = by_topic["/kinematic/tf"][i]->content;
    EXPECT_EQ(tf.at("parent_frame_id"), "world");
    EXPECT_EQ(tf.at("child_frame_id"), "kinematic");
    EXPECT_EQ(tf.at("translation").at("x").get<double>(), state.pose.x);
    const double z = tf.at("rotation").at("z").get<double>();
    const double w = tf.at("rotation").at("w").get<double>();
    EXPECT_NEAR(2.0 * std::atan2(z, w), state.pose.yaw, Tolerance(1e-12));
    const json& time = tf.at("timestamp");
    EXPECT_NEAR(time.at("sec").get<double>() + 1e-9 * time.at("nsec").get<double>(), state.time,
                Tolerance(1e-9));
    EXPECT_NEAR(1e-9 * static_cast<double>(by_topic["/kinematic/tf"][i]->time), state.time,
                Tolerance(1e-9));
    const json& row = by_topic["/kinematic/log"][i]->content;
    EXPECT_EQ(row.size(), table.columns().size());
    for (std::size_t column = 0; column < table.columns().size(); ++column) {
      const json& cell = row.at(table.columns()[column]);
      if (!cell.is_null()) {  // JSON knows no NaN
        EXPECT_EQ(cell.get<double>(), table.at(i, column));
      }
    }
  }
  // The car ahead, 5 m/s along x from 50 m on.
  const auto& boxes = by_topic["/obstacles"];
  ASSERT_GT(boxes.size(), 20U);
  const json& cube = boxes[20]->content.at("entities").at(0).at("cubes").at(0);
  EXPECT_NEAR(cube.at("pose").at("position").at("x").get<double>(), 60.0, Tolerance(1e-9));
  EXPECT_EQ(cube.at("size").at("z").get<double>(), 1.5);
  std::set<std::string> schemas;
  for (const auto& [id, name] : contents.schemas) {
    schemas.insert(name);
  }
  EXPECT_EQ(schemas, (std::set<std::string>{"foxglove.FrameTransform", "trackbed.Log",
                                            "foxglove.SceneUpdate", "foxglove.PosesInFrame"}));
}

TEST(Mcap, IsTheSameEveryTime) {
  const RunResult run = DriveAndPass();
  EXPECT_EQ(ToMcap(run), ToMcap(run));
}

TEST(Mcap, IsReadByTheOfficialReader) {
  if (std::system("python3 -c 'import mcap' 2>/dev/null") != 0) {
    GTEST_SKIP() << "python3 has no module mcap";
  }
  TempFolder folder;
  const RunResult run = DriveAndPass();
  WriteFileAtomically(folder.path() / "run.mcap", ToMcap(run));
  const std::string script =
      "import sys; from mcap.stream_reader import StreamReader; "
      "n = sum(type(r).__name__ == 'Message' for r in StreamReader(open(sys.argv[1], "
      "'rb')).records);"
      " sys.exit(0 if n > " +
      std::to_string(2 * run.logs[0].rows.size()) + " else 1)";
  const std::string command =
      "python3 -c \"" + script + "\" " + (folder.path() / "run.mcap").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace trackbed
