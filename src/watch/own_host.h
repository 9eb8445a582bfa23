#pragma once

#include <boost/asio/ip/address.hpp>
#include <string_view>

/// Recognizes requests that come from a page of this server.
namespace trackbed {

/// Whether the Host header names the server at `address`. A browser that another site's DNS
/// directed here (DNS rebinding) sends the name of that site. Accepted names are `address` and, if
/// it is a loopback address or unspecified, localhost. If `address` is unspecified, any IP address
/// is an accepted name. The port in the header may be that of a forwarder.
bool IsOwnHost(std::string_view host, const boost::asio::ip::address& address);

/// Whether a page with this Origin header was loaded from `host`, given as in the Host header.
bool IsOwnOrigin(std::string_view origin, std::string_view host);

}  // namespace trackbed
