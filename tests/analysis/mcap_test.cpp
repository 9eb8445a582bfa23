// Tests the MCAP export with two independent readers: one written here according to the format's
// specification, and the official one (@mcap/core, via tests/mcap/read.js) if it is installed.

#include "trackbed/analysis/mcap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/support/shell.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using nlohmann::json;

const std::string kMagic{"\x89MCAP0\r\n"};

/// Contents of an MCAP file, parsed independently according to the format's specification.
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
  std::vector<int> codes;  // codes of all records
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

void ReadRecords(Bytes& bytes, Contents& contents) {
  while (bytes.left() > 0) {
    const auto code = bytes.Take<std::uint8_t>();
    Bytes record(bytes.Take(bytes.Take<std::uint64_t>()));
    contents.codes.push_back(code);
    const bool is_summary = std::count(contents.codes.begin(), contents.codes.end(), 0x0F) > 0;
    if (code == 0x03 && !is_summary) {
      const auto id = record.Take<std::uint16_t>();
      contents.schemas[id] = record.Text();
      EXPECT_EQ(record.Text(), "jsonschema");
      EXPECT_EQ(json::parse(record.Text()).at("type"), "object");
    } else if (code == 0x04 && !is_summary) {
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
    } else if (code == 0x06) {
      record.Take(8 + 8 + 8 + 4);  // times, size, checksum
      EXPECT_EQ(record.Text(), "");
      Bytes records(record.Take(record.Take<std::uint64_t>()));
      ReadRecords(records, contents);
    } else {
      continue;
    }
    EXPECT_EQ(record.left(), 0U);
  }
}

Contents Read(const std::string& file) {
  Contents contents;
  EXPECT_TRUE(file.starts_with(kMagic) && file.ends_with(kMagic));
  Bytes bytes(file.substr(kMagic.size(), file.size() - 2 * kMagic.size()));
  ReadRecords(bytes, contents);
  return contents;
}

RunResult DriveAndPass(const std::vector<std::string>& plants = {"kinematic"}) {
  Scenario scenario =
      ReadScenario(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "overtake.yaml");
  scenario.mission.waypoints = {{0.0, 0.0}, {120.0, 0.0}};
  scenario.drive.plants = plants;
  scenario.expect = {};
  return RunScenario(scenario);
}

