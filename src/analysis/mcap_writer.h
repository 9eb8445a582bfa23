#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// Writes the container (mcap.dev/spec): schemas and channels, then chunks of messages without
/// compression, each with an index of its own, then the summary that readers seek with. All numbers
/// are little-endian, and all checksums are there.
class McapWriter {
 public:
  McapWriter();

  /// A channel of its own; channels whose schemas have equal names and shapes share one. All of
  /// them before the first message.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema,
                           const nlohmann::json& shape);

  /// In the order of their times [s], none of which is negative.
  void AddMessage(std::uint16_t channel, double time, const nlohmann::json& message);

  /// The file. Nothing can be added any more.
  std::string Finish();

 private:
  struct Times {
    std::uint64_t first = 0;  ///< [ns]
    std::uint64_t last = 0;   ///< [ns]
  };

  void CloseChunk();
  std::string SummaryAt(std::size_t start);
  [[nodiscard]] std::string Statistics() const;

  std::string out_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;  ///< by name and shape
  std::vector<std::uint32_t> counts_;  ///< of the messages of each channel
  std::string schema_records_;
  std::string channel_records_;
  std::string chunk_;
  Times chunk_times_;
  /// Time and place in the chunk of each message, by channel.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_messages_;
  std::uint32_t chunks_ = 0;
  std::string chunk_index_records_;
  Times times_;
};

}  // namespace trackbed
