#include "src/watch/connection.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "src/watch/own_host.h"

// Implements the connections of the watch server with Boost.Beast in a single thread. The class
// HttpConnection answers GET and HEAD requests with the page. Before answering, HttpConnection
// checks the headers Host and Origin, so that pages of other sites can neither read nor control the
// run. An upgrade request turns the connection into a LiveConnection, which reads commands from the
// page and sends new rows to the page, one message at a time.
namespace trackbed {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

constexpr std::uint32_t kMaxHeaderBytes = 8192;  // [bytes]
constexpr std::size_t kMaxMessageBytes = 4096;   // [bytes]
constexpr std::chrono::seconds kRequestTime{15};
// Time limit for sending a page, whose size may reach 170 MB if the page contains a video.
constexpr std::chrono::seconds kPageTime{600};
// Maximum time without data from a client; after half of this time, the server pings the client.
constexpr std::chrono::seconds kIdleTime{60};

std::string_view View(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

/// Reads commands from a page, and sends new rows to the page, one message at a time.
class LiveConnection : public std::enable_shared_from_this<LiveConnection> {
 public:
  LiveConnection(beast::tcp_stream stream, LiveRun& run) : socket_(std::move(stream)), run_(run) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = kRequestTime;
    timeout.idle_timeout = kIdleTime;
    timeout.keep_alive_pings = true;
    socket_.set_option(timeout);
    socket_.read_message_max(kMaxMessageBytes);
    socket_.text(true);
  }

  void Accept(const http::request<http::empty_body>& request) {
    // the WebSocket uses the timeout that the constructor of LiveConnection sets
    beast::get_lowest_layer(socket_).expires_never();
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (!error) {
        self->is_open_ = true;
        self->Read();
        self->SendUpdates();
      }
    });
  }

  void SendUpdates() {
    if (!is_open_ || writes_) {
      return;
    }
    std::optional<std::string> news = run_.Next(cursor_);
    if (!news) {
      return;
    }
    writes_ = true;
    message_ = std::move(*news);
    socket_.async_write(asio::buffer(message_),
                        [self = shared_from_this()](error_code error, std::size_t /*bytes*/) {
                          self->writes_ = false;
                          if (!error) {
                            self->SendUpdates();
                          }
                        });
  }

 private:
  void Read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t /*n*/) {
      if (error) {
        self->is_open_ = false;
        return;
      }
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      const std::string problem =
          self->socket_.got_text() ? self->run_.Execute(text) : "expected text";
      if (!problem.empty()) {
        self->Close(problem);
        return;
      }
      self->Read();
    });
  }

  void Close(const std::string& problem) {
    is_open_ = false;
    websocket::close_reason reason(websocket::close_code::policy_error);
    reason.reason.assign(problem.data(), std::min(problem.size(), reason.reason.max_size()));
    socket_.async_close(reason, [self = shared_from_this()](error_code /*error*/) {});
  }

  websocket::stream<beast::tcp_stream> socket_;
  LiveRun& run_;
  beast::flat_buffer buffer_;
  std::string message_;  // message that is currently being sent
  LiveRun::Cursor cursor_;
  bool is_open_ = false;
  bool writes_ = false;
};

namespace {

/// Answers HTTP requests on a connection one after the other, until the client closes the
/// connection or requests a WebSocket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, const Site& site, Connections& connections)
      : stream_(std::move(socket)), site_(site), connections_(connections) {}

