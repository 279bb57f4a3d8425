#include "view/http_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <list>
#include <utility>
#include <vector>

namespace flowdlo::view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMisdirected = 421;
constexpr int kBacklog = 16;
constexpr std::size_t kMostIgnoredBytes = 65536;  // of what follows a request

const char* words_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case kMisdirected:
      return "Misdirected Request";
    case 431:
      return "Request Header Fields Too Large";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Internal Server Error";
  }
}

/// What a browser is told beside the answer: to run and to load nothing that is not from here, to
/// keep nothing, and to show it in no other page.
constexpr const char* kGuards =
    "Cache-Control: no-store\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'unsafe-inline'; "
    "img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "X-Content-Type-Options: nosniff\r\n";

std::string bytes_of(const HttpResponse& response, bool with_body) {
  std::string bytes = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n{}{}\r\n",
      response.status, words_of(response.status), response.type, response.body.size(), kGuards,
      response.status == 405 ? "Allow: GET, HEAD\r\n" : "");
  if (with_body) bytes += response.body;
  return bytes;
}

enum class Phase { kReading, kWriting, kLeaving };

struct Connection {
  int socket;
  Clock::time_point until;
  Phase phase = Phase::kReading;
  std::string in{};
  std::string out{};
  std::size_t sent = 0;
  std::size_t ignored = 0;

  Connection(int its_socket, Clock::time_point deadline) : socket(its_socket), until(deadline) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::close(socket); }
};

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

/// One call of serve(): the connections under way.
class Talk {
 public:
  Talk(int listener, const HttpLimits& limits, const Handler& handler, std::string address,
       int port)
      : listener_(listener), limits_(limits), handler_(handler), port_(port) {
    hosts_ = {fmt::format("{}:{}", address, port), fmt::format("{}:{}",
                                                               "local"
                                                               "host",
                                                               port)};
  }

  /// Waits for something to happen, and does what there is to do. False: `stop` can be read.
  Result<bool> step(int stop);

 private:
  void accept_all();
  void attend(Connection& connection, bool readable, bool writable);
  void read(Connection& connection);
  void answer(Connection& connection, const ReadRequest& read);
  void write(Connection& connection);
  void ignore(Connection& connection);
  [[nodiscard]] HttpResponse response_to(const HttpRequest& request) const;
  [[nodiscard]] int patience_ms() const;
  void end(Connection& connection) { connection.until = Clock::time_point::min(); }

  int listener_;
  const HttpLimits& limits_;
  const Handler& handler_;
  int port_;
  std::vector<std::string> hosts_;
  std::list<Connection> connections_;
};

int Talk::patience_ms() const {
  auto first = Clock::now() + std::chrono::seconds(3600);
  for (const auto& one : connections_) first = std::min(first, one.until);
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(first - Clock::now()).count();
  return connections_.empty() ? -1 : static_cast<int>(std::max<long long>(0, left));
}

Result<bool> Talk::step(int stop) {
  std::vector<pollfd> watched{{stop, POLLIN, 0}};
  const bool room = connections_.size() < limits_.connections;
  watched.push_back({room ? listener_ : -1, POLLIN, 0});
  for (const auto& one : connections_) {
    const short event = one.phase == Phase::kWriting ? POLLOUT : POLLIN;
    watched.push_back({one.socket, event, 0});
  }
  if (::poll(watched.data(), watched.size(), patience_ms()) < 0 && errno != EINTR) {
    return Error{ErrorCode::kIo, fmt::format("flowdlo view: poll: {}", std::strerror(errno))};
  }
  if (watched[0].revents != 0) return false;
  std::size_t at = 2;
  for (auto& one : connections_) {
    const short events = watched[at++].revents;
    attend(one, (events & (POLLIN | POLLHUP | POLLERR)) != 0,
           (events & (POLLOUT | POLLHUP | POLLERR)) != 0);
  }
  const auto now = Clock::now();
  connections_.remove_if([now](const Connection& one) { return one.until <= now; });
  if (watched[1].revents != 0) accept_all();
  return true;
}

void Talk::accept_all() {
  while (connections_.size() < limits_.connections) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) {
      if (errno == ECONNABORTED || errno == EINTR) continue;
      if (!would_block()) ::usleep(50000);  // no descriptor is free: some will be
      return;
    }
    connections_.emplace_back(socket, Clock::now() + limits_.request);
  }
}

