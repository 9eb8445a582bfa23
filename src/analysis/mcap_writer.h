#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// Writes an MCAP container (mcap.dev/spec). The file contains first the schemas and channels, then
/// uncompressed chunks of messages, each with an index, and last the summary, which viewers use for
/// seeking. All numbers are little-endian, and McapWriter computes all optional checksums.
class McapWriter {
 public:
  McapWriter();

  /// Adds a channel to the MCAP file, and the channel's schema unless an earlier channel has a
  /// schema with equal name and JSON text. Add all channels before the first message.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema,
                           const nlohmann::json& shape);

  /// Adds a message to a channel. Message times [s] must be non-negative and in ascending order.
  void AddMessage(std::uint16_t channel, double time, const nlohmann::json& message);

  /// Returns the content of the MCAP file. Do not call any function of the McapWriter after Finish.
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
  /// MCAP id of each schema (1, 2, ...), keyed by the schema's name and its JSON text.
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;
  std::vector<std::uint32_t> counts_;  ///< Number of messages in each channel.
  std::string schema_records_;
  std::string channel_records_;
  std::string chunk_;
  Times chunk_times_;
  /// For each channel, the time [ns] of each message in the current chunk and the message's offset
  /// in the chunk [bytes].
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_messages_;
  std::uint32_t chunks_ = 0;
  std::string chunk_index_records_;
  Times times_;
};

}  // namespace trackbed
