#include "trackbed/bag/bag.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/bag/message.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Tests bags that independent writers wrote (tests/data/bags/make_bags.py): their topics, and the
// poses against the circle that they were computed from; damaged and hostile files.
namespace trackbed {
namespace bag_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path kBags = fs::path(TRACKBED_SOURCE_DIR) / "tests/data/bags";

std::vector<std::string> TopicsOf(const fs::path& bag) {
  std::vector<std::string> topics;
  for (const BagTopic& topic : ReadBagTopics(bag).topics) {
    topics.push_back(topic.name + " " + topic.type + " " + std::to_string(topic.messages));
  }
  return topics;
}

std::string ErrorOf(const fs::path& bag) {
  try {
    return "no error, " + std::to_string(ReadBagTopics(bag).topics.size()) + " topics";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Bag, ListsTopicsOfEveryWriter) {
  EXPECT_THAT(TopicsOf(kBags / "odometry.mcap"),
              ElementsAre("/drive ackermann_msgs/msg/AckermannDriveStamped 21",
                          "/odom nav_msgs/msg/Odometry 21", "/plan nav_msgs/msg/Path 1"));
  for (const char* bag : {"sqlite", "sqlite/sqlite.db3", "sqlite_zstd", "mcap", "mcap/mcap.mcap"}) {
    EXPECT_THAT(TopicsOf(kBags / bag), ElementsAre("/pose geometry_msgs/msg/PoseStamped 21",
                                                   "/twist geometry_msgs/msg/TwistStamped 21"))
        << bag;
  }
}

TEST(Bag, ReadsThePosesThatWereWritten) {
  for (const auto& [bag, topic, prefix] :
       {std::tuple("odometry.mcap", "/odom", "pose.pose."),
        std::tuple("autoware.mcap", "/localization/pose", "pose."),
        std::tuple("sqlite", "/pose", "pose."), std::tuple("sqlite_zstd", "/pose", "pose."),
        std::tuple("mcap", "/pose", "pose.")}) {
    SCOPED_TRACE(bag);
    std::string type;
    std::string definition;
    for (const BagTopic& own : ReadBagTopics(kBags / bag).topics) {
      if (own.name == topic) {
        type = own.type;
        definition = own.definition;
      }
    }
    const BagMessage message(type, definition);
    const auto column = [&](const std::string& name) {
      const auto& columns = message.columns();
      return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) -
                                      columns.begin());
    };
    int count = 0;
    std::vector<double> numbers;
    const std::string pose = prefix;  // Clang 14 captures no structured bindings.
    ReadBagMessages(kBags / bag, topic, [&](std::string_view data, std::int64_t log_time) {
      message.Read(data, numbers);
      const double angle = 0.25 * 0.1 * count;  // 5 m/s / 20 m, every 0.1 s
      const std::int64_t stamp = 1'700'000'000'500'000'000 + count * 100'000'000LL;
      EXPECT_EQ(log_time, stamp + 1000);
      EXPECT_EQ(numbers[column("header.stamp.sec")], static_cast<double>(stamp / 1'000'000'000));
      EXPECT_EQ(numbers[column("header.stamp.nanosec")],
                static_cast<double>(stamp % 1'000'000'000));
      // Python and C++ compute sines that differ by up to one unit in the last place: 20 m x
      // 2.2e-16.
      EXPECT_NEAR(numbers[column(pose + "position.x")], 20.0 * std::sin(angle), Tolerance(1e-14));
      EXPECT_NEAR(numbers[column(pose + "position.y")], 20.0 * (1.0 - std::cos(angle)),
                  Tolerance(1e-14));
      EXPECT_NEAR(numbers[column(pose + "orientation.z")], std::sin(0.5 * angle), Tolerance(1e-15));
      ++count;
    });
    EXPECT_EQ(count, 21);
  }
}

/// The topics of a bag and the bytes of all messages, as text.
std::string Everything(const fs::path& bag) {
  std::string text;
  for (const BagTopic& topic : ReadBagTopics(bag).topics) {
    text += topic.name + topic.type + topic.definition;
    ReadBagMessages(bag, topic.name, [&](std::string_view data, std::int64_t time) {
      text += std::to_string(time);
      text += data;
    });
  }
  return text;
}

TEST(Bag, EndsWithAnErrorOrANoteIfItIsCutOff) {
  const TempFolder folder;
  const std::string whole = Everything(kBags / "autoware.mcap");
  const std::string bytes = ReadFile(kBags / "autoware.mcap");
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    const fs::path cut = folder.Write("cut.mcap", bytes.substr(0, size));
    try {
      // The index at the end of the file is not needed.
      EXPECT_TRUE(!ReadBagTopics(cut).notes.empty() || Everything(cut) == whole) << size;
    } catch (const InputError&) {
    }
  }
}

TEST(Bag, ReadsNothingElseFromChangedBytes) {
  const TempFolder folder;
  const std::string whole = Everything(kBags / "autoware.mcap");
  const std::string bytes = ReadFile(kBags / "autoware.mcap");
  for (std::size_t i = 0; i < bytes.size(); i += 13) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    const fs::path file = folder.Write("a.mcap", changed);
    try {
      // Chunks have checksums. Changed bytes in other records have no effect, or change a length so
      // that the file seems to end.
      EXPECT_TRUE(!ReadBagTopics(file).notes.empty() || Everything(file) == whole) << i;
    } catch (const InputError&) {
    }
  }
}

TEST(Bag, SurvivesChangedBytesOfSqlite) {
  const TempFolder folder;
  const std::string bytes = ReadFile(kBags / "sqlite/sqlite.db3");
  for (std::size_t i = 0; i < bytes.size(); i += 61) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x55);
    const fs::path file = folder.Write("a.db3", changed);
    try {
      static_cast<void>(Everything(file));
    } catch (const InputError&) {
    }
  }
}

