#include "src/watch/own_host.h"

#include <gtest/gtest.h>

namespace trackbed {
namespace {

const auto kLoopback = boost::asio::ip::make_address("127.0.0.1");
const auto kLoopback6 = boost::asio::ip::make_address("::1");
const auto kAll = boost::asio::ip::make_address("0.0.0.0");
const auto kLan = boost::asio::ip::make_address("192.168.7.1");

TEST(OwnHost, IsTheAddressOrLocalhost) {
  EXPECT_TRUE(IsOwnHost("127.0.0.1:4000", kLoopback));
  EXPECT_TRUE(IsOwnHost("localhost:4000", kLoopback));
  EXPECT_TRUE(IsOwnHost("LOCALHOST", kLoopback));
  EXPECT_TRUE(IsOwnHost("[::1]:4000", kLoopback6));
  EXPECT_TRUE(IsOwnHost("192.168.7.1:80", kLan));
}

// DNS can point any name at this host; a page of that name would have the same origin.
TEST(OwnHost, IsNoOtherName) {
  for (const char* host :
       {"evil.example", "evil.example:4000", "localhost.evil.example", "127.0.0.1.evil.example",
        "127.0.0.1@evil.example", "", ":4000", "[", "[]", "[::1", "127.0.0.1x", "127.1",
        "0x7f000001", " 127.0.0.1", "127.0.0.2", "localhost.", "user@localhost"}) {
    EXPECT_FALSE(IsOwnHost(host, kLoopback)) << host;
  }
  EXPECT_FALSE(IsOwnHost("localhost", kLan));
  EXPECT_FALSE(IsOwnHost("192.168.7.1", kLoopback));
}

TEST(OwnHost, IsAnyAddressOfAServerOnAllOfThem) {
  EXPECT_TRUE(IsOwnHost("192.168.7.1:4000", kAll));
  EXPECT_TRUE(IsOwnHost("localhost:4000", kAll));
  EXPECT_FALSE(IsOwnHost("evil.example", kAll));
}

TEST(OwnOrigin, IsThatOfTheHost) {
  EXPECT_TRUE(IsOwnOrigin("http://127.0.0.1:4000", "127.0.0.1:4000"));
  for (const char* origin : {"http://127.0.0.1:4001", "https://127.0.0.1:4000", "null", "",
                             "http://evil.example", "http://127.0.0.1:4000.evil.example"}) {
    EXPECT_FALSE(IsOwnOrigin(origin, "127.0.0.1:4000")) << origin;
  }
}

}  // namespace
}  // namespace trackbed
