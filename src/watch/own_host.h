#pragma once

#include <boost/asio/ip/address.hpp>
#include <string_view>

/// Which requests come from a page of this server, and from nobody's else.
namespace trackbed {

/// Whether a browser that sends this Host header was told to go to the server at `address`, and not
/// to a name that somebody else's DNS leads there (DNS rebinding): the host is that address, or
/// localhost where the address is this machine's own, or, where it is all addresses of the machine,
/// any address. The port may be another's that is forwarded.
bool IsOwnHost(std::string_view host, const boost::asio::ip::address& address);

/// Whether a page with this Origin header has been loaded from `host`, as its Host header says.
bool IsOwnOrigin(std::string_view origin, std::string_view host);

}  // namespace trackbed
