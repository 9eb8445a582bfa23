#include "src/watch/server.h"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>

#include "src/watch/connection.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMaxConnections = 64;
/// Interval between two checks for new rows of the run in progress.
constexpr std::chrono::milliseconds kTick{40};

tcp::endpoint EndpointOf(const std::string& host, int port) {
  error_code error;
  const asio::ip::address address = asio::ip::make_address(host, error);
  if (error) {
    throw InputError(
        Problem{.key = "--host",
                .message = fmt::format("'{}' is not an IP address, such as 127.0.0.1 or ::1; "
                                       "0.0.0.0 is all of this machine",
                                       host)});
  }
  return {address, static_cast<std::uint16_t>(port)};
}

}  // namespace

class Server::Implementation {
 public:
  Implementation(const std::string& host, int port)
      : endpoint_(EndpointOf(host, port)), acceptor_(context_), timer_(context_) {
    try {
      acceptor_.open(endpoint_.protocol());
      acceptor_.set_option(tcp::acceptor::reuse_address(true));
      acceptor_.bind(endpoint_);
      acceptor_.listen();
      endpoint_ = acceptor_.local_endpoint();
    } catch (const boost::system::system_error& error) {
      throw RunError(fmt::format("cannot listen on {} port {}: {}{}", host, port,
                                 error.code().message(),
                                 port > 0 ? "; without --port, any free port is used" : ""));
    }
    site_.address = endpoint_.address();
  }

  [[nodiscard]] std::string url() const {
    asio::ip::address address = endpoint_.address();
    if (address.is_unspecified()) {
      address = address.is_v4() ? asio::ip::address(asio::ip::address_v4::loopback())
                                : asio::ip::address(asio::ip::address_v6::loopback());
    }
    return address.is_v6() ? fmt::format("http://[{}]:{}/", address.to_string(), endpoint_.port())
                           : fmt::format("http://{}:{}/", address.to_string(), endpoint_.port());
  }

  void Show(std::string page, LiveRun* live) {
    site_.page = std::make_shared<const std::string>(std::move(page));
    site_.live = live;
  }

  void Post(std::function<void()> work) { asio::post(context_, std::move(work)); }

  void Run(const std::function<bool()>& stop) {
    Accept();
    Tick(stop);
    context_.run();
  }

 private:
  void Accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) {
        return;
      }
      // if a connection cannot be accepted, for example for lack of file descriptors, the server
      // tries again later
      if (error) {
        wait_to_accept_ = true;
        return;
      }
      connections_.Forget();
      if (connections_.size() < kMaxConnections) {
        connections_.Add(std::move(socket), site_);
      }
      Accept();
    });
  }

  void Tick(const std::function<bool()>& stop) {
    if (stop()) {
      context_.stop();
      return;
    }
    if (std::exchange(wait_to_accept_, false)) {
      Accept();
    }
    connections_.SendUpdates();
    timer_.expires_after(kTick);
    timer_.async_wait([this, &stop](error_code error) {
      if (!error) {
        Tick(stop);
      }
    });
  }

  asio::io_context context_{1};
  tcp::endpoint endpoint_;
  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  Site site_;
  Connections connections_;
  bool wait_to_accept_ = false;
};

Server::Server(const std::string& host, int port)
    : implementation_(std::make_unique<Implementation>(host, port)) {}

Server::~Server() = default;

std::string Server::url() const {
  return implementation_->url();
}

void Server::Show(std::string page, LiveRun* live) {
  implementation_->Show(std::move(page), live);
}

void Server::Post(std::function<void()> work) {
  implementation_->Post(std::move(work));
}

void Server::Run(const std::function<bool()>& stop) {
  implementation_->Run(stop);
}

}  // namespace trackbed
