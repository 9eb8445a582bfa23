#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trackbed {

/// The default limit on the size of an input file [bytes]. The default size limit of input files is
/// about twice the size of a one-hour log with 100 rows per second.
inline constexpr std::size_t kMaxFileBytes = std::size_t{512} << 20U;

/// Reads a whole file as bytes. Throws RunError if the file is missing, is not a regular file
/// (OpenInput), or has more than `max_bytes` bytes. Never reads more than `max_bytes` bytes.
std::string ReadFile(const std::filesystem::path& file, std::size_t max_bytes = kMaxFileBytes);

/// Reads a file as a stream: calls `take` with successive blocks of at most 64 KiB until `take`
/// returns false. Throws RunError in the same cases as ReadFile.
void ReadBlocks(const std::filesystem::path& file,
                const std::function<bool(std::string_view block)>& take,
                std::size_t max_bytes = kMaxFileBytes);

/// Writes `content` to a temporary file next to `file`, then renames the temporary file to `file`.
/// Even if the process is killed, `file` contains either the complete old or the complete new
/// content. If writing fails, for example because the disk is full, removes the temporary file and
/// throws RunError. WriteFileAtomically does not force the content to the disk (fsync), which would
/// take up to tens of milliseconds per file. After a power failure, a file without fsync may be
/// empty; the hashes in manifest.json (analysis/output_folder.h) reveal the loss.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view content);

/// Checks that WriteFileAtomically can write the file. Call CheckCanWrite before long work whose
/// result is written to the file. Throws RunError if a folder has the name of the file, if the file
/// is a link whose target is absent, or if the file's folder is missing or unwritable. Creates no
/// file.
void CheckCanWrite(const std::filesystem::path& file);

/// Creates the folder and its parents. Throws RunError if a folder cannot be created.
void MakeFolder(const std::filesystem::path& folder);

class Descriptor;

/// Opens an input file; all functions that read input files use OpenInput. Throws RunError if the
/// file is missing or is not a regular file. Pipes and devices are rejected because they may block
/// or never end, and because many inputs are read twice.
Descriptor OpenInput(const std::filesystem::path& file);

/// A file descriptor that is closed by its destructor.
class Descriptor {
 public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  [[nodiscard]] int get() const { return descriptor_; }
  /// Closes the descriptor. Returns 0 on success, else the errno of the failed close. Some file
  /// systems only report a full disk on closing.
  int Close();

 private:
  int descriptor_;
};

/// Writes a new file in a folder that no other process uses. If writing fails, throws RunError with
/// a message that names `shown`, the final name of the file. An incomplete file may remain after an
/// error.
class NewFile {
 public:
  NewFile(const std::filesystem::path& file, std::filesystem::path shown);
  /// Appends `content` to the file.
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

/// Creates a new, empty file next to `file`. Publish() renames the new file to `file` when its
/// content is complete. The temporary name is ".STEM.PID-N.trackbed" followed by the extension of
/// `file`, because some libraries choose the file format by the extension. The process locks the
/// temporary file (flock); an unlocked temporary file was left behind by a killed process. The
/// destructor of TemporaryFile removes the temporary file.
class TemporaryFile {
 public:
  /// Creates the temporary file next to `file`. Throws RunError if the folder of `file` is missing
  /// or unwritable, if `file` exists and is not a regular file, or if `file` is a link whose target
  /// is absent.
  explicit TemporaryFile(std::filesystem::path file);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Appends `content` to the temporary file. Throws RunError, naming `file`, if writing fails.
  void Write(std::string_view content);
  /// Renames the complete temporary file to `file`; if `file` is a link, to the target of the link.
  /// Throws RunError if renaming fails, if `file` exists and is not a regular file, or if `file` is
  /// a link whose target is absent. Call Publish only once.
  void Publish();

 private:
  std::filesystem::path file_;
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Creates a new, empty folder next to `file`, for temporary parts of that file. The temporary
/// folder is named, locked and removed in the same way as a TemporaryFile.
class TemporaryFolder {
 public:
  /// Creates the temporary folder next to `file`. Throws RunError if the folder of `file` is
  /// missing or unwritable.
  explicit TemporaryFolder(const std::filesystem::path& file);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Removes temporary files and folders from `folder` if the process that created them was killed.
/// Keeps the temporary files of running processes. On file systems without locks, keeps all
/// temporary files. Never fails.
void RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// Prepares to write `file` at the end of long work. Creates the file's folder, removes temporary
/// files of killed processes from the folder, and checks that the file can be written. Throws
/// RunError in the same cases as MakeFolder and CheckCanWrite.
void PrepareToWrite(const std::filesystem::path& file);

/// Checks whether an input file in the folder `own` may refer to the file `name`, given relative to
/// `own`. Returns an empty text if the file may be read. A file may be read if it lies, after
/// following links, in or below the folder `own` or one of the folders `others`. A file with an
/// absolute name must lie in or below one of the folders `others`. If the file may not be read,
/// returns a predicate to append to the file name in an error message ("lies outside of ...").
std::string ReadAccessError(const std::filesystem::path& name, const std::filesystem::path& own,
                            const std::vector<std::filesystem::path>& others);

}  // namespace trackbed
