#pragma once

#include <functional>
#include <memory>
#include <string>

#include "src/watch/live_run.h"

namespace trackbed {

/// Serves a page over HTTP, and the rows of a run in progress over a WebSocket (Boost.Beast). The
/// server works only in the thread that calls Run.
///
/// The page has the path `/`. During a run, the WebSocket has the path `/live`. Other paths give
/// the status 404. The server rejects requests whose Host header is not its own (IsOwnHost), and
/// WebSocket requests from pages of other sites. Limits: 64 connections at a time (further
/// connections are closed), request headers of 8 kB without a body, messages of 4 kB, 15 s per
/// request, and one minute without an answer from the client. If a client does not read, its
/// connection keeps at most one message in memory.
class Server {
 public:
  /// Listens at an IP address and port. Port 0 selects a free port. Throws InputError for an
  /// invalid address. Throws RunError if the server cannot listen, for example because the port is
  /// in use.
  Server(const std::string& host, int port);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  /// Returns the URL of the page, such as "http://127.0.0.1:41234/". If the server listens at all
  /// addresses, the URL has the loopback address.
  [[nodiscard]] std::string url() const;

  /// Sets the page at `/` and the run at `/live`; `live` is null if there is no run. The run must
  /// outlive the server. Show() must be called before Run, or in the thread that calls Run.
  void Show(std::string page, LiveRun* live);

  /// Executes `work` in the thread that calls Run. Post is thread-safe.
  void Post(std::function<void()> work);

  /// Serves until `stop` returns true. `stop` is called several times per second. Run rethrows
  /// exceptions of posted work.
  void Run(const std::function<bool()>& stop);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace trackbed
