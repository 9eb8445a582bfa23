#pragma once

#include <functional>
#include <memory>
#include <string>

#include "src/watch/live_run.h"

namespace trackbed {

/// Serves one page over HTTP, and the rows of a run in progress over a WebSocket (Boost.Beast). All
/// work of the server is in the thread that calls Run.
///
/// The path `/` is the page, and `/live` the WebSocket while there is a LiveRun. Paths other than
/// `/` and `/live` are not found. The server refuses requests whose Host is not its own
/// (IsOwnHost), and WebSockets of other pages. Limits: 64 connections at a time (further ones are
/// closed), 8 kB of request header and no body, 4 kB per message, 15 s per request, one minute
/// without an answer. A connection that does not read holds one message in memory.
class Server {
 public:
  /// Listens at an IP address. Port 0 chooses a free port. Throws InputError for an invalid
  /// address. Throws RunError if listening fails, such as on a port in use.
  Server(const std::string& host, int port);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// Address of the page, such as "http://127.0.0.1:41234/". The url of a server on all addresses
  /// has the loopback address.
  [[nodiscard]] std::string url() const;

  /// Sets the content of `/` and the run behind `/live`. If `live` is null, the server has no run.
  /// The run `live` must outlive the server. Show() must be called before Run, or in the thread of
  /// Run.
  void Show(std::string page, LiveRun* live);

  /// Runs `work` in the thread of Run. Post is thread-safe.
  void Post(std::function<void()> work);

  /// Serves until `stop` returns true. `stop` is polled several times per second. Exceptions of
  /// posted work propagate from Run.
  void Run(const std::function<bool()>& stop);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace trackbed
