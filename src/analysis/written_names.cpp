#include "trackbed/analysis/written_names.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cstdint>
#include <fstream>
#include <optional>

#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file_name.h"
#include "trackbed/recording/banked_track.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/scenario/record.h"
#include "trackbed/sim/scene.h"

// Lists the files that each verb may write, as patterns with variable parts such as <plant>.csv.
// 1. AllResultNames and AllVerbNames are the tables of results and of verbs.
// 2. A file name matches a pattern if it contains the pattern's fixed parts in order, with at least
//    one character between two parts.
// 3. HasMark recognizes pictures, pages and films of Trackbed by marks in their contents: a chunk
//    of the PNG or WebP file, a line of the web page, or a box of the MP4 file.
namespace trackbed {
namespace {

using Names = std::vector<std::string>;

/// Returns the name patterns of the asset files that belong to a composed model (sim/scene.h).
const Names& AssetNames() {
  static const Names names{"asset<number>_<file>", "ground_<number>.hfield"};
  return names;
}

Names With(Names names, const Names& more) {
  for (const std::string& name : more) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  }
  return names;
}

Names PlanNames() {
  return With({run_folder::kPlanJson}, run_folder::PathFiles());
}

Names RunNames() {
  Names names = With({run_folder::kScenarioYaml}, InputFileNames());
  names = With(names, {kVehicleXml, run_folder::kModelXml});
  names = With(With(names, AssetNames()), PlanNames());
  return With(names, {"<plant>.csv", "<plant>.state.csv", "<plant>.plan.csv", "<plant>.plan.json",
                      "<plant>.tree.csv", run_folder::kTimingJson, run_folder::kMcap,
                      run_folder::kMetricsJson});
}

/// Returns the fixed parts of a name pattern, that is, the parts outside angle brackets. For
/// example, the fixed parts of "<plant>.csv" are "" and ".csv".
Names FixedParts(const std::string& pattern) {
  Names parts{""};
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    if (pattern[at] == '<') {
      at = pattern.find('>', at);
      TRACKBED_CHECK(at != std::string::npos, "no end of a part in {}", pattern);
      parts.emplace_back();
    } else {
      parts.back() += pattern[at];
    }
  }
  return parts;
}

/// Returns whether a file name matches the pattern. The file name must consist of the pattern's
/// fixed parts in order, with at least one character between two parts.
bool Matches(const std::string& pattern, const std::string& name) {
  const Names parts = FixedParts(pattern);
  if (parts.size() == 1) {
    return name == pattern;
  }
  if (!name.starts_with(parts.front()) || !name.ends_with(parts.back())) {
    return false;
  }
  std::size_t at = parts.front().size() + 1;
  for (std::size_t i = 1; i + 1 < parts.size(); ++i) {
    const std::size_t found = name.find(parts[i], at);
    if (found == std::string::npos) {
      return false;
    }
    at = found + parts[i].size() + 1;
  }
  return at + parts.back().size() <= name.size();
}

/// Returns all names that result if each variable part of a name pattern is replaced by its known
/// values. Filled() returns an empty list if a variable part of the pattern has no known value.
Names Filled(const std::string& pattern, const NameParts& parts) {
  const std::size_t begin = pattern.find('<');
  if (begin == std::string::npos) {
    return {pattern};
  }
  const std::size_t end = pattern.find('>', begin);
  const auto texts = parts.find(pattern.substr(begin + 1, end - begin - 1));
  Names names;
  for (const std::string& text : texts == parts.end() ? Names() : texts->second) {
    names =
        With(names,
             Filled(pattern.substr(0, begin) + FileNameOf(text) + pattern.substr(end + 1), parts));
  }
  return names;
}

const VerbNames& OfVerb(std::string_view verb) {
  const std::vector<VerbNames>& all = AllVerbNames();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const VerbNames& own) { return own.verb == verb; });
  TRACKBED_CHECK(found != all.end(), "the verb {} has no list of names", verb);
  return *found;
}

/// Reads `size` bytes of a file, starting at `offset`. A negative offset counts from the end of the
/// file. BytesAt returns an empty text if the file has too few bytes.
std::string BytesAt(const std::filesystem::path& file, std::streamoff offset, std::size_t size) {
  std::string bytes(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.seekg(offset, offset < 0 ? std::ios::end : std::ios::beg);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  return in ? bytes : "";
}

std::string HeadOf(const std::filesystem::path& file) {
  constexpr std::size_t kHeadBytes = 4096;
  std::string bytes(kHeadBytes, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(kHeadBytes));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

std::string BigEndian(std::uint32_t number) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes += static_cast<char>(number >> shift & 0xffU);
  }
  return bytes;
}

}  // namespace

