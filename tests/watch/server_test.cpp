#include "src/watch/server.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/watch/watched_run.h"

namespace trackbed {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;
using Close = beast::websocket::close_code;

/// A run that waits at its start and receives all kinds of requests. After each request, the server
/// must still answer.
class ServerOfARun : public testing::Test {
 protected:
  [[nodiscard]] std::uint16_t port() const { return run_.port(); }
  void TearDown() override {
    EXPECT_EQ(Get(port(), "/").result(), http::status::ok);
    LiveClient client(port());
    EXPECT_EQ(client.HearOf("rows").at("plants")[0].at("rows").size(), 1U);
  }
  /// Sends raw bytes and returns the answer until the server closes.
  [[nodiscard]] std::string AnswerTo(const std::string& bytes) const {
    TcpClient client(port());
    client.Write(bytes);
    return client.ReadAll();
  }
  [[nodiscard]] std::string Host() const { return "127.0.0.1:" + std::to_string(port()); }

 private:
  TempFolder folder_;
  WatchedRun run_{Corner(), folder_.path() / "out", {.paused = true}};
};

TEST_F(ServerOfARun, HasOnePageAndNothingElse) {
  for (const char* target :
       {"/index.html", "/../etc/passwd", "//", "/?", "/live", "*", "http://127.0.0.1/", "/%00"}) {
    EXPECT_EQ(Get(port(), target).result(), http::status::not_found) << target;
  }
  const Answer head = Get(port(), "/", [](auto& request) { request.method(http::verb::head); });
  EXPECT_EQ(head.result(), http::status::ok);
  EXPECT_GT(std::stoul(std::string(head["Content-Length"])), 100000U);
  EXPECT_EQ(head.body(), "");
  for (const http::verb verb : {http::verb::post, http::verb::put, http::verb::delete_,
                                http::verb::options, http::verb::connect}) {
    EXPECT_EQ(Get(port(), "/", [&](auto& request) { request.method(verb); }).result(),
              http::status::method_not_allowed);
  }
}

TEST_F(ServerOfARun, RefusesOtherHosts) {
  for (const char* host : {"evil.example", "evil.example:80", "localhost.evil.example", ""}) {
    const Answer answer =
        Get(port(), "/", [&](auto& request) { request.set(http::field::host, host); });
    EXPECT_EQ(answer.result(), http::status::forbidden) << host;
    EXPECT_EQ(answer.body().find("<script"), std::string::npos);
  }
  const Answer forwarded =
      Get(port(), "/", [](auto& request) { request.set(http::field::host, "localhost:9"); });
  EXPECT_EQ(forwarded.result(), http::status::ok);
  EXPECT_THAT(AnswerTo("GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 403"));
}

TEST_F(ServerOfARun, RefusesWebSocketsOfOtherPages) {
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), "https://" + Host(),
        "http://localhost:" + std::to_string(port()), std::string("http://127.0.0.1:1")}) {
    EXPECT_THROW(LiveClient(port(), origin), boost::system::system_error) << origin;
  }
  EXPECT_THROW(LiveClient(port(), "", "/other"), boost::system::system_error);
  LiveClient own(port(), "http://" + Host());
  EXPECT_EQ(own.Hear().at("type"), "state");
}

TEST_F(ServerOfARun, AnswersWhatIsNoHttp) {
  for (const std::string& bytes :
       {std::string("hello\r\n\r\n"), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9\r\n\r\n"), std::string("GET / HTTP/1.1\r\nHost\r\n\r\n"),
        std::string("\x16\x03\x01\x02\x00\x01", 6) + std::string(512, '\0'),
        std::string("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: x\r\n\r\n")}) {
    EXPECT_THAT(AnswerTo(bytes), StartsWith("HTTP/1.1 400")) << bytes;
  }
}

