#include "src/watch/own_host.h"

#include <boost/asio/ip/address.hpp>
#include <boost/beast/core/string.hpp>
#include <string>

namespace trackbed {

namespace {

namespace beast = boost::beast;

/// Returns the name in a Host header without the port, and without the brackets of an IPv6 address.
std::string_view NameOf(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

bool EqualIgnoringCase(std::string_view a, std::string_view b) {
  return beast::iequals({a.data(), a.size()}, {b.data(), b.size()});
}

}  // namespace

bool IsOwnHost(std::string_view host, const boost::asio::ip::address& address) {
  const std::string_view name = NameOf(host);
  if (EqualIgnoringCase(name, "localhost")) {
    return address.is_loopback() || address.is_unspecified();
  }
  boost::system::error_code error;
  const auto named = boost::asio::ip::make_address(std::string(name), error);
  return !error && (named == address || address.is_unspecified());
}

bool IsOwnOrigin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && EqualIgnoringCase(origin.substr(kScheme.size()), host);
}

}  // namespace trackbed
