#pragma once

#include <boost/asio/ip/address.hpp>
#include <string_view>

/// Recognizes HTTP requests that come from a page of this server.
namespace trackbed {

/// Whether the Host header names the server that listens at `address`. In an attack by DNS
/// rebinding, the Host header contains the name of the attacker's site instead. The accepted host
/// names are `address` and, if `address` is a loopback address or unspecified (0.0.0.0 or ::),
/// localhost. If `address` is unspecified, any IP address is also accepted as host name. Any port
/// is accepted, because the connection may come through a port forwarder.
bool IsOwnHost(std::string_view host, const boost::asio::ip::address& address);

/// Whether the header `origin` shows that the requesting page was loaded from `host`, the value of
/// a Host header.
bool IsOwnOrigin(std::string_view origin, std::string_view host);

}  // namespace trackbed
