// What comes as a request, and what is refused as none.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "view/http_request.hpp"

namespace flowdlo::view {
namespace {

const std::string kPlain = "GET /a/b?c HTTP/1.1\r\nHost: here:80\r\nAccept: */*\r\n\r\n";

TEST(HttpRequest, IsReadWhole) {
  const auto read = read_request(kPlain);
  ASSERT_TRUE(read.request);
  EXPECT_EQ(read.request->method, "GET");
  EXPECT_EQ(read.request->target, "/a/b?c");
  EXPECT_EQ(read.request->host, "here:80");
  EXPECT_EQ(read.refused, 0);
}

TEST(HttpRequest, WantsMoreUntilItsHeadIsThere) {
  for (std::size_t size = 0; size < kPlain.size(); ++size) {
    const auto read = read_request(kPlain.substr(0, size));
    EXPECT_FALSE(read.request) << size;
    EXPECT_EQ(read.refused, 0) << size;
  }
}

TEST(HttpRequest, NamesOfHeadersAndHostsHaveNoCase) {
  const auto read = read_request("HEAD / HTTP/1.0\r\nhOST:\t HeRe \r\n\r\nrest");
  ASSERT_TRUE(read.request);
  EXPECT_EQ(read.request->host, "here");
}

struct Refused {
  std::string bytes;
  int status;
};

TEST(HttpRequest, IsRefusedByTheCodeOfItsFault) {
  const std::string end = "\r\n\r\n";
  std::string many = "GET / HTTP/1.1\r\n";
  for (std::size_t i = 0; i <= kMostHeaders; ++i) many += "A: b\r\n";
  const std::vector<Refused> all = {
      {"GET  / HTTP/1.1" + end, 400},
      {"GET /" + end, 400},
      {"/ HTTP/1.1" + end, 400},
      {end, 400},
      {"GET / FTP/1.1" + end, 400},
      {"GET / HTTP/1.1 more" + end, 400},
      {"GET / HTTP/2.0" + end, 505},
      {"GET / HTTP/0.9" + end, 505},
      {"POST / HTTP/1.1" + end, 405},
      {"OPTIONS * HTTP/1.1" + end, 405},
      {"CONNECT there:443 HTTP/1.1" + end, 405},
      {"GET http://there/ HTTP/1.1" + end, 400},
      {"GET * HTTP/1.1" + end, 400},
      {"GET /" + std::string(kMostTargetBytes, 'a') + " HTTP/1.1" + end, 414},
      {"GET / HTTP/1.1\r\nHost here" + end, 400},
      {"GET / HTTP/1.1\r\nHost : here" + end, 400},
      {"GET / HTTP/1.1\r\n folded: x" + end, 400},
      {"GET / HTTP/1.1\r\n: x" + end, 400},
      {"GET / HTTP/1.1\r\nHost: a\r\nHost: a" + end, 400},
      {"GET / HTTP/1.1\r\nHost: a b" + end, 400},
      {"GET / HTTP/1.1\r\nA: b\nc" + end, 400},
      {std::string("GET / HTTP/1.1\r\nA: \0", 20) + end, 400},
      {"GET / HTTP/1.1\r\nContent-Length: 7" + end, 413},
      {"GET / HTTP/1.1\r\ncontent-length: -1" + end, 413},
      {"GET / HTTP/1.1\r\nTransfer-Encoding: chunked" + end, 413},
      {many + "\r\n", 431},
      {"GET /" + std::string(kMostHeadBytes, 'a'), 431},
      {std::string("GET \x01"), 400},
      {std::string("\x16\x03\x01\x02"), 400}};  // a TLS client
  for (const auto& one : all) {
    const auto read = read_request(one.bytes);
    EXPECT_EQ(read.refused, one.status) << one.bytes.substr(0, 60);
    EXPECT_FALSE(read.request) << one.bytes.substr(0, 60);
  }
}

TEST(HttpRequest, OfDamagedBytesIsNeverOutOfBounds) {
  std::mt19937 random(7);
  int taken = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bytes = kPlain;
    for (int change = 0; change < 1 + round % 4; ++change) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 3) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, 1 + random() % 5);
          break;
        default:
          bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 9));
      }
    }
    const auto read = read_request(bytes);
    if (!read.request) continue;
    ++taken;
    EXPECT_EQ(read.refused, 0);
    EXPECT_TRUE(read.request->method == "GET" || read.request->method == "HEAD");
    EXPECT_EQ(read.request->target.front(), '/');
    EXPECT_TRUE(std::all_of(read.request->target.begin(), read.request->target.end(),
                            [](char letter) { return letter > ' ' && letter <= '~'; }));
  }
  EXPECT_GT(taken, 1000);
}

}  // namespace
}  // namespace flowdlo::view
