#include "trackbed/analysis/sweep_records.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <functional>
#include <system_error>
#include <utility>

#include "trackbed/core/error.h"

// Manages the record file of a study, to which the result row of each finished run is appended. The
// first line of the record file is the header, which describes the study. Each further line of the
// record file contains the CRC-32 of a row and the row as JSON. Load() stores the file offset of
// every row and truncates the file after the last valid line. A killed process loses at most the
// row that it was writing to the record file. If several lines of the record file contain the same
// row, the last of these lines is used. The record file is synchronized to disk once per second.
namespace trackbed {
namespace {

using nlohmann::ordered_json;

// Number of characters of the checksum at the start of a line of the record file: eight digits and
// a space.
constexpr std::size_t kChecksumWidth = 9;
constexpr std::string_view kRowKey = "{\"row\":";

std::uint32_t Checksum(std::string_view text) {
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  return crc.checksum();
}

std::string LineOf(std::string_view json) {
  return fmt::format("{:08x} {}\n", Checksum(json), json);
}

/// Returns the JSON text in a line of the record file, without the line feed, or nullopt if the
/// line's checksum is wrong.
std::optional<std::string_view> JsonOf(std::string_view line) {
  std::uint32_t told = 0;
  if (line.size() <= kChecksumWidth || line[kChecksumWidth - 1] != ' ') {
    return std::nullopt;
  }
  const char* end = line.data() + kChecksumWidth - 1;
  const auto [at, error] = std::from_chars(line.data(), end, told, 16);
  const std::string_view json = line.substr(kChecksumWidth);
  return error == std::errc{} && at == end && Checksum(json) == told ? std::optional(json)
                                                                     : std::nullopt;
}

std::string Dumped(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::int64_t Seconds() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration_cast<std::chrono::seconds>(Clock::now().time_since_epoch()).count();
}

void AddDifferences(const ordered_json& now, const ordered_json& before, const std::string& at,
                    std::vector<std::string>& found) {
  constexpr std::size_t kMaxDifferences = 5;
  constexpr std::size_t kMaxShownLength = 60;
  if (found.size() >= kMaxDifferences || now == before) {
    return;
  }
  const auto shown = [](const ordered_json& json) {
    const std::string text = json.is_null() ? "absent" : Dumped(json);
    return text.size() <= kMaxShownLength ? text : text.substr(0, kMaxShownLength) + "...";
  };
  if (!now.is_object() || !before.is_object()) {
    found.push_back(fmt::format("{}: {}, was {}", at, shown(now), shown(before)));
    return;
  }
  const auto value = [](const ordered_json& json, const std::string& key) {
    return json.contains(key) ? json.at(key) : ordered_json();
  };
  const auto inner = [&](const std::string& key) { return at.empty() ? key : at + "." + key; };
  for (const auto& [key, own] : now.items()) {
    AddDifferences(own, value(before, key), inner(key), found);
  }
  for (const auto& [key, own] : before.items()) {
    if (!now.contains(key)) {
      AddDifferences(ordered_json(), own, inner(key), found);
    }
  }
}

/// Calls `take` with every complete line of the record file and the line's offset, until `take`
/// returns false.
void ForEachLine(int descriptor, const std::function<bool(std::string_view, std::int64_t)>& take,
                 const std::function<void(int error)>& fail) {
  constexpr std::size_t kBlock = std::size_t{1} << 20U;
  std::string text;
  std::int64_t begin = 0;  // position in the file at which the buffered text starts [bytes]
  for (;;) {
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    const ssize_t got = ::pread(descriptor, text.data() + before, kBlock,
                                begin + static_cast<std::int64_t>(before));
    if (got < 0 && errno == EINTR) {
      text.resize(before);
      continue;
    }
    if (got < 0) {
      fail(errno);
    }
    text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got <= 0) {
      return;
    }
    std::size_t at = 0;
    for (std::size_t end = text.find('\n', before); end != std::string::npos;
         end = text.find('\n', at)) {
      if (!take(std::string_view(text).substr(at, end - at),
                begin + static_cast<std::int64_t>(at))) {
        return;
      }
      at = end + 1;
    }
    text.erase(0, at);
    begin += static_cast<std::int64_t>(at);
  }
}

/// Opens the record file. If the file does not exist, creates the file together with its header in
/// one step, so that a killed process leaves no file without a header.
int OpenOrCreate(const std::filesystem::path& file, const ordered_json& header) {
  constexpr int kFlags = O_RDWR | O_CLOEXEC | O_NOFOLLOW;
  const int descriptor = ::open(file.c_str(), kFlags);
  if (descriptor >= 0 || errno != ENOENT) {
    return descriptor;
  }
  TemporaryFile made(file);
  made.Write(LineOf(Dumped(header)));
  made.Publish();
  return ::open(file.c_str(), kFlags);
}

}  // namespace

