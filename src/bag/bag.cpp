#include "trackbed/bag/bag.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <limits>

#include "src/bag/sources.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";

/// Returns the files of a bag: the single file, or all files listed in the metadata of the bag's
/// folder.
std::vector<fs::path> FilesOf(const fs::path& bag) {
  std::error_code ignored;
  if (!fs::is_directory(bag, ignored)) {
    return {bag};
  }
  const fs::path metadata = bag / kMetadata;
  constexpr std::size_t kMaxMetadataBytes = std::size_t{16} << 20U;
  std::vector<fs::path> files;
  try {
    const YAML::Node root = YAML::Load(ReadFile(metadata, kMaxMetadataBytes));
    const YAML::Node names = root["rosbag2_bagfile_information"]["relative_file_paths"];
    for (std::size_t i = 0; names && names.IsSequence() && i < names.size(); ++i) {
      const auto name = names[i].as<std::string>();
      if (const std::string why = ReadAccessError(name, bag, {}); !why.empty()) {
        RefuseBag(metadata, fmt::format("{} {}", name, why));
      }
      files.push_back(bag / name);
    }
  } catch (const YAML::Exception& error) {
    RefuseBag(metadata, fmt::format("not YAML of rosbag2: {}", error.what()));
  }
  if (files.empty()) {
    RefuseBag(metadata, "has no list rosbag2_bagfile_information.relative_file_paths");
  }
  return files;
}

void ReadOneFile(const fs::path& file, BagContent& content, const std::string& wanted,
                 const TakeTopicMessage& take) {
  std::string first;
  ReadBlocks(
      file,
      [&](std::string_view block) {
        first = std::string(block.substr(0, 16));
        return false;
      },
      std::numeric_limits<std::size_t>::max());
  if (first.starts_with("SQLite format 3")) {
    ReadSqlite(file, content, wanted, take);
  } else if (first.starts_with("\x28\xB5\x2F\xFD")) {
    RefuseBag(file, "compressed as a whole by zstd; decompress it first: zstd -d FILE");
  } else if (first.starts_with("\x04\x22\x4D\x18")) {
    RefuseBag(file, "compressed as a whole by lz4; decompress it first: lz4 -d FILE");
  } else if (first.starts_with("#ROSBAG V2")) {
    RefuseBag(file, "a bag of ROS 1; convert it first: rosbags-convert --src FILE --dst FOLDER");
  } else {
    ReadMcap(file, content, take);
  }
}

}  // namespace

bool IsBag(const fs::path& bag) {
  std::error_code ignored;
  const std::string ending = bag.extension().string();
  return ending == ".mcap" || ending == ".db3" || fs::is_directory(bag, ignored) ||
         bag.filename().string().ends_with(".db3.zstd") ||
         bag.filename().string().ends_with(".mcap.zstd");
}

BagContent ReadBagTopics(const fs::path& bag) {
  BagContent content;
  for (const fs::path& file : FilesOf(bag)) {
    ReadOneFile(file, content, "", {});
  }
  return content;
}

void ReadBagMessages(const fs::path& bag, const std::string& topic, const TakeBagMessage& take) {
  BagContent content;
  for (const fs::path& file : FilesOf(bag)) {
    ReadOneFile(file, content, topic,
                [&](const BagTopic& own, std::string_view data, std::int64_t time) {
                  if (own.name == topic) {
                    take(data, time);
                  }
                });
  }
  std::vector<std::string> names;
  for (const BagTopic& own : content.topics) {
    names.push_back(own.name);
  }
  if (std::find(names.begin(), names.end(), topic) == names.end()) {
    RefuseBag(bag, fmt::format("no topic {}", UnknownName(topic, names)));
  }
}

}  // namespace trackbed
