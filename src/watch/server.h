#pragma once

#include <functional>
#include <memory>
#include <string>

#include "src/watch/live_run.h"

namespace trackbed {

/// Serves one page over HTTP, and the rows of a run that goes on over a WebSocket (Boost.Beast),
/// all in the thread that calls Run.
///
/// `/` is the page, `/live` the WebSocket while there is a LiveRun; anything else is not found.
/// Requests whose Host is not this server's (IsOwnHost) and WebSockets of other pages are refused.
/// Bounds: 64 connections at a time, further ones are closed; 8 kB of request header and no body;
/// 4 kB in a message; 15 s for a request; a minute without any answer. A connection that does not
/// read has one message in memory.
class Server {
 public:
  /// Listens at an IP address; port 0 is any free one. InputError for what is no address, RunError
  /// when it cannot listen there, such as on a port that is in use.
  Server(const std::string& host, int port);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// "http://127.0.0.1:41234/"; of a server on all addresses, with that of the loopback.
  [[nodiscard]] std::string url() const;

  /// What `/` is from now on, and whose rows `/live` has: nobody's if null. The run must outlive
  /// the server. Before Run, or in its thread.
  void Show(std::string page, LiveRun* live);

  /// Does `work` in the thread of Run. May be called by any thread.
  void Post(std::function<void()> work);

  /// Serves until `stop` gives true, which is asked some times a second. Exceptions of posted work
  /// pass through.
  void Run(const std::function<bool()>& stop);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace trackbed
