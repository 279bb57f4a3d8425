#include "tools/view/http_client.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace flowdlo::test {

HttpClient::HttpClient(int port, std::uint32_t address)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = address == 0 ? htonl(INADDR_LOOPBACK) : address;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof(to)) == 0;
}

HttpClient::~HttpClient() { ::close(socket_); }

void HttpClient::send(std::string_view bytes) {
  [[maybe_unused]] const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::string HttpClient::received(std::chrono::milliseconds patience) {
  std::string all;
  const auto until = std::chrono::steady_clock::now() + patience;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    pollfd watched{socket_, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&watched, 1, static_cast<int>(left.count())) <= 0) return all;
    std::array<char, 65536> block{};
    const auto got = ::recv(socket_, block.data(), block.size(), 0);
    if (got <= 0) {
      closed_ = true;
      return all;
    }
    all.append(block.data(), static_cast<std::size_t>(got));
  }
}

std::string fetched(int port, const std::string& target) {
  HttpClient client(port);
  client.send("GET " + target +
              " HTTP/1.1\r\nHost: local"
              "host:" +
              std::to_string(port) + "\r\n\r\n");
  return client.received();
}

std::string body_of(const std::string& answer) {
  const auto end = answer.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : answer.substr(end + 4);
}

std::string status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? answer.substr(9, 3) : std::string();
}

}  // namespace flowdlo::test