TEST_F(ServerOfARun, RefusesLargeHeadersAndBodies) {
  EXPECT_THAT(AnswerTo("GET / HTTP/1.1\r\nHost: " + Host() + "\r\nX: " + std::string(9000, 'x')),
              StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(AnswerTo("GET /" + std::string(9000, 'x')), StartsWith("HTTP/1.1 431"));
  const std::string body = std::string(4096, 'x');
  EXPECT_THAT(
      AnswerTo("POST / HTTP/1.1\r\nHost: " + Host() + "\r\nContent-Length: 4096\r\n\r\n" + body),
      StartsWith("HTTP/1.1 4"));
}

TEST_F(ServerOfARun, OutlivesRequestsThatAreNotFinished) {
  for (const char* bytes : {"", "G", "GET / HTTP/1.1\r\nHost: 127."}) {
    TcpClient client(port());
    client.Write(bytes);
  }
}

/// Runs `say` on a WebSocket and returns the server's close reason.
template <typename Say>
beast::websocket::close_reason ClosedAfter(std::uint16_t port, const Say& say) {
  LiveClient client(port);
  say(client);
  beast::flat_buffer buffer;
  boost::system::error_code error;
  while (!error) {
    client.socket().read(buffer, error);
  }
  return client.socket().reason();
}

TEST_F(ServerOfARun, ClosesAfterMessagesThatItDoesNotKnow) {
  const auto reason = ClosedAfter(port(), [](LiveClient& client) { client.Say("{"); });
  EXPECT_EQ(reason.code, Close::policy_error);
  EXPECT_THAT(std::string(reason.reason.c_str()), HasSubstr(R"({"do": "pause"})"));
  EXPECT_EQ(ClosedAfter(port(), [](LiveClient& client) { client.Say(R"({"do":"speed"})"); }).code,
            Close::policy_error);
  EXPECT_EQ(ClosedAfter(port(),
                        [](LiveClient& client) {
                          client.socket().binary(true);
                          client.Say(R"({"do":"pause"})");
                        })
                .code,
            Close::policy_error);
  EXPECT_EQ(
      ClosedAfter(port(), [](LiveClient& client) { client.Say(std::string(5000, ' ')); }).code,
      Close::too_big);
}

TEST_F(ServerOfARun, OutlivesFramesThatAreNone) {
  LiveClient client(port());
  boost::asio::write(client.socket().next_layer(), boost::asio::buffer(std::string(100, '\xff')));
  beast::flat_buffer buffer;
  boost::system::error_code error;
  while (!error) {
    client.socket().read(buffer, error);
  }
}

TEST_F(ServerOfARun, ClosesConnectionsBeyondItsBound) {
  std::vector<std::unique_ptr<TcpClient>> clients;
  for (int i = 0; i < 64; ++i) {
    clients.push_back(std::make_unique<TcpClient>(port()));
  }
  // The server accepts connections in order, so the earlier ones are accepted before this one.
  EXPECT_EQ(TcpClient(port()).ReadAll(), "");
  clients.clear();
  // Waits until the server has noticed that the clients have gone.
  while (AnswerTo("GET / HTTP/1.1\r\nHost: " + Host() + "\r\nConnection: close\r\n\r\n").empty()) {
  }
}

// A client that never reads while thousands of rows arrive must delay neither other clients nor the
// end of the run.
TEST(Server, IsNotHeldUpByAPageThatDoesNotRead) {
  const TempFolder folder;
  WatchedRun run(Corner(), folder.path() / "out",
                 {.speed = std::numeric_limits<double>::infinity(), .paused = true});
  std::vector<std::unique_ptr<LiveClient>> deaf;
  for (int i = 0; i < 8; ++i) {
    deaf.push_back(std::make_unique<LiveClient>(run.port()));
  }
  LiveClient client(run.port());
  client.Say(R"({"do":"resume"})");
  client.HearOf("finished");
  EXPECT_FALSE(run.Interrupt().interrupted);
}

}  // namespace
}  // namespace trackbed