  void Read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeaderBytes);
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t /*bytes*/) {
                       self->Answer(error);
                     });
  }

 private:
  using Request = http::request<http::empty_body>;

  void Answer(error_code error) {
    if (error == http::error::end_of_stream) {
      stream_.socket().shutdown(tcp::socket::shutdown_send, error);
      return;
    }
    if (error.category() == http::make_error_code(http::error::bad_method).category()) {
      const bool large = error == http::error::header_limit || error == http::error::body_limit;
      Send(large ? http::status::request_header_fields_too_large : http::status::bad_request,
           Text(error.message()), Head::kNo, false);
      return;
    }
    if (error) {
      return;  // the client has closed the connection or has exceeded a time limit
    }
    const Request request = parser_->release();
    const std::string_view host = View(request[http::field::host]);
    if (!IsOwnHost(host, site_.address)) {
      Send(
          http::status::forbidden,
          Text("This server is not called that: open the address that trackbed watch has printed."),
          HeadOf(request), false);
    } else if (websocket::is_upgrade(request)) {
      Upgrade(request);
    } else {
      Reply(request);
    }
  }

  void Upgrade(const Request& request) {
    const std::string_view origin = View(request[http::field::origin]);
    // A WebSocket request without the header Origin does not come from a browser, and therefore not
    // from a page of another site.
    const bool own = request.count(http::field::origin) == 0 ||
                     IsOwnOrigin(origin, View(request[http::field::host]));
    if (!own) {
      Send(http::status::forbidden, Text("This WebSocket is of its own page alone."), Head::kNo,
           false);
    } else if (request.target() != "/live" || site_.live == nullptr) {
      Send(http::status::not_found, Text("Nothing is running here."), Head::kNo, false);
    } else {
      const auto live = std::make_shared<LiveConnection>(std::move(stream_), *site_.live);
      connections_.AddLive(live);
      live->Accept(request);
    }
  }

  void Reply(const Request& request) {
    const bool keep = request.keep_alive();
    const Head head = HeadOf(request);
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      Send(http::status::method_not_allowed, Text("Only GET and HEAD."), head, false);
    } else if (request.target() != "/") {
      Send(http::status::not_found, Text("There is only /."), head, keep);
    } else {
      Send(http::status::ok, {site_.page, "text/html; charset=utf-8"}, head, keep);
    }
  }

  enum class Head { kNo, kYes };
  static Head HeadOf(const Request& request) {
    return request.method() == http::verb::head ? Head::kYes : Head::kNo;
  }

  struct Content {
    std::shared_ptr<const std::string> text;
    const char* type;
  };
  static Content Text(const std::string& text) {
    return {std::make_shared<const std::string>(text + "\n"), "text/plain; charset=utf-8"};
  }

  void Send(http::status status, Content content, Head head, bool keep_alive) {
    content_ = std::move(content.text);
    http::response<http::span_body<const char>> response{status, 11};
    response.set(http::field::content_type, content.type);
    response.set(http::field::cache_control, "no-store");
    response.set("Referrer-Policy", "no-referrer");
    // Sets HTTP headers that forbid other sites to embed or read the page.
    response.set(http::field::x_frame_options, "DENY");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.keep_alive(keep_alive);
    response.content_length(content_->size());
    if (head == Head::kNo) {
      response.body() = {content_->data(), content_->size()};
    }
    response_.emplace(std::move(response));
    serializer_.emplace(*response_);
    stream_.expires_after(kPageTime);
    const auto sent = [self = shared_from_this(), keep_alive](error_code error, std::size_t /*n*/) {
      if (!error && keep_alive) {
        self->Read();
      } else {
        self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
      }
    };
    if (head == Head::kYes) {
      http::async_write_header(stream_, *serializer_, sent);
    } else {
      http::async_write(stream_, *serializer_, sent);
    }
  }

  beast::tcp_stream stream_;
  const Site& site_;
  Connections& connections_;
  beast::flat_buffer buffer_{kMaxHeaderBytes + 1024};
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::shared_ptr<const std::string> content_;
  std::optional<http::response<http::span_body<const char>>> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
};

template <typename Pointer>
void ForgetExpired(std::vector<Pointer>& pointers) {
  std::erase_if(pointers, [](const Pointer& pointer) { return pointer.expired(); });
}

}  // namespace

void Connections::Add(tcp::socket socket, const Site& site) {
  const auto connection = std::make_shared<HttpConnection>(std::move(socket), site, *this);
  open_.emplace_back(connection);
  connection->Read();
}

void Connections::AddLive(const std::shared_ptr<LiveConnection>& live) {
  open_.emplace_back(live);
  live_.emplace_back(live);
}

void Connections::SendUpdates() {
  ForgetExpired(live_);
  for (const std::weak_ptr<LiveConnection>& connection : live_) {
    if (const std::shared_ptr<LiveConnection> live = connection.lock()) {
      live->SendUpdates();
    }
  }
}

void Connections::Forget() {
  ForgetExpired(open_);
}

}  // namespace trackbed
