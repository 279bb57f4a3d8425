// HttpClient: a connection to a port of this computer, as a well-meaning or a hostile client has
// it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace flowdlo::test {

class HttpClient {
 public:
  /// To the loopback address, or to another of this computer, in the network's order.
  explicit HttpClient(int port, std::uint32_t address = 0);
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;
  ~HttpClient();

  [[nodiscard]] bool connected() const { return connected_; }
  void send(std::string_view bytes);
  /// All until the server closes the connection, or the time is over.
  [[nodiscard]] std::string received(std::chrono::milliseconds patience = std::chrono::seconds(60));
  /// Whether the server closed the connection while received() waited.
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  int socket_;
  bool connected_ = false;
  bool closed_ = false;
};

/// The whole answer to a GET as a browser sends it.
[[nodiscard]] std::string fetched(int port, const std::string& target);

/// What follows the head.
[[nodiscard]] std::string body_of(const std::string& answer);

/// "200" of "HTTP/1.1 200 OK"; empty where there is none.
[[nodiscard]] std::string status_of(const std::string& answer);

}  // namespace flowdlo::test
