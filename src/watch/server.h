#pragma once

#include <functional>
#include <memory>
#include <string>

#include "src/watch/live_run.h"

namespace trackbed {

/// Serves one page over HTTP, and the rows of a run in progress over a WebSocket (Boost.Beast), all
/// in the thread that calls Run.
///
/// `/` is the page, `/live` the WebSocket while there is a LiveRun; other paths are not found.
/// Requests whose Host is not this server's (IsOwnHost) and WebSockets of other pages are refused.
/// Limits: 64 connections at a time, further ones are closed; 8 kB of request header and no body; 4
/// kB per message; 15 s per request; one minute without an answer. A connection that does not read
/// holds one message in memory.
class Server {
 public:
  /// Listens at an IP address; port 0 chooses a free port. Throws InputError for an invalid
  /// address, and RunError if listening fails, such as on a port in use.
  Server(const std::string& host, int port);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// "http://127.0.0.1:41234/"; a server on all addresses returns the loopback address.
  [[nodiscard]] std::string url() const;

  /// Sets the content of `/` and the run behind `/live`; none if null. The run must outlive the
  /// server. Call before Run, or in its thread.
  void Show(std::string page, LiveRun* live);

  /// Runs `work` in the thread of Run. Thread-safe.
  void Post(std::function<void()> work);

  /// Serves until `stop`, polled several times per second, returns true. Exceptions of posted work
  /// propagate.
  void Run(const std::function<bool()>& stop);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace trackbed
