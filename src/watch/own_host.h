#pragma once

#include <boost/asio/ip/address.hpp>
#include <string_view>

/// Recognizes requests that come from a page of this server.
namespace trackbed {

/// Whether the Host header names the server that listens at `address`. In an attack by DNS
/// rebinding, a browser sends the name of the attacker's site instead. Accepted names are `address`
/// and, if `address` is a loopback address or unspecified (0.0.0.0 or ::), localhost. If `address`
/// is unspecified, any IP address is accepted. Any port is accepted, since the connection may come
/// through a port forwarder.
bool IsOwnHost(std::string_view host, const boost::asio::ip::address& address);

/// Whether the Origin header of a page shows that the page was loaded from `host`, which is the
/// value of a Host header.
bool IsOwnOrigin(std::string_view origin, std::string_view host);

}  // namespace trackbed
