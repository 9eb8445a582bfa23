#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <map>
#include <system_error>
#include <type_traits>

#include "src/bag/decompress.h"
#include "src/bag/sources.h"
#include "trackbed/bag/mcap_format.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/foreign_content.h"

// Reads MCAP files (https://mcap.dev/spec) from the first record to the last. Each MCAP record has
// an opcode of one byte, the length of its content and the content; numbers are little endian. MCAP
// chunks contain compressed records. The index at the end of an MCAP file is not needed, because
// all records are read in order. Unused kinds of records are skipped. The statistics at the end of
// an MCAP file reveal lost messages.
namespace trackbed {
namespace {

/// Reads the fields of an MCAP record, and throws an InputError instead of reading beyond the
/// record's end.
class RecordReader {
 public:
  RecordReader(std::string_view data, const std::filesystem::path& file)
      : data_(data), file_(file) {}

  template <typename Number>
  Number Read() {
    const std::string_view bytes = Bytes(sizeof(Number));
    std::make_unsigned_t<Number> number = 0;
    for (std::size_t i = sizeof(Number); i-- > 0;) {
      number = static_cast<std::make_unsigned_t<Number>>(
          (static_cast<std::uint64_t>(number) << 8U) | static_cast<unsigned char>(bytes[i]));
    }
    return static_cast<Number>(number);
  }

  std::string_view Bytes(std::uint64_t size) {
    if (size > data_.size()) {
      RefuseBag(file_, fmt::format("a record is damaged: it ends {} bytes before its last field",
                                   size - data_.size()));
    }
    const std::string_view bytes = data_.substr(0, size);
    data_.remove_prefix(size);
    return bytes;
  }

  /// Reads a text, which is stored as its number of bytes (32 bits) followed by the bytes.
  std::string_view Text() { return Bytes(Read<std::uint32_t>()); }
  [[nodiscard]] std::string_view rest() const { return data_; }
  [[nodiscard]] bool is_empty() const { return data_.empty(); }

