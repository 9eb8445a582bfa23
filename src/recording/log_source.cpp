#include "src/recording/log_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "trackbed/bag/bag.h"
#include "trackbed/bag/message.h"
#include "trackbed/core/csv_columns.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/path_files/globe_file.h"

namespace trackbed {
namespace {

void ReadGlobeNumbers(const std::filesystem::path& path, const std::vector<std::string>& columns,
                      const TakeLogRow& take) {
  const std::vector<std::string> all(std::begin(kGlobeColumns), std::end(kGlobeColumns));
  std::vector<std::size_t> places;
  for (const std::string& column : columns) {
    const auto found = std::find(all.begin(), all.end(), column);
    if (found == all.end()) {
      throw InputError(
          Problem{.file = path.string(),
                  .key = column,
                  .message = fmt::format("no such column {}", UnknownName(column, all))});
    }
    places.push_back(static_cast<std::size_t>(found - all.begin()));
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> row(columns.size());
  for (const GlobeLine& line : ReadGlobeFile(path).lines) {
    for (const GlobePoint& point : line.points) {
      const double numbers[] = {point.time.value_or(kNone), point.position.latitude,
                                point.position.longitude, point.height.value_or(kNone)};
      for (std::size_t i = 0; i < places.size(); ++i) {
        row[i] = numbers[places[i]];
      }
      take(row, point.line);
    }
  }
}

/// Returns the number in a message for each wanted column. places[i] is the index of a column of
/// the message; larger indices stand for the time at which the message was logged.
class BagColumns {
 public:
  BagColumns(const std::vector<std::string>& names, const BagMessage& message,
             const std::filesystem::path& file, const std::string& topic)
      : own_(message.columns()) {
    std::vector<std::string> known = own_;
    for (const char* name : kBagTimes) {
      known.emplace_back(name);
    }
    const bool has_header = Has("header.stamp.sec");
    const bool has_stamp = Has("stamp.sec");
    for (std::string name : names) {
      // The time of a bag message is the time in its header or, without a header, the time of
      // logging.
      if (!has_stamp && (name == "stamp.sec" || name == "stamp.nanosec")) {
        name = has_header ? "header." + name : "log_time" + name.substr(5);
      }
      const auto found = std::find(known.begin(), known.end(), name);
      if (found == known.end()) {
        throw InputError(
            Problem{.file = file.string(),
                    .key = topic,
                    .message = fmt::format("no such column {}", UnknownName(name, known))});
      }
      places_.push_back(static_cast<std::size_t>(found - known.begin()));
    }
  }

  void Take(const std::vector<double>& message, std::int64_t log_time, std::vector<double>& row) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const std::size_t place = places_[i];
      row[i] = place < message.size() ? message[place]
               : place == own_.size() ? static_cast<double>(log_time / kSecond)
                                      : static_cast<double>(log_time % kSecond);
    }
  }

 private:
  [[nodiscard]] bool Has(const char* name) const {
    return std::find(own_.begin(), own_.end(), name) != own_.end();
  }

  const std::vector<std::string>& own_;
  std::vector<std::size_t> places_;
};

void ReadBagNumbers(const LogSource& source, const std::vector<std::string>& names,
                    const TakeLogRow& take) {
  const BagMessage message = MessageOfTopic(source.file, source.topic);
  BagColumns columns(names, message, source.file, source.topic);
  std::vector<double> numbers;
  std::vector<double> row(names.size());
  int count = 0;
  ReadBagMessages(source.file, source.topic, [&](std::string_view data, std::int64_t log_time) {
    ++count;
    try {
      message.Read(data, numbers);
    } catch (const InputError& error) {
      throw InputError(Problem{.file = source.file.string(),
                               .key = fmt::format("{}, message {}", source.topic, count),
                               .message = error.problems().front().message});
    }
    columns.Take(numbers, log_time, row);
    take(row, count);
  });
}

}  // namespace

BagMessage MessageOfTopic(const std::filesystem::path& file, const std::string& topic) {
  std::vector<std::string> names;
  for (const BagTopic& own : ReadBagTopics(file).topics) {
    if (own.name == topic) {
      if (own.encoding != "cdr") {
        throw InputError(Problem{.file = file.string(),
                                 .key = topic,
                                 .message = fmt::format("its messages are in the encoding '{}'; "
                                                        "must be cdr",
                                                        own.encoding)});
      }
      return BagMessage(own.type, own.definition);
    }
    names.push_back(own.name);
  }
  throw InputError(Problem{.file = file.string(),
                           .message = fmt::format("no topic {}", UnknownName(topic, names))});
}

void ReadLogNumbers(const LogSource& source, const WantedColumns& columns, const TakeLogRow& take) {
  if (IsGlobeFile(source.file)) {
    ReadGlobeNumbers(source.file, columns.names, take);
    return;
  }
  if (IsBag(source.file)) {
    ReadBagNumbers(source, columns.names, take);
    return;
  }
  ReadCsvColumns(source.file, columns.names, columns.delimiter, columns.time, take);
}

std::string FieldOfColumn(const std::string& column) {
  const std::size_t dot = column.starts_with('/') ? column.find('.') : std::string::npos;
  return dot == std::string::npos ? column : column.substr(dot + 1);
}

std::string TopicOfColumn(const std::string& column) {
  const std::size_t dot = column.starts_with('/') ? column.find('.') : std::string::npos;
  return dot == std::string::npos ? "" : column.substr(0, dot);
}

}  // namespace trackbed
