#include "bench/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed::bench {
namespace {

using Json = nlohmann::json;

struct Ratio {
  double median = 0.0;
  double q1 = 0.0;
  double q3 = 0.0;
  double limit = 0.0;
};

struct Entry {
  std::string name;
  std::string error;  // empty: it ran
  double cpu_time = 0.0;
  std::string unit;
  std::optional<Ratio> ratio;
};

struct Record {
  std::string machine;
  std::string version;
  std::vector<Entry> entries;

  [[nodiscard]] const Entry* Find(const std::string& name) const {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const Entry& entry) { return entry.name == name; });
    return found == entries.end() ? nullptr : &*found;
  }
};

/// The name without Google Benchmark's suffix, as in
/// "ClosedLoop/three_turns/iterations:7/manual_time".
std::string ShortName(const std::string& name) {
  return name.substr(0, std::min(name.find("/iterations:"), name.find("/manual_time")));
}

Entry ReadEntry(const Json& json) {
  Entry entry{.name = ShortName(json.at("name"))};
  if (json.value("error_occurred", false)) {
    entry.error = json.value("error_message", "no message");
    return entry;
  }
  entry.cpu_time = json.at("cpu_time");
  entry.unit = json.at("time_unit");
  if (json.contains("ratio")) {
    entry.ratio = Ratio{.median = json.at("ratio"),
                        .q1 = json.at("ratio_q1"),
                        .q3 = json.at("ratio_q3"),
                        .limit = json.at("limit")};
  }
  return entry;
}

Record ReadRecord(const std::filesystem::path& file) {
  Record record;
  const std::string text = ReadFile(file);
  try {
    const Json json = Json::parse(text);
    const Json& context = json.at("context");
    record.machine = fmt::format("{}, {} cores, {}", context.at("cpu").get<std::string>(),
                                 context.at("cores").get<std::string>(),
                                 context.at("build_type").get<std::string>());
    record.version = context.at("trackbed");
    for (const Json& entry : json.at("benchmarks")) {
      record.entries.push_back(ReadEntry(entry));
    }
  } catch (const Json::exception& error) {
    throw InputError(Problem{.file = file.string(),
                             .message = fmt::format("no record of benchmarks: {}", error.what())});
  }
  return record;
}

std::string Text(const Ratio& ratio) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", ratio.median, ratio.q1, ratio.q3);
}

std::string Verdict(const Ratio& before, const Ratio& after) {
  return after.q3 < before.q1 ? "better" : after.q1 > before.q3 ? "worse" : "";
}

std::string Verdict(double before, double after) {
  constexpr double kNoise = 1.1;
  return before > kNoise * after ? "better" : after > kNoise * before ? "worse" : "";
}

std::string Row(const std::string& name, const std::string& before, const std::string& after,
                const std::string& verdict) {
  std::string row = fmt::format("{:<48} {:<24} {:<24} {}", name, before, after, verdict);
  row.erase(row.find_last_not_of(' ') + 1);
  row.push_back('\n');
  return row;
}

std::string ChangeRow(const Entry& before, const Entry& after, bool times) {
  if (!before.error.empty() || !after.error.empty()) {
    const auto state = [](const Entry& entry) { return entry.error.empty() ? "ran" : "failed"; };
    return Row(after.name, state(before), state(after), after.error);
  }
  if (before.ratio && after.ratio) {
    return Row(after.name, Text(*before.ratio), Text(*after.ratio),
               Verdict(*before.ratio, *after.ratio));
  }
  return Row(after.name, fmt::format("{:.4g} {}", before.cpu_time, before.unit),
             fmt::format("{:.4g} {}", after.cpu_time, after.unit),
             times && before.unit == after.unit ? Verdict(before.cpu_time, after.cpu_time) : "");
}

}  // namespace

std::string RatioTable(const std::filesystem::path& record) {
  std::string table = Row("benchmark", "ratio (quartiles)", "limit", "");
  for (const Entry& entry : ReadRecord(record).entries) {
    if (!entry.error.empty()) {
      table += Row(entry.name, "failed", "", entry.error);
    } else if (entry.ratio) {
      table += Row(entry.name, Text(*entry.ratio), fmt::format("{:g}", entry.ratio->limit),
                   entry.ratio->median > entry.ratio->limit ? "above its limit" : "");
    }
  }
  return table;
}

std::string ChangeTable(const std::filesystem::path& before, const std::filesystem::path& after) {
  const Record old_record = ReadRecord(before);
  const Record new_record = ReadRecord(after);
  const bool times = old_record.machine == new_record.machine;
  std::string table = fmt::format("before: {}, {}\nafter:  {}, {}\n", old_record.version,
                                  old_record.machine, new_record.version, new_record.machine);
  table += times ? "\n" : "Times of different machines are not compared, only ratios.\n\n";
  table += Row("benchmark", "before", "after", "");
  for (const Entry& entry : new_record.entries) {
    const Entry* old_entry = old_record.Find(entry.name);
    table += old_entry != nullptr ? ChangeRow(*old_entry, entry, times)
                                  : Row(entry.name, "", "new", entry.error);
  }
  std::vector<std::string> left_out;
  for (const Entry& entry : old_record.entries) {
    if (new_record.Find(entry.name) == nullptr) {
      left_out.push_back(entry.name);
    }
  }
  if (!left_out.empty()) {
    table += fmt::format("\nnot run now: {}\n", fmt::join(left_out, ", "));
  }
  return table;
}

}  // namespace trackbed::bench
