#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trackbed {

/// The default limit on the size of an input file [bytes]. A log of one hour at 100 rows per second
/// has about half the size of this limit.
inline constexpr std::size_t kMaxFileBytes = std::size_t{512} << 20U;

/// Reads a whole file as bytes. RunError naming the file if it is missing, is not a regular file
/// (OpenInput), or has more than `max_bytes` bytes. Never reads more than `max_bytes` bytes.
std::string ReadFile(const std::filesystem::path& file, std::size_t max_bytes = kMaxFileBytes);

/// Reads a file as a stream: calls `take` with successive blocks of at most 64 KiB until `take`
/// returns false. Throws the RunErrors of ReadFile.
void ReadBlocks(const std::filesystem::path& file,
                const std::function<bool(std::string_view block)>& take,
                std::size_t max_bytes = kMaxFileBytes);

/// Writes `content` beside `file` under a temporary name and renames it, so that `file` is either
/// unchanged or complete, even if the process is killed. If any step fails, for example on a full
/// disk, removes the temporary file and throws RunError. The content is not forced to the disk
/// (fsync), which would take up to tens of milliseconds per file. After a power failure a file may
/// therefore be empty; the hashes in manifest.json (analysis/output_folder.h) reveal the loss.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view content);

/// Checks, before long work, that WriteFileAtomically can write the file. RunError if a folder has
/// the name of the file, or if the file's folder is missing or unwritable. Creates no file.
void CheckCanWrite(const std::filesystem::path& file);

/// Creates the folder and its parents. RunError if they cannot be created.
void MakeFolder(const std::filesystem::path& folder);

class Descriptor;

/// Opens an input file; every reader uses this function. RunError naming the file if it is missing
/// or not a regular file. Pipes and devices are rejected because they may block or never end, and
/// because many inputs are read twice.
Descriptor OpenInput(const std::filesystem::path& file);

/// A file descriptor that is closed by its destructor.
class Descriptor {
 public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  [[nodiscard]] int get() const { return descriptor_; }
  /// Closes the descriptor and returns 0 or an errno. Some file systems only report a full disk on
  /// closing.
  int Close();

 private:
  int descriptor_;
};

/// A new file in a folder that no other process uses. Errors are RunErrors naming `shown`, the
/// final name of the file. An incomplete file may remain after an error.
class NewFile {
 public:
  NewFile(const std::filesystem::path& file, std::filesystem::path shown);
  /// Appends to the file.
  void Write(std::string_view content);
  /// Closes the file. Call Close last: some file systems only report a full disk on closing.
  void Close();

 private:
  std::filesystem::path shown_;
  Descriptor descriptor_;
};

/// Creates a NewFile with the given content.
void WriteNewFile(const std::filesystem::path& file, std::string_view content,
                  const std::filesystem::path& shown);

/// A new, empty file in the folder of `file`, to be filled and then published under that name. The
/// temporary name is ".STEM.PID-N.trackbed" with the extension of `file`, because some writers
/// depend on the extension. A lock (flock) distinguishes the file from the leftover of a killed
/// process. The destructor removes the file.
class TemporaryFile {
 public:
  /// Creates the file. RunError naming `file` if its folder is missing or unwritable.
  explicit TemporaryFile(std::filesystem::path file);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Appends to the file. Errors are RunErrors naming `file`.
  void Write(std::string_view content);
  /// Renames the complete file to `file`, or to the target of a link of that name. RunError on
  /// failure, or if the name belongs to something other than a regular file. Call Publish only
  /// once.
  void Publish();

 private:
  std::filesystem::path file_;
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// A new, empty folder in the folder of `file`, for parts of that file. The folder is named, locked
/// and removed like a TemporaryFile.
class TemporaryFolder {
 public:
  /// Creates the folder. RunError naming `file` if its folder is missing or unwritable.
  explicit TemporaryFolder(const std::filesystem::path& file);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Removes the TemporaryFiles and TemporaryFolders of killed processes from the folder. Temporaries
/// of running processes stay. On file systems without locks, all temporaries stay. Never fails.
void RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// Prepares for long work that ends with writing `file`. Creates the file's folder, removes
/// temporary files of killed processes from the folder, and checks that the file can be written.
/// Throws the RunErrors of MakeFolder and CheckCanWrite.
void PrepareToWrite(const std::filesystem::path& file);

/// Checks whether an input file in the folder `own` may refer to the file `name`, given relative to
/// `own`. Returns an empty text if the file may be read: after following links, it lies in or below
/// `own` or one of `others`. A file with an absolute name must lie in one of `others`. If the file
/// may not be read, returns the end of an error message ("lies outside of ...").
std::string ReadAccessError(const std::filesystem::path& name, const std::filesystem::path& own,
                            const std::vector<std::filesystem::path>& others);

}  // namespace trackbed
