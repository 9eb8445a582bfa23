#include "src/analysis/mcap_writer.h"

#include <boost/crc.hpp>
#include <cmath>
#include <numeric>

#include "trackbed/bag/mcap_format.h"

namespace trackbed {
namespace {

/// Maximum size of a chunk [bytes]. Chunks are small, because a viewer must load a whole chunk to
/// show a single point in time.
constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;

template <typename Number>
void Put(std::string& out, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    out += static_cast<char>((number >> (8 * i)) & 0xFF);
  }
}

void PutText(std::string& out, const std::string& text) {
  Put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

void PutRecord(std::string& out, mcap::Opcode code, const std::string& content) {
  out += static_cast<char>(code);
  Put<std::uint64_t>(out, content.size());
  out += content;
}

std::uint32_t Checksum(const std::string& bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

/// Converts JSON to text; each invalid UTF-8 sequence becomes the character U+FFFD.
std::string Dumped(const nlohmann::json& content) {
  return content.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

McapWriter::McapWriter() : out_(mcap::kMagic) {
  std::string header;
  PutText(header, "");  // the empty profile means that the file conforms to no MCAP profile
  PutText(header, "trackbed");
  PutRecord(out_, mcap::kHeader, header);
}

std::uint16_t McapWriter::AddChannel(const std::string& topic, const std::string& schema,
                                     const nlohmann::json& shape) {
  const std::string text = Dumped(shape);
  const auto [known, is_new] =
      schemas_.emplace(std::pair(schema, text), static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new) {
    std::string record;
    Put<std::uint16_t>(record, known->second);
    PutText(record, schema);
    PutText(record, "jsonschema");
    PutText(record, text);
    PutRecord(schema_records_, mcap::kSchema, record);
    PutRecord(out_, mcap::kSchema, record);
  }
  const auto channel = static_cast<std::uint16_t>(counts_.size());
  counts_.push_back(0);
  std::string record;
  Put<std::uint16_t>(record, channel);
  Put<std::uint16_t>(record, known->second);
  PutText(record, topic);
  PutText(record, "json");
  Put<std::uint32_t>(record, 0);  // size 0 of the metadata map, because the channel has no metadata
  PutRecord(channel_records_, mcap::kChannel, record);
  PutRecord(out_, mcap::kChannel, record);
  return channel;
}

void McapWriter::AddMessage(std::uint16_t channel, double time, const nlohmann::json& message) {
  const auto nanoseconds = static_cast<std::uint64_t>(std::llround(time * 1e9));
  if (chunk_.empty()) {
    chunk_times_.first = nanoseconds;
    times_.first = chunks_ == 0 ? nanoseconds : times_.first;
  }
  chunk_times_.last = nanoseconds;
  times_.last = nanoseconds;
  chunk_messages_[channel].emplace_back(nanoseconds, chunk_.size());
  std::string record;
  Put<std::uint16_t>(record, channel);
  Put<std::uint32_t>(record, counts_[channel]++);
  Put<std::uint64_t>(record, nanoseconds);
  Put<std::uint64_t>(record, nanoseconds);
  record += Dumped(message);
  PutRecord(chunk_, mcap::kMessage, record);
  if (chunk_.size() >= kChunkBytes) {
    CloseChunk();
  }
}

void McapWriter::CloseChunk() {
  if (chunk_.empty()) {
    return;
  }
  const std::size_t start = out_.size();
  std::string record;
  Put(record, chunk_times_.first);
  Put(record, chunk_times_.last);
  Put<std::uint64_t>(record, chunk_.size());
  Put(record, Checksum(chunk_));
  PutText(record, "");  // the empty compression name means that the chunk is not compressed
  Put<std::uint64_t>(record, chunk_.size());
  PutRecord(out_, mcap::kChunk, record + chunk_);
  const std::size_t end = out_.size();

  std::string offsets;
  for (const auto& [channel, messages] : chunk_messages_) {
    Put(offsets, channel);
    Put<std::uint64_t>(offsets, out_.size());
    std::string places;
    for (const auto& [time, offset] : messages) {
      Put(places, time);
      Put(places, offset);
    }
    record.clear();
    Put(record, channel);
    PutText(record, places);
    PutRecord(out_, mcap::kMessageIndex, record);
  }

  record.clear();
  Put(record, chunk_times_.first);
  Put(record, chunk_times_.last);
  Put<std::uint64_t>(record, start);
  Put<std::uint64_t>(record, end - start);
  PutText(record, offsets);
  Put<std::uint64_t>(record, out_.size() - end);
  PutText(record, "");
  Put<std::uint64_t>(record, chunk_.size());
  Put<std::uint64_t>(record, chunk_.size());
  PutRecord(chunk_index_records_, mcap::kChunkIndex, record);
  ++chunks_;
  chunk_.clear();
  chunk_messages_.clear();
}

std::string McapWriter::Statistics() const {
  std::string counts;
  for (std::size_t channel = 0; channel < counts_.size(); ++channel) {
    Put(counts, static_cast<std::uint16_t>(channel));
    Put<std::uint64_t>(counts, counts_[channel]);
  }
  std::string record;
  Put(record, std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}));
  Put(record, static_cast<std::uint16_t>(schemas_.size()));
  Put(record, static_cast<std::uint32_t>(counts_.size()));
  Put<std::uint32_t>(record, 0);  // Number of attachments in the file.
  Put<std::uint32_t>(record, 0);  // Number of metadata records in the file.
  Put(record, chunks_);
  Put(record, times_.first);
  Put(record, times_.last);
  PutText(record, counts);
  return record;
}

/// Returns the part of an MCAP file that follows the messages: the summary records, the offset of
/// each group of summary records, and the footer. The argument `start` is the position of the
/// summary in the file [bytes].
std::string McapWriter::SummaryAt(std::size_t start) {
  std::string statistics;
  PutRecord(statistics, mcap::kStatistics, Statistics());
  std::string summary;
  std::string offsets;
  for (const auto& [code, records] :
       {std::pair{mcap::kSchema, schema_records_}, std::pair{mcap::kChannel, channel_records_},
        std::pair{mcap::kStatistics, statistics},
        std::pair{mcap::kChunkIndex, chunk_index_records_}}) {
    if (records.empty()) {
      continue;
    }
    std::string offset(1, static_cast<char>(code));
    Put<std::uint64_t>(offset, start + summary.size());
    Put<std::uint64_t>(offset, records.size());
    PutRecord(offsets, mcap::kSummaryOffset, offset);
    summary += records;
  }
  std::string footer;
  Put<std::uint64_t>(footer, start);
  Put<std::uint64_t>(footer, start + summary.size());
  summary += offsets;
  // The checksum covers all bytes from the start of the summary to the checksum itself, including
  // the first fields of the footer.
  std::string checked = summary;
  checked += static_cast<char>(mcap::kFooter);
  Put<std::uint64_t>(checked, footer.size() + sizeof(std::uint32_t));
  Put(footer, Checksum(checked + footer));
  PutRecord(summary, mcap::kFooter, footer);
  return summary;
}

std::string McapWriter::Finish() {
  CloseChunk();
  std::string end;
  Put(end, Checksum(out_));
  PutRecord(out_, mcap::kDataEnd, end);
  out_ += SummaryAt(out_.size());
  out_ += mcap::kMagic;
  return out_;
}

}  // namespace trackbed