TEST(Mcap, HoldsTheRun) {
  const RunResult run = DriveAndPass();
  const RunLog& log = run.logs.at(0);
  const Contents contents = Read(ToMcap(run));
  EXPECT_EQ(contents.codes.front(), 0x01);
  EXPECT_EQ(std::count(contents.codes.begin(), contents.codes.end(), 0x0F), 1);
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
  // The lead car drives along x at 5 m/s, starting at 50 m.
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

/// Contents of a file as read by the official reader (npm's @mcap/core, by tests/mcap/read.js);
/// nothing if it is not installed.
std::optional<json> ReadOfficially(const TempFolder& folder, const std::string& file) {
  WriteFileAtomically(folder.path() / "run.mcap", file);
  const Outcome outcome =
      Shell(folder, "node '" TRACKBED_SOURCE_DIR "/tests/mcap/read.js' '" TRACKBED_MCAP_READER
                    "' run.mcap > found.json");
  if (outcome.code == 77 || outcome.code == 127) {
    return std::nullopt;
  }
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  return json::parse(ReadFile(folder.path() / "found.json"));
}

#define SKIP_WITHOUT_READER(found) \
  if (!(found))                    \
  GTEST_SKIP() << "the official reader is not here; scripts/setup mcap installs it"

TEST(Mcap, IsReadByTheOfficialReader) {
  const TempFolder folder;
  const RunResult run = DriveAndPass({"kinematic", "mujoco"});
  const std::string file = ToMcap(run);
  const std::optional<json> found = ReadOfficially(folder, file);
  SKIP_WITHOUT_READER(found);
  // Reads the file with the test's own reader, from the first record to the last.
  const Contents contents = Read(file);
  std::map<std::string, std::size_t> counts;
  for (const Contents::Message& message : contents.messages) {
    ++counts[message.topic];
  }
  ASSERT_EQ(counts.at("/kinematic/log"), run.logs[0].rows.size());
  const auto chunks = std::count(contents.codes.begin(), contents.codes.end(), 0x06);
  EXPECT_GE(chunks, 2) << "the run is too short to show that chunks follow each other";
  // Reading in file order and by index must find the same messages, and all of them.
  for (const char* way : {"stream", "indexed"}) {
    const json& read = found->at(way);
    EXPECT_EQ(read.at("messages"), contents.messages.size()) << way;
    EXPECT_EQ(read.at("in_order"), true) << way;
    EXPECT_EQ(read.at("counts"), json(counts)) << way;
    EXPECT_EQ(read.at("digest"), found->at("stream").at("digest")) << way;
  }
  for (const auto& [id, channel] : contents.channels) {
    EXPECT_EQ(found->at("channels").at(channel.topic), (json{{"schema", channel.schema},
                                                             {"encoding", "json"},
                                                             {"schema_encoding", "jsonschema"}}));
  }
  EXPECT_EQ(found->at("channels").size(), contents.channels.size());
  EXPECT_EQ(found->at("schemas"), contents.schemas.size());
  // The log of a car with wheels has more columns, so it needs another schema.
  EXPECT_EQ(found->at("undescribed"), json::array());
  EXPECT_EQ(found->at("chunks"), chunks);
  EXPECT_EQ(found->at("checksums"), (json{{"data", true}, {"summary", true}, {"chunks", chunks}}));
  EXPECT_EQ(found->at("statistics"),
            (json{{"messages", contents.messages.size()},
                  {"schemas", contents.schemas.size()},
                  {"channels", contents.channels.size()},
                  {"chunks", chunks},
                  {"first", std::to_string(contents.messages.front().time)},
                  {"last", std::to_string(contents.messages.back().time)},
                  {"counts", counts}}));
  EXPECT_EQ(found->at("header"), (json{{"profile", ""}, {"library", "trackbed"}}));
  // Reads a second in the middle, which the index must find without reading the rest.
  std::size_t within = 0;
  for (const Contents::Message& message : contents.messages) {
    within += message.time >= 5'000'000'000 && message.time <= 6'000'000'000 ? 1 : 0;
  }
  EXPECT_EQ(found->at("from_5_to_6_s"), within);
}

TEST(Mcap, ABrokenByteIsFoundByTheOfficialReader) {
  const TempFolder folder;
  const std::string file = ToMcap(DriveAndPass());
  SKIP_WITHOUT_READER(ReadOfficially(folder, file));
  // Corrupts a digit of a message, then the last length that the summary contains.
  for (const std::size_t at : {file.find("\"x_m\":", file.size() / 2) + 7, file.size() - 45}) {
    std::string broken = file;
    broken[at] = static_cast<char>(broken[at] ^ 0x01);
    WriteFileAtomically(folder.path() / "broken.mcap", broken);
    const Outcome outcome =
        Shell(folder, "node '" TRACKBED_SOURCE_DIR "/tests/mcap/read.js' '" TRACKBED_MCAP_READER
                      "' broken.mcap");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.output, testing::HasSubstr("Incorrect")) << at;
  }
}

TEST(Mcap, KeepsAnyName) {
  // A program that embeds Trackbed may give its plants any name.
  RunResult run = DriveAndPass();
  run.logs[0].rows.resize(20);
  const std::string name = "</script>\"'\\{}\n\xE2\x80\xAE\xD7\xA9\xF0\x9F\x9A\x80\x01/../x";
  run.logs[0].plant = name;
  const std::string file = ToMcap(run);
  const Contents contents = Read(file);
  EXPECT_EQ(contents.channels.at(0).topic, "/" + name + "/tf");
  const TempFolder folder;
  const std::optional<json> found = ReadOfficially(folder, file);
  SKIP_WITHOUT_READER(found);
  for (const char* channel : {"tf", "log", "footprint", "plan"}) {
    EXPECT_TRUE(found->at("channels").contains("/" + name + "/" + channel)) << channel;
  }
  EXPECT_EQ(found->at("frames"), (json{"world", name}));
  // Bytes that are not valid UTF-8 are replaced, and the file stays readable.
  run.logs[0].plant = "latin \xE9";
  EXPECT_EQ(ReadOfficially(folder, ToMcap(run))->at("frames"),
            (json{"world", "latin \xEF\xBF\xBD"}));
}

}  // namespace
}  // namespace trackbed
