// HttpServer: pages for programs of this computer, and for no other. One thread, one request a
// connection; sizes, connections and times are bounded, so that no client keeps it from the others.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "flowdlo/result.hpp"
#include "view/http_request.hpp"

namespace flowdlo::view {

struct HttpResponse {
  int status = 200;
  std::string type;  ///< "text/html; charset=utf-8"
  std::string body;
};

/// A sentence as plain text.
[[nodiscard]] HttpResponse refusal(int status);

using Handler = std::function<HttpResponse(const HttpRequest&)>;

struct HttpLimits {
  std::size_t connections = 16;               ///< at a time; further ones wait
  std::chrono::milliseconds request{5000};    ///< from a connection's begin to its whole head
  std::chrono::milliseconds response{30000};  ///< to take all of the answer
  std::chrono::milliseconds farewell{500};    ///< for the client to close after it
};

class HttpServer {
 public:
  /// On the loopback address alone. `port` 0: any that is free. Fails with kIo.
  [[nodiscard]] static Result<HttpServer> listen(int port, const HttpLimits& limits = {});

  [[nodiscard]] int port() const { return port_; }
  /// "ADDRESS:PORT".
  [[nodiscard]] std::string authority() const;

  /// Answers until `stop`, a file descriptor, can be read. A request for another host than this
  /// one is refused (421): a name of somebody else that leads here. Fails with kIo.
  [[nodiscard]] Result<void> serve(const Handler& handler, int stop);

  HttpServer(HttpServer&& other) noexcept;
  HttpServer& operator=(HttpServer&&) = delete;
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer();

 private:
  HttpServer(int socket, int port, const HttpLimits& limits)
      : socket_(socket), port_(port), limits_(limits) {}

  int socket_;
  int port_;
  HttpLimits limits_;
};

}  // namespace flowdlo::view
