#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

/// Clients of a server on the loopback interface; they block without a timeout.
namespace trackbed {

namespace beast = boost::beast;
namespace http = beast::http;

/// The port of a URL such as "http://127.0.0.1:4000/".
inline std::uint16_t PortOf(const std::string& url) {
  const std::size_t colon = url.rfind(':');
  return static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1)));
}

class TcpClient {
 public:
  explicit TcpClient(std::uint16_t port) {
    socket_.connect({boost::asio::ip::address_v4::loopback(), port});
  }
  void Write(const std::string& text) { boost::asio::write(socket_, boost::asio::buffer(text)); }
  /// Reads until the other side closes.
  std::string ReadAll() {
    std::string text;
    boost::system::error_code ignored;
    boost::asio::read(socket_, boost::asio::dynamic_buffer(text), ignored);
    return text;
  }
  boost::asio::ip::tcp::socket& socket() { return socket_; }

 private:
  boost::asio::io_context context_;
  boost::asio::ip::tcp::socket socket_{context_};
};

using Answer = http::response<http::string_body>;

/// Sends GET for a target; `change` may set more headers.
inline Answer Get(std::uint16_t port, const std::string& target,
                  const std::function<void(http::request<http::empty_body>&)>& change = {}) {
  http::request<http::empty_body> request{http::verb::get, target, 11};
  request.set(http::field::host, "127.0.0.1:" + std::to_string(port));
  if (change) {
    change(request);
  }
  TcpClient client(port);
  http::write(client.socket(), request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(std::uint64_t{1} << 28U);
  parser.skip(request.method() == http::verb::head);
  http::read(client.socket(), buffer, parser);
  return parser.release();
}

/// The WebSocket client of a page.
class LiveClient {
 public:
  explicit LiveClient(std::uint16_t port, const std::string& origin = "",
                      const std::string& target = "/live")
      : socket_(context_) {
    beast::get_lowest_layer(socket_).connect({boost::asio::ip::address_v4::loopback(), port});
    socket_.set_option(
        beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
          if (!origin.empty()) {
            request.set(http::field::origin, origin);
          }
        }));
    socket_.handshake(answer_, "127.0.0.1:" + std::to_string(port), target);
  }

  void Say(const std::string& text) { socket_.write(boost::asio::buffer(text)); }
  nlohmann::json Hear() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    return nlohmann::json::parse(beast::buffers_to_string(buffer.data()));
  }
  /// Returns the next message of this type.
  nlohmann::json HearOf(const std::string& type) {
    for (;;) {
      nlohmann::json message = Hear();
      if (message.at("type") == type) {
        return message;
      }
    }
  }
  beast::websocket::stream<boost::asio::ip::tcp::socket>& socket() { return socket_; }

 private:
  boost::asio::io_context context_;
  beast::websocket::response_type answer_;
  beast::websocket::stream<boost::asio::ip::tcp::socket> socket_;
};

}  // namespace trackbed
