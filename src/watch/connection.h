#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "src/watch/live_run.h"

namespace trackbed {

/// The content that a server offers.
struct Site {
  boost::asio::ip::address address;           ///< IP address at which the server listens.
  std::shared_ptr<const std::string> page{};  ///< HTML page, shared with connections that are still
                                              ///< sending it.
  LiveRun* live = nullptr;  ///< The run in progress; null if no run is in progress.
};

/// A WebSocket connection. The object owns itself while operations are pending.
class LiveConnection;

/// The connections of a server, which all run in one thread.
class Connections {
 public:
  /// Serves HTTP on a new connection, and a WebSocket if the client requests it. `site` must
  /// outlive this object.
  void Add(boost::asio::ip::tcp::socket socket, const Site& site);

  /// Sends new messages on each WebSocket that is not busy sending.
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