const std::vector<ResultNames>& AllResultNames() {
  using namespace run_folder;
  static const std::vector<ResultNames> results{
      {kRun, RunNames()},
      {kPlan, PlanNames()},
      {kComparison, {kCompareCsv, kCompareJson}},
      {kStudy, {kSweepCsv, kSweepJson}},
      {kFalsification, {kFalsifyJson}},
      {kVerification, {kVerifyJson}},
      {kCounterexample, {kCounterexampleYaml}},
      {kIdentification,
       With({kIdentifyJson, "<vehicle>.xml", "<record>.residuals.csv", kBankCsv, kTimingJson},
            AssetNames())},
      {kSubmission, {kArraySh, kMergeSh}},
  };
  return results;
}

const std::vector<VerbNames>& AllVerbNames() {
  using namespace run_folder;
  static const Names additions{kReport, kVideo, kPicture};
  static const std::vector<VerbNames> verbs{
      {"run", {kRun}, additions},
      {"plan", {kPlan}},
      {"import", {kRun}, additions},
      {"identify", {kIdentification}, {kReport, "records/<record>/"}},
      {"compare", {kRun, kComparison}, additions},
      {"check-path", {kRun}, additions, {"--report"}},
      {"sweep", {kStudy}, {kSweepRecords, kReport, "rows/<row>/", "shard_<number>_of_<number>/"}},
      {"sweep merge", {kStudy}, {kSweepRecords, kReport, "rows/<row>/"}},
      {"sweep submit", {kSubmission}, {"task_<number>.log", "merge.log"}},
      {"falsify",
       {kStudy, kFalsification},
       {kSweepRecords, kReport, std::string(kCounterexample) + "/"}},
      {"verify", {kStudy, kVerification}, {kSweepRecords, kReport}},
      {"watch", {kRun}, additions},
      {"report", {}, {kReport}, {"--out"}},
      {"render", {}, {kVideo, kPicture}, {"--out"}},
      {"test", {}, {}, {"--junit"}},
      {"fmu", {}, {}, {"--out"}},
      {"experiment", {}, {}, {"--out"}},
      {"model", {}, AssetNames(), {"--save", "--out"}},
  };
  return verbs;
}

std::vector<std::string> NamesOfVerb(std::string_view verb) {
  const VerbNames& own = OfVerb(verb);
  Names names;
  for (const ResultNames& result : AllResultNames()) {
    if (std::find(own.results.begin(), own.results.end(), result.result) != own.results.end()) {
      names = With(names, result.names);
    }
  }
  return With(names, own.others);
}

std::vector<std::string> FileNamesOfVerb(std::string_view verb, const NameParts& parts) {
  NameParts all = parts;
  all.emplace("plant", DrivenPlantNames());
  Names names;
  for (const std::string& name : NamesOfVerb(verb)) {
    if (!name.ends_with('/')) {
      names = With(names, Filled(name, all));
    }
  }
  return names;
}

bool IsNameOf(std::string_view result, const std::string& name) {
  const std::vector<ResultNames>& all = AllResultNames();
  const auto own = std::find_if(all.begin(), all.end(),
                                [&](const ResultNames& one) { return one.result == result; });
  return own != all.end() &&
         std::any_of(own->names.begin(), own->names.end(),
                     [&](const std::string& pattern) { return Matches(pattern, name); });
}

const std::string& PictureMark() {
  static const std::string chunk = [] {
    const std::string text("tEXtSoftware\0Trackbed", 21);
    boost::crc_32_type crc;
    crc.process_bytes(text.data(), text.size());
    return BigEndian(static_cast<std::uint32_t>(text.size() - 4)) + text +
           BigEndian(crc.checksum());
  }();
  return chunk;
}

const std::string& VideoMark() {
  static const std::string box = [] {
    const std::string text = "freeTrackbed";
    return BigEndian(static_cast<std::uint32_t>(text.size() + 4)) + text;
  }();
  return box;
}

const std::string& WebpMark() {
  static const std::string chunk("tkbd\x08\0\0\0Trackbed", 16);
  return chunk;
}

bool HasMark(const std::filesystem::path& file) {
  // Size of the signature and the chunk IHDR at the start of a PNG file.
  constexpr std::streamoff kPngHeader = 33;
  // Size of the chunk IEND at the end of a PNG file.
  constexpr std::streamoff kPngEnd = 12;
  const auto size = [](const std::string& mark) {
    return static_cast<std::streamoff>(mark.size());
  };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, ignored))) {
    return false;
  }
  const std::string ending = file.extension().string();
  if (ending == ".html") {
    return HeadOf(file).find(kPageMark) != std::string::npos;
  }
  if (ending == ".png") {
    return BytesAt(file, kPngHeader, PictureMark().size()) == PictureMark();
  }
  if (ending == ".apng") {
    const std::string& mark = PictureMark();
    return BytesAt(file, -size(mark) - kPngEnd, mark.size()) == mark;
  }
  if (ending == ".webp" || ending == ".mp4") {
    const std::string& mark = ending == ".webp" ? WebpMark() : VideoMark();
    return BytesAt(file, -size(mark), mark.size()) == mark;
  }
  return false;
}

}  // namespace trackbed