std::vector<std::string> Differences(const ordered_json& now, const ordered_json& before) {
  std::vector<std::string> found;
  AddDifferences(now, before, "", found);
  return found;
}

SweepRecords::SweepRecords(std::filesystem::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {
  if (descriptor < 0) {
    Fail("open", errno);
  }
}

SweepRecords::SweepRecords(const std::filesystem::path& file, const ordered_json& header,
                           std::string_view remedy)
    : SweepRecords(file, OpenOrCreate(file, header)) {
  // Serialize and parse the header, so that it can be compared with the header read from the file.
  Load(ordered_json::parse(Dumped(header)), remedy);
}

SweepRecords::SweepRecords(const std::filesystem::path& file)
    : SweepRecords(file, ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW)) {
  Load(std::nullopt);
}

bool SweepRecords::IsFileOfRecords(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, ignored))) {
    return false;
  }
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  bool is_header = false;
  ForEachLine(
      in.get(),
      [&](std::string_view line, std::int64_t /*begin*/) {
        const std::optional<std::string_view> json = JsonOf(line);
        is_header = json && JsonValue(ParseJsonOf(file.string(), *json), file.string())
                                .Find("rows_expected")
                                .has_value();
        return false;
      },
      [&](int error) {
        throw RunError(fmt::format("cannot read {}: {}", file.string(),
                                   std::generic_category().message(error)));
      });
  return is_header;
}

void SweepRecords::Remove(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) {
    return;
  }
  if (!IsFileOfRecords(file)) {
    throw RunError(fmt::format("{} has no rows of a study, so --restart leaves it; move it away",
                               file.string()));
  }
  if (!std::filesystem::remove(file, error)) {
    throw RunError(fmt::format("cannot remove {}: {}", file.string(), error.message()));
  }
}

SweepRecords SweepRecords::InMemory(ordered_json header) {
  SweepRecords records("records in memory", ::memfd_create("trackbed_sweep", MFD_CLOEXEC));
  records.Load(std::move(header));
  return records;
}

void SweepRecords::TakeHeader(ordered_json header) {
  header_.emplace(std::move(header), file_.string());
  constexpr std::size_t kMaxRows = 100'000'000;
  const JsonValue expected = header_->At("rows_expected");
  const std::size_t rows = expected.Count(kMaxRows);
  if (rows == 0) {
    expected.Refuse(fmt::format("a whole number from 1 to {}", kMaxRows));
  }
  if (const std::optional<JsonValue> columns = header_->Find("columns")) {
    columns_ = columns->Texts();
    if (std::find(columns_.begin(), columns_.end(), "status") == columns_.end()) {
      columns->Refuse("columns with status among them");
    }
  }
  offsets_.assign(rows, -1);
}

void SweepRecords::Fail(const char* what, int error) const {
  throw RunError(fmt::format("cannot {} {}: {}", what, file_.string(),
                             std::generic_category().message(error)));
}

