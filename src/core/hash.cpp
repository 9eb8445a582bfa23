#include "trackbed/core/hash.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <array>

#include "trackbed/core/error.h"

namespace trackbed {

struct Sha256Sum::Context {
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> digest{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Sha256Sum::Sha256Sum() : context_(std::make_unique<Context>()) {
  TRACKBED_CHECK(context_->digest != nullptr &&
                     EVP_DigestInit_ex(context_->digest.get(), EVP_sha256(), nullptr) == 1,
                 "OpenSSL has no SHA-256");
}

Sha256Sum::Sha256Sum(Sha256Sum&&) noexcept = default;
Sha256Sum& Sha256Sum::operator=(Sha256Sum&&) noexcept = default;
Sha256Sum::~Sha256Sum() = default;

void Sha256Sum::Add(std::string_view content) {
  TRACKBED_CHECK(EVP_DigestUpdate(context_->digest.get(), content.data(), content.size()) == 1,
                 "SHA-256 of {} bytes", content.size());
}

std::string Sha256Sum::Finish() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  TRACKBED_CHECK(EVP_DigestFinal_ex(context_->digest.get(), digest.data(), &size) == 1,
                 "SHA-256 failed");
  return fmt::format("{:02x}", fmt::join(digest.begin(), digest.begin() + size, ""));
}

std::string Sha256(std::string_view content) {
  Sha256Sum sum;
  sum.Add(content);
  return sum.Finish();
}

}  // namespace trackbed
