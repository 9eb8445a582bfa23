#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "src/watch/live_run.h"

namespace trackbed {

/// The content that a watch server offers.
struct Site {
  boost::asio::ip::address address;  ///< IP address at which the server listens.
  /// HTML page, whose ownership is shared with the connections that are still sending it.
  std::shared_ptr<const std::string> page{};
  /// The run in progress that the server shows; null if no run is in progress.
  LiveRun* live = nullptr;
};

/// A WebSocket connection. A LiveConnection keeps itself alive while network operations are
/// pending.
class LiveConnection;

/// The open connections of a server, which are all handled in one thread.
class Connections {
 public:
  /// Serves HTTP requests on a new connection. Changes the connection to a WebSocket if the client
  /// requests a WebSocket. `site` must outlive this object.
  void Add(boost::asio::ip::tcp::socket socket, const Site& site);

  /// Sends new messages on each WebSocket that is not currently sending.
  void SendUpdates();

  /// Removes closed connections.
  void Forget();
  [[nodiscard]] std::size_t size() const { return open_.size(); }

  /// Adds a connection that has been upgraded to a WebSocket.
  void AddLive(const std::shared_ptr<LiveConnection>& live);

 private:
  std::vector<std::weak_ptr<void>> open_;
  std::vector<std::weak_ptr<LiveConnection>> live_;
};

}  // namespace trackbed
