#pragma once

#include <functional>
#include <memory>
#include <string>

#include "src/watch/live_run.h"

namespace trackbed {

/// Serves a page over HTTP, and the rows of a run in progress over a WebSocket (Boost.Beast). The
/// server handles requests only in the thread that calls Run.
///
/// The URL path of the page is `/`. During a run, the URL path of the WebSocket is `/live`.
/// Requests for other paths are answered with the status 404. The server rejects requests whose
/// Host header names another server (IsOwnHost), and WebSocket requests from pages of other sites.
/// Limits: 64 connections at a time (further connections are closed), request headers of 8 kB
/// without a body, and messages of 4 kB. The server closes a connection if a request takes more
/// than 15 s, or if a client is silent for more than one minute. If a client does not read the data
/// sent, the connection keeps at most one message in memory.
class Server {
 public:
  /// Makes a server that listens at an IP address and port. If `port` is 0, a free port is
  /// selected. Throws InputError if the address is invalid. Throws RunError if the server cannot
  /// listen, for example because the port is in use.
  Server(const std::string& host, int port);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// Returns the URL of the page, such as "http://127.0.0.1:41234/". If the server listens at all
  /// addresses, the URL contains the loopback address.
  [[nodiscard]] std::string url() const;

  /// Sets the page at `/` and the run in progress at `/live`; `live` is null if no run is in
  /// progress. The object `live` must outlive the server. Show() must be called before Run, or in
  /// the thread that calls Run.
  void Show(std::string page, LiveRun* live);

  /// Executes `work` in the thread that calls Run. Post is thread-safe.
  void Post(std::function<void()> work);

  /// Serves the clients' requests until the function `stop` returns true. `stop` is called several
  /// times per second. Run rethrows exceptions that functions passed to Post have thrown.
  void Run(const std::function<bool()>& stop);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace trackbed
