#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "src/watch/live_run.h"

namespace trackbed {

/// The content that a server serves.
struct Site {
  boost::asio::ip::address address;           ///< Listening address of the server.
  std::shared_ptr<const std::string> page{};  ///< Page, shared with connections that are still
                                              ///< writing it.
  LiveRun* live = nullptr;                    ///< The run; null if no run is in progress.
};

/// A WebSocket connection that keeps itself alive while operations are pending.
class LiveConnection;

/// The connections of a server, all in one thread.
class Connections {
 public:
  /// Serves HTTP on a new connection, and a WebSocket if the client requests one. `site` must
  /// outlive the Connections object.
  void Add(boost::asio::ip::tcp::socket socket, const Site& site);

  /// Sends news to each WebSocket that is not writing.
  void SendUpdates();

  /// Forgets closed connections.
  void Forget();
  [[nodiscard]] std::size_t size() const { return open_.size(); }

  /// Adds a connection that has become a WebSocket.
  void AddLive(const std::shared_ptr<LiveConnection>& live);

 private:
  std::vector<std::weak_ptr<void>> open_;
  std::vector<std::weak_ptr<LiveConnection>> live_;
};

}  // namespace trackbed