 private:
  std::string_view data_;
  const std::filesystem::path& file_;
};

class McapReader {
 public:
  McapReader(const std::filesystem::path& file, BagContent& content, const TakeTopicMessage& take)
      : file_(file), descriptor_(OpenInput(file)), content_(content), take_(take) {
    struct stat status {};
    if (fstat(descriptor_.get(), &status) != 0) {
      throw RunError(fmt::format("{}: {}", file.string(), std::strerror(errno)));
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
  }

  void Read() {
    constexpr std::size_t kBegin = 256;
    const std::string begin = ReadAt(0, kBegin);
    if (!begin.starts_with(mcap::kMagic)) {
      RefuseBag(file_, ParseProblem(begin, "a bag",
                                    "its first bytes are neither those of MCAP nor of SQLite"));
    }
    std::uint64_t at = mcap::kMagic.size();
    while (!at_end_) {
      constexpr std::size_t kHead = 9;  // opcode and length [bytes]
      const std::string head = ReadAt(at, kHead);
      if (head.size() < kHead) {
        NoteEnd(at);
        return;
      }
      const auto opcode = static_cast<unsigned char>(head.front());
      const auto length =
          RecordReader(std::string_view(head).substr(1), file_).Read<std::uint64_t>();
      at += kHead;
      if (length > size_ - at) {
        NoteEnd(at - kHead);
        return;
      }
      // Ignore the schemas and channels in the summary, which repeat the schemas and channels of
      // the data section.
      const bool is_used = (!in_summary_ && opcode > mcap::kFooter && opcode <= mcap::kChunk) ||
                           opcode == mcap::kStatistics;
      if (is_used) {
        if (length > kMaxChunkBytes) {
          RefuseBag(file_, fmt::format("a record of {} bytes; must be at most {}", length,
                                       kMaxChunkBytes));
        }
        TakeRecord(opcode, ReadAt(at, length), false);
      }
      in_summary_ = in_summary_ || opcode == mcap::kDataEnd;
      at_end_ = opcode == mcap::kFooter;
      at += length;
    }
  }

 private:
  struct Schema {
    std::string name;
    std::string definition;
  };

  std::string ReadAt(std::uint64_t at, std::size_t bytes) {
    std::string read(std::min<std::uint64_t>(bytes, at < size_ ? size_ - at : 0), '\0');
    std::size_t done = 0;
    while (done < read.size()) {
      const ssize_t count = pread(descriptor_.get(), read.data() + done, read.size() - done,
                                  static_cast<off_t>(at + done));
      if (count < 0 && errno == EINTR) {
        continue;
      }
      if (count < 0) {
        throw RunError(fmt::format("{}: {}", file_.string(), std::strerror(errno)));
      }
      if (count == 0) {
        read.resize(done);
      }
      done += static_cast<std::size_t>(count);
    }
    return read;
  }

  void NoteEnd(std::uint64_t at) {
    content_.notes.push_back(
        fmt::format("{} ends within a record at byte {}, as if the recorder was stopped; all "
                    "records before are read",
                    file_.filename().string(), at));
  }

  void TakeRecord(unsigned char opcode, std::string_view data, bool in_chunk) {
    RecordReader record(data, file_);
    if (opcode == mcap::kSchema) {
      const auto id = record.Read<std::uint16_t>();
      Schema schema{.name = std::string(record.Text()), .definition = {}};
      const bool is_ros2msg = record.Text() == "ros2msg";
      const std::string_view definition = record.Text();
      // A message type without fields has an empty definition. Store a line feed instead, because
      // "" in `schema.definition` means that the bag has no definition.
      schema.definition = !is_ros2msg ? "" : definition.empty() ? "\n" : std::string(definition);
      schemas_[id] = std::move(schema);
    } else if (opcode == mcap::kChannel) {
      TakeChannel(record);
    } else if (opcode == mcap::kMessage) {
      TakeMessage(record);
    } else if (opcode == mcap::kStatistics) {
      const auto stated = record.Read<std::uint64_t>();
      if (stated != messages_) {
        RefuseBag(file_,
                  fmt::format("damaged: it states {} messages and has {}", stated, messages_));
      }
    } else if (opcode == mcap::kChunk) {
      if (in_chunk) {
        RefuseBag(file_, "a chunk contains a chunk");
      }
      TakeChunk(record);
    }
  }

  void TakeChannel(RecordReader& record) {
    const auto id = record.Read<std::uint16_t>();
    const Schema schema = schemas_[record.Read<std::uint16_t>()];
    const std::string name(record.Text());
    const std::string encoding(record.Text());
    const BagTopic topic{
        .name = name, .type = schema.name, .encoding = encoding, .definition = schema.definition};
    static_cast<void>(TopicOf(content_, topic, file_));
    channels_[id] = name;
  }

  void TakeMessage(RecordReader& record) {
    const auto id = record.Read<std::uint16_t>();
    record.Read<std::uint32_t>();  // sequence number
    const auto log_time = record.Read<std::int64_t>();
    record.Read<std::uint64_t>();  // publish time
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) {
      RefuseBag(file_, fmt::format("a message of the channel {}, which is not described", id));
    }
    BagTopic& topic = TopicOf(content_, {.name = channel->second}, file_);
    ++topic.messages;
    ++messages_;
    if (take_) {
      take_(topic, record.rest(), log_time);
    }
  }

  void TakeChunk(RecordReader& record) {
    record.Read<std::uint64_t>();  // Time of the first message.
    record.Read<std::uint64_t>();  // Time of the last message.
    const auto size = record.Read<std::uint64_t>();
    const auto checksum = record.Read<std::uint32_t>();
    const std::string compression(record.Text());
    const std::string_view compressed = record.Bytes(record.Read<std::uint64_t>());
    if (size > kMaxChunkBytes) {
      RefuseBag(file_,
                fmt::format("a chunk of {} bytes; must be at most {}", size, kMaxChunkBytes));
    }
    const std::string records = Decompress(compressed, compression, size, file_);
    if (records.size() != size) {
      RefuseBag(file_, fmt::format("a chunk of {} bytes states {} bytes", records.size(), size));
    }
    if (checksum != 0) {
      boost::crc_32_type computed;
      computed.process_bytes(records.data(), records.size());
      if (computed.checksum() != checksum) {
        RefuseBag(file_, "a chunk is damaged: its checksum is wrong");
      }
    }
    RecordReader inner(records, file_);
    while (!inner.is_empty()) {
      const auto opcode = inner.Read<std::uint8_t>();
      const auto length = inner.Read<std::uint64_t>();
      TakeRecord(opcode, inner.Bytes(length), true);
    }
  }

  const std::filesystem::path& file_;
  Descriptor descriptor_;
  std::uint64_t size_ = 0;
  BagContent& content_;
  const TakeTopicMessage& take_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::string> channels_;  // names of the topics
  std::uint64_t messages_ = 0;
  bool in_summary_ = false;
  bool at_end_ = false;
};

}  // namespace

void ReadMcap(const std::filesystem::path& file, BagContent& content,
              const TakeTopicMessage& take) {
  McapReader(file, content, take).Read();
}

}  // namespace trackbed