TEST(Bag, SaysWhatAFileIs) {
  const TempFolder folder;
  EXPECT_THAT(ErrorOf(folder.Write("a.mcap", "x,y\n1,2\n")),
              HasSubstr("not a bag: its first bytes are neither those of MCAP nor of SQLite"));
  EXPECT_THAT(ErrorOf(folder.Write("a.mcap", "")), HasSubstr("the file is empty"));
  EXPECT_THAT(ErrorOf(folder.Write("a.db3", "\x1F\x8B....")), HasSubstr("gunzip"));
  EXPECT_THAT(ErrorOf(folder.Write("a.db3", "#ROSBAG V2.0\n")), HasSubstr("ROS 1"));
  EXPECT_THAT(ErrorOf(folder.Write("a.db3.zstd", "\x28\xB5\x2F\xFD....")), HasSubstr("zstd -d"));
  EXPECT_THAT(ErrorOf(folder.Write("a.db3", "SQLite format 3\0 and no more")),
              HasSubstr("no SQLite bag"));
  fs::create_directories(folder.path() / "b");
  folder.Write("b/metadata.yaml",
               "rosbag2_bagfile_information: {relative_file_paths: [../a.mcap]}");
  EXPECT_THAT(ErrorOf(folder.path() / "b"), HasSubstr("../a.mcap"));
  EXPECT_THROW(ReadBagMessages(kBags / "mcap", "/nose", {}), InputError);
}

/// Returns a record of an MCAP file.
std::string McapRecord(char opcode, const std::string& content) {
  return opcode + std::string(1, static_cast<char>(content.size())) + std::string(7, '\0') +
         content;
}

std::string McapText(const std::string& text) {
  return std::string(1, static_cast<char>(text.size())) + std::string(3, '\0') + text;
}

TEST(Bag, HasTheEmptyDefinitionOfATypeWithoutFields) {
  const TempFolder folder;
  const std::string one("\1\0", 2);
  std::string bag("\x89MCAP0\r\n", 8);
  bag += McapRecord('\x01', McapText("ros2") + McapText(""));
  bag +=
      McapRecord('\x03', one + McapText("std_msgs/msg/Empty") + McapText("ros2msg") + McapText(""));
  bag += McapRecord('\x04', one + one + McapText("/go") + McapText("cdr") + McapText(""));
  // One message: channel, sequence, two times, and a body with the header of CDR and one byte.
  bag += McapRecord('\x05', one + std::string(4 + 8 + 8, '\0') + std::string("\0\1\0\0\0", 5));
  const std::vector<BagTopic> topics = ReadBagTopics(folder.Write("a.mcap", bag)).topics;
  ASSERT_EQ(topics.size(), 1U);
  EXPECT_EQ(topics[0].messages, 1U);
  EXPECT_THAT(BagMessage(topics[0].type, topics[0].definition).columns(), IsEmpty());
}

TEST(Bag, DoesNotBelieveSizes) {
  const TempFolder folder;
  const std::string magic("\x89MCAP0\r\n", 8);
  // A chunk that states 2^60 bytes: the opcode, the length, and the fields.
  std::string chunk(16, '\0');
  chunk += std::string("\0\0\0\0\0\0\0\x10", 8) + std::string(4 + 4 + 8, '\0');
  std::string record("\x06", 1);
  record += static_cast<char>(chunk.size()) + std::string(7, '\0') + chunk;
  EXPECT_THAT(ErrorOf(folder.Write("a.mcap", magic + record)), HasSubstr("must be at most"));
  EXPECT_THAT(ReadBagTopics(folder.Write("b.mcap", magic + "\x03" + std::string(8, '\xFF'))).notes,
              ElementsAre(HasSubstr("ends within a record at byte 8")));
}

}  // namespace bag_test
}  // namespace trackbed
