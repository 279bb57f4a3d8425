// The server beside clients that mean well, that are slow, and that mean harm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tools/view/http_client.hpp"
#include "view/http_server.hpp"

namespace flowdlo::view {
namespace {

using namespace std::chrono_literals;
using test::body_of;
using test::fetched;
using test::HttpClient;
using test::status_of;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr std::size_t kLarge = 64U << 20U;  // more than the system keeps for a client

/// A server that answers with what it was asked, on a thread of its own.
class Running {
 public:
  explicit Running(const HttpLimits& limits = {}) : server_(*HttpServer::listen(0, limits)) {
    if (::pipe(stop_.data()) != 0) throw std::runtime_error("pipe");
    thread_ = std::thread([this] { served_ = static_cast<bool>(server_.serve(answer, stop_[0])); });
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    EXPECT_EQ(::write(stop_[1], "x", 1), 1);
    thread_.join();
    EXPECT_TRUE(served_);
    ::close(stop_[0]);
    ::close(stop_[1]);
  }

  [[nodiscard]] int port() const { return server_.port(); }
  [[nodiscard]] std::string host() const { return server_.authority(); }

 private:
  static HttpResponse answer(const HttpRequest& request) {
    if (request.target == "/large") return {200, "text/plain", std::string(kLarge, 'x')};
    if (request.target == "/slow") std::this_thread::sleep_for(600ms);
    return {200, "text/plain", request.target};
  }

  HttpServer server_;
  std::array<int, 2> stop_{};
  bool served_ = false;
  std::thread thread_;
};

std::string answer_to(const Running& server, const std::string& bytes) {
  HttpClient client(server.port());
  client.send(bytes);
  auto answer = client.received();
  EXPECT_TRUE(client.closed());
  return answer;
}

TEST(HttpServer, AnswersWhatItIsAsked) {
  const Running server;
  const auto answer = fetched(server.port(), "/some/where");
  EXPECT_EQ(status_of(answer), "200");
  EXPECT_EQ(body_of(answer), "/some/where");
  EXPECT_THAT(answer, HasSubstr("Content-Length: 11\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
}

TEST(HttpServer, HeadHasNoBody) {
  const Running server;
  const auto answer = answer_to(server, "HEAD /a HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n");
  EXPECT_THAT(answer, HasSubstr("Content-Length: 2\r\n"));
  EXPECT_THAT(answer, EndsWith("\r\n\r\n"));
}

TEST(HttpServer, TakesARequestByteByByte) {
  const Running server;
  HttpClient client(server.port());
  for (const char byte : "GET /slowly HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n") {
    client.send({&byte, 1});
  }
  EXPECT_EQ(body_of(client.received()), "/slowly");
}

TEST(HttpServer, SendsWhatIsLargerThanItsBuffers) {
  const Running server;
  EXPECT_EQ(body_of(fetched(server.port(), "/large")).size(), kLarge);
}

TEST(HttpServer, IsNoOtherHost) {
  const Running server;
  for (const std::string host :
       {"", "Host: elsewhere.example\r\n", "Host: elsewhere.example:80\r\n", "Host: 0.0.0.0\r\n"}) {
    const auto answer = answer_to(server, "GET / HTTP/1.1\r\n" + host + "\r\n");
    EXPECT_EQ(status_of(answer), "421") << host;
  }
}

TEST(HttpServer, RefusesAndGoesOn) {
  const Running server;
  const std::string end = "\r\n\r\n";
  EXPECT_EQ(status_of(answer_to(server, "nonsense" + end)), "400");
  EXPECT_EQ(status_of(answer_to(server, "\x16\x03\x01")), "400");
  EXPECT_EQ(status_of(answer_to(server, "DELETE / HTTP/1.1" + end)), "405");
  const std::string body(100000, 'b');
  EXPECT_EQ(status_of(answer_to(server, "GET / HTTP/1.1\r\nContent-Length: 100000" + end + body)),
            "413");
  EXPECT_EQ(status_of(answer_to(server, std::string(100000, 'a'))), "431");
  EXPECT_EQ(status_of(fetched(server.port(), "/")), "200");
}

TEST(HttpServer, IsNotReachedFromElsewhere) {
  const Running server;
  ifaddrs* all = nullptr;
  ASSERT_EQ(::getifaddrs(&all), 0);
  int others = 0;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const auto address = reinterpret_cast<sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr;
    if (address == htonl(INADDR_LOOPBACK)) continue;
    ++others;
    EXPECT_FALSE(HttpClient(server.port(), address).connected());
  }
  ::freeifaddrs(all);
  EXPECT_FALSE(HttpClient(server.port(), htonl(INADDR_LOOPBACK + 1)).connected());
  RecordProperty("addresses", others);
}

TEST(HttpServer, SilentClientsAreLetGoAndKeepNobodyOut) {
  const Running server({.connections = 3, .request = 400ms});
  std::vector<std::unique_ptr<HttpClient>> silent;
  for (int i = 0; i < 3; ++i) {
    silent.push_back(std::make_unique<HttpClient>(server.port()));
    silent.back()->send("GET /never-en");
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(status_of(fetched(server.port(), "/")), "200");  // waits until one of them is let go
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 100ms);
  for (const auto& one : silent) {
    EXPECT_EQ(one->received(), "");
    EXPECT_TRUE(one->closed());
  }
}

TEST(HttpServer, DrippingBytesWinNoTime) {
  const Running server({.request = 400ms});
  HttpClient client(server.port());
  const auto begin = std::chrono::steady_clock::now();
  while (client.received(50ms).empty() && !client.closed()) {
    client.send("a");
    ASSERT_LT(std::chrono::steady_clock::now() - begin, 30s);
  }
  EXPECT_TRUE(client.closed());
}

TEST(HttpServer, AClientThatDoesNotReadIsLetGo) {
  const Running server({.connections = 1, .response = 400ms});
  HttpClient deaf(server.port());
  deaf.send("GET /large HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n");
  EXPECT_EQ(status_of(fetched(server.port(), "/")), "200");  // the one place is free again
  EXPECT_LT(deaf.received().size(), kLarge);
}

TEST(HttpServer, AClientThatLeavesIsForgotten) {
  const Running server({.connections = 1});
  for (int i = 0; i < 20; ++i) {
    HttpClient client(server.port());
    client.send(i % 2 == 0 ? "GET" : "GET /large HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n");
  }
  EXPECT_EQ(status_of(fetched(server.port(), "/")), "200");
}

TEST(HttpServer, ASlowAnswerCostsNoOtherItsTime) {
  const Running server({.request = 400ms});
  HttpClient slow(server.port());
  HttpClient other(server.port());
  other.send("GET /ot");
  std::this_thread::sleep_for(50ms);
  slow.send("GET /slow HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n");
  std::this_thread::sleep_for(500ms);  // beyond its deadline, while the server is at work
  other.send("her HTTP/1.1\r\nHost: " + server.host() + "\r\n\r\n");
  EXPECT_EQ(body_of(slow.received()), "/slow");
  EXPECT_EQ(body_of(other.received()), "/other");
}

TEST(HttpServer, SaysThatAPortIsTaken) {
  const Running server;
  const auto second = HttpServer::listen(server.port());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kIo);
  EXPECT_THAT(second.error().message, HasSubstr("--port"));
}

}  // namespace
}  // namespace flowdlo::view
