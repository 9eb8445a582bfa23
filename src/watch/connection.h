#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "src/watch/live_run.h"

namespace trackbed {

/// What a server shows.
struct Site {
  boost::asio::ip::address address;           ///< where it listens
  std::shared_ptr<const std::string> page{};  ///< shared with connections that still write it
  LiveRun* live = nullptr;                    ///< null when nothing goes on
};

/// One WebSocket, which keeps itself alive as long as something is under way on it.
class LiveConnection;

/// The connections of a server, all in one thread.
class Connections {
 public:
  /// Serves HTTP on a new connection, and a WebSocket if the client asks for one. `site` must
  /// outlive it.
  void Add(boost::asio::ip::tcp::socket socket, const Site& site);

  /// Sends to each WebSocket that is not busy what its page does not know.
  void TellNews();

  /// Forgets those that are closed.
  void Forget();
  [[nodiscard]] std::size_t size() const { return open_.size(); }

  /// For a connection that has become a WebSocket.
  void AddLive(const std::shared_ptr<LiveConnection>& live);

 private:
  std::vector<std::weak_ptr<void>> open_;
  std::vector<std::weak_ptr<LiveConnection>> live_;
};

}  // namespace trackbed