void SweepRecords::Load(const std::optional<ordered_json>& header, std::string_view remedy) {
  bool any_line = false;
  // The callback take_row returns true if ForEachLine must read the next line of the record file.
  const auto take_row = [&](std::string_view json, std::int64_t begin) {
    std::size_t row = 0;
    if (!json.starts_with(kRowKey)) {
      return false;
    }
    const auto [at, error] =
        std::from_chars(json.data() + kRowKey.size(), json.data() + json.size(), row);
    if (error != std::errc{} || row >= offsets_.size()) {
      return false;
    }
    count_ += offsets_[row] < 0 ? 1U : 0U;
    offsets_[row] = begin;
    return true;
  };
  ForEachLine(
      descriptor_.get(),
      [&](std::string_view line, std::int64_t begin) {
        const std::optional<std::string_view> json = JsonOf(line);
        if (!json) {
          return false;
        }
        if (!std::exchange(any_line, true)) {
          TakeHeader(ParseJsonOf(file_.string(), *json));
        } else if (!take_row(*json, begin)) {
          return false;
        }
        end_ = begin + static_cast<std::int64_t>(line.size()) + 1;
        return true;
      },
      [&](int error) { Fail("read", error); });
  struct stat status {};
  if (::fstat(descriptor_.get(), &status) != 0) {
    Fail("read", errno);
  }
  if (!any_line && (!header || status.st_size > 0)) {
    throw InputError(Problem{.file = file_.string(), .message = "has no rows of a study"});
  }
  if (any_line && header && *header != this->header()) {
    throw InputError(Problem{
        .file = file_.string(),
        .message = fmt::format("has rows of another study ({}); {}",
                               fmt::join(Differences(*header, this->header()), "; "), remedy)});
  }
  if (!header) {
    return;  // nothing to do, because the record file is open for reading only
  }
  if (status.st_size > end_ && ::ftruncate(descriptor_.get(), end_) != 0) {
    Fail("write", errno);
  }
  if (!any_line) {
    TakeHeader(*header);
    WriteLine(Dumped(this->header()));
  }
}

void SweepRecords::WriteLine(std::string_view json) {
  const std::string line = LineOf(json);
  std::string_view rest = line;
  while (!rest.empty()) {
    const std::int64_t at = end_ + static_cast<std::int64_t>(line.size() - rest.size());
    const ssize_t written = ::pwrite(descriptor_.get(), rest.data(), rest.size(), at);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      const int error = written < 0 ? errno : ENOSPC;
      // If truncating fails, the next process that opens the file removes the incomplete last line
      // of the record file.
      [[maybe_unused]] const int ignored = ::ftruncate(descriptor_.get(), end_);
      Fail("write", error);
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  end_ += static_cast<std::int64_t>(line.size());
}

void SweepRecords::Append(std::size_t row, const ordered_json& content) {
  TRACKBED_CHECK(row < offsets_.size(), "row {} of {}", row, offsets_.size());
  ordered_json json{{"row", row}};
  json.update(content);
  const std::string text = Dumped(json);
  const std::lock_guard lock(*mutex_);
  const std::int64_t begin = end_;
  WriteLine(text);
  count_ += offsets_[row] < 0 ? 1U : 0U;
  offsets_[row] = begin;
  if (const std::int64_t now = Seconds(); now != synced_) {
    synced_ = now;
    ::fdatasync(descriptor_.get());
  }
}

ordered_json SweepRecords::Read(std::size_t row) const {
  TRACKBED_CHECK(row < offsets_.size() && offsets_[row] >= 0, "no row {}", row);
  std::string text;
  std::size_t end = std::string::npos;
  while (end == std::string::npos) {
    constexpr std::size_t kBlock = 1024;
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    const ssize_t got = ::pread(descriptor_.get(), text.data() + before, kBlock,
                                offsets_[row] + static_cast<std::int64_t>(before));
    if (got < 0 && errno == EINTR) {
      text.resize(before);
      continue;
    }
    if (got <= 0) {
      Fail("read", got < 0 ? errno : EIO);
    }
    text.resize(before + static_cast<std::size_t>(got));
    end = text.find('\n', before);
  }
  const std::optional<std::string_view> json = JsonOf(std::string_view(text).substr(0, end));
  if (!json) {
    Fail("read", EIO);
  }
  return ParseJsonOf(file_.string(), *json);
}

JsonValue SweepRecords::Entry(std::size_t row) const {
  return {Read(row), file_.string(), fmt::format("row {}", row)};
}

const std::vector<std::string>& SweepRecords::Columns() const {
  if (columns_.empty()) {
    static_cast<void>(header_->At("columns"));
  }
  return columns_;
}

}  // namespace trackbed
