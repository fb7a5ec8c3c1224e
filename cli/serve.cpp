#include "cli/serve.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <thread>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "raygrain/error.h"

namespace raygrain::cli {

namespace {

constexpr int kWaiting = 16;                  // connections
constexpr size_t kLongestRequest = 16 << 10;  // bytes
constexpr time_t kPatience = 10;              // seconds for a browser that neither asks nor reads

/// Closed at the end of its life.
class Socket {
 public:
  explicit Socket(int handle) : handle_(handle) {}
  ~Socket() {
    if (handle_ >= 0) ::close(handle_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int handle() const { return handle_; }

 private:
  int handle_;
};

[[noreturn]] void fail_to_listen(uint16_t port) {
  throw Error(ErrorCode::kUnreadable, fmt::format("port {}", port), std::strerror(errno),
              "Choose another one with --port, or write a file with --out");
}

uint16_t listen_here(const Socket& socket, uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  const int yes = 1;
  ::setsockopt(socket.handle(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  auto* general = reinterpret_cast<sockaddr*>(&address);  // NOLINT: as the interface wants it
  socklen_t size = sizeof address;
  if (socket.handle() < 0 || ::bind(socket.handle(), general, size) != 0 || ::listen(socket.handle(), kWaiting) != 0 ||
      ::getsockname(socket.handle(), general, &size) != 0)
    fail_to_listen(port);
  return ntohs(address.sin_port);
}

/// The head of a request; what came of it where the browser says no more.
std::string read_request(const Socket& browser) {
  std::string request;
  char buffer[4096];
  while (request.size() < kLongestRequest && request.find("\r\n\r\n") == std::string::npos) {
    const ssize_t count = ::recv(browser.handle(), buffer, sizeof buffer, 0);
    if (count <= 0) break;
    request.append(buffer, static_cast<size_t>(count));
  }
  return request;
}

void send_all(const Socket& browser, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::send(browser.handle(), text.data(), text.size(), MSG_NOSIGNAL);
    if (count <= 0) return;  // it went away: its own affair
    text.remove_prefix(static_cast<size_t>(count));
  }
}

void answer(const Socket& browser, const std::string& page) {
  const timeval patience{kPatience, 0};
  ::setsockopt(browser.handle(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(browser.handle(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  const std::string request = read_request(browser);
  const bool head = request.starts_with("HEAD / ") || request.starts_with("HEAD /?");
  const bool found = head || request.starts_with("GET / ") || request.starts_with("GET /?");
  const std::string_view body = found ? std::string_view(page) : std::string_view("There is only /\n");
  send_all(browser, fmt::format("HTTP/1.1 {}\r\nContent-Type: text/{}; charset=utf-8\r\nContent-Length: {}\r\n"
                                "Cache-Control: no-store\r\nConnection: close\r\n\r\n",
                                found ? "200 OK" : "404 Not Found", found ? "html" : "plain", body.size()));
  if (!head) send_all(browser, body);
}

}  // namespace

void serve_page(const std::string& page, uint16_t port, const std::function<void(const std::string&)>& ready) {
  const Socket listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const uint16_t chosen = listen_here(listener, port);
  ready(fmt::format("http://127.0.0.1:{}/", chosen));
  const auto shared = std::make_shared<const std::string>(page);
  while (true) {
    const auto browser = std::make_shared<const Socket>(::accept4(listener.handle(), nullptr, nullptr, SOCK_CLOEXEC));
    if (browser->handle() >= 0)  // a thread each: browsers open spare connections and say nothing for long
      std::thread([browser, shared] { answer(*browser, *shared); }).detach();
    else if (errno != EINTR && errno != ECONNABORTED)
      fail_to_listen(chosen);
  }
}

}  // namespace raygrain::cli