void Talk::attend(Connection& connection, bool readable, bool writable) {
  if (connection.phase == Phase::kReading && readable) read(connection);
  if (connection.phase == Phase::kWriting && writable) write(connection);
  if (connection.phase == Phase::kLeaving && readable) ignore(connection);
}

void Talk::read(Connection& connection) {
  std::array<char, 4096> block{};
  const auto got = ::recv(connection.socket, block.data(), block.size(), 0);
  if (got < 0 && would_block()) return;
  if (got <= 0) return end(connection);
  connection.in.append(block.data(), static_cast<std::size_t>(got));
  const auto read = read_request(connection.in);
  if (read.request || read.refused != 0) answer(connection, read);
}

/// The handler may take its time: the deadlines of all others wait for it.
void Talk::answer(Connection& connection, const ReadRequest& read) {
  const auto begin = Clock::now();
  const auto response = read.request ? response_to(*read.request) : refusal(read.refused);
  connection.out = bytes_of(response, !read.request || read.request->method != "HEAD");
  connection.phase = Phase::kWriting;
  const auto now = Clock::now();
  for (auto& one : connections_) {
    if (one.until != Clock::time_point::min()) one.until += now - begin;
  }
  connection.until = now + limits_.response;
  connection.in = {};
}

HttpResponse Talk::response_to(const HttpRequest& request) const {
  const bool ours = std::find(hosts_.begin(), hosts_.end(), request.host) != hosts_.end();
  return ours ? handler_(request) : refusal(kMisdirected);
}

void Talk::write(Connection& connection) {
  const auto left = connection.out.size() - connection.sent;
  const auto sent =
      ::send(connection.socket, connection.out.data() + connection.sent, left, MSG_NOSIGNAL);
  if (sent < 0 && would_block()) return;
  if (sent <= 0) return end(connection);
  connection.sent += static_cast<std::size_t>(sent);
  if (connection.sent < connection.out.size()) return;
  connection.out = {};
  // Closed at once with bytes unread, the connection would be reset and the answer lost.
  ::shutdown(connection.socket, SHUT_WR);
  connection.phase = Phase::kLeaving;
  connection.until = Clock::now() + limits_.farewell;
}

void Talk::ignore(Connection& connection) {
  std::array<char, 4096> block{};
  const auto got = ::recv(connection.socket, block.data(), block.size(), 0);
  if (got < 0 && would_block()) return;
  if (got > 0) connection.ignored += static_cast<std::size_t>(got);
  if (got <= 0 || connection.ignored > kMostIgnoredBytes) end(connection);
}

std::string loopback() {
  in_addr address{};
  address.s_addr = htonl(INADDR_LOOPBACK);
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

}  // namespace

HttpResponse refusal(int status) {
  return {status, "text/plain; charset=utf-8", fmt::format("{} {}\n", status, words_of(status))};
}

Result<HttpServer> HttpServer::listen(int port, const HttpLimits& limits) {
  const auto failed = [port](const char* call) {
    return Error{ErrorCode::kIo,
                 fmt::format("flowdlo view: port {} of this computer: {}: {}; take another --port, "
                             "or 0 for any that is free",
                             port, call, std::strerror(errno))};
  };
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) return failed("socket");
  HttpServer server(socket, port, limits);
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof(address);
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket, any, size) != 0) return failed("bind");
  if (::listen(socket, kBacklog) != 0) return failed("listen");
  if (::getsockname(socket, any, &size) != 0) return failed("getsockname");
  server.port_ = ntohs(address.sin_port);
  return server;
}

std::string HttpServer::authority() const { return fmt::format("{}:{}", loopback(), port_); }

Result<void> HttpServer::serve(const Handler& handler, int stop) {
  Talk talk(socket_, limits_, handler, loopback(), port_);
  while (true) {
    const auto more = talk.step(stop);
    if (!more) return more.error();
    if (!*more) return {};
  }
}

HttpServer::HttpServer(HttpServer&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), port_(other.port_), limits_(other.limits_) {}

HttpServer::~HttpServer() {
  if (socket_ >= 0) ::close(socket_);
}

}  // namespace flowdlo::view
