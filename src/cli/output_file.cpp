#include "src/cli/output_file.h"

#include <fmt/format.h>

#include <fstream>
#include <ios>
#include <system_error>

#include "trackbed/analysis/foreign_files.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/hash.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

/// Reads as many bytes of a file as `like` has, from `offset` on. A negative offset counts from the
/// end of the file.
std::string BytesAt(const fs::path& file, std::streamoff offset, std::string_view like) {
  std::string bytes(like.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  in.seekg(offset, offset < 0 ? std::ios::end : std::ios::beg);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return in ? bytes : "";
}

[[noreturn]] void Refuse(const char* option, const fs::path& file, const std::string& reason) {
  throw InputError(Problem{.file = option,
                           .message = fmt::format("{} {}, and would be replaced; name another file",
                                                  file.string(), reason)});
}

}  // namespace

fs::path OutputFolderOf(const std::string& option, const fs::path& below, const fs::path& parent) {
  return option.empty() ? FolderBelow(parent, below) : fs::path(option);
}

WroteFile BeginsWith(std::string text) {
  return [text = std::move(text)](const fs::path& file) { return BytesAt(file, 0, text) == text; };
}

WroteFile HasInHead(std::string text) {
  return [text = std::move(text)](const fs::path& file) {
    constexpr std::size_t kHeadBytes = 4096;
    std::string head(kHeadBytes, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    return head.find(text) != std::string::npos;
  };
}

WroteFile EndsWith(std::string text) {
  return [text = std::move(text)](const fs::path& file) {
    return BytesAt(file, -static_cast<std::streamoff>(text.size()), text) == text;
  };
}

std::string ModelMark(std::string_view xml) {
  return fmt::format("<!-- Trackbed {} -->\n", Sha256(xml));
}

bool IsUneditedModel(const fs::path& file) {
  static const std::size_t size = ModelMark("").size();
  const std::string text = ReadFile(file);
  return text.size() > size && text.substr(text.size() - size) ==
                                   ModelMark(std::string_view(text).substr(0, text.size() - size));
}

void PrepareOutputFile(const char* option, const fs::path& file,
                       const std::vector<fs::path>& inputs, const WroteFile& wrote) {
  for (const fs::path& input : inputs) {
    std::error_code missing;
    if (fs::is_regular_file(file, missing) && fs::equivalent(file, input, missing)) {
      Refuse(option, file, "is an input of this command");
    }
  }
  if (const std::string result = ResultThatLists(file); !result.empty()) {
    Refuse(option, file, fmt::format("is a file of the {} in its folder", result));
  }
  // Allow the output if it is an empty file, or a device such as /dev/null, which is not replaced.
  std::error_code absent;
  if (fs::is_regular_file(file, absent) && fs::file_size(file, absent) > 0 && !wrote(file)) {
    Refuse(option, file, "is not a file that this option has written, or was edited since");
  }
  PrepareToWrite(file);
}

}  // namespace trackbed::cli
