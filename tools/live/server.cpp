// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/server.hpp"

#include <fcntl.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <exception>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/live/address.hpp"

namespace palpate::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using Request = http::request<http::empty_body>;
using Clock = std::chrono::steady_clock;

std::string_view text_of(beast::string_view v) { return {v.data(), v.size()}; }

void check(const error_code& error) {
  if (error) throw std::system_error(error.value(), std::generic_category());
}

/// The page runs its own script, and talks to this server alone.
std::string page_policy(std::uint16_t port) {
  const std::string end = ":" + std::to_string(port);
  return "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src "
         "data:; "
         "connect-src ws://127.0.0.1" +
         end + " ws://localhost" + end +
         "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

}  // namespace

/// All that the server's thread does.
class Server::Core {
 public:
  Core(std::string page, std::uint16_t port, Source& source, const ServerLimits& limits);
  void start();
  void stop();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  std::atomic<std::size_t> pages_open{0};

 private:
  class Connection;
  class Page;
  void accept();
  void next_round();
  void round();
  void say_farewell();

  // Before the context, for what it holds to its end.
  std::size_t connections_ = 0;
  bool ending_ = false;
  bool accepting_ = false;
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  asio::steady_timer timer_{io_};
  std::string page_;
  Source& source_;
  ServerLimits limits_;
  std::string token_ = make_token();
  std::uint16_t port_ = 0;
  std::vector<std::shared_ptr<Page>> pages_;
  std::thread thread_;
};

/// One that is shown frames.
class Server::Core::Page : public std::enable_shared_from_this<Page> {
 public:
  Page(beast::tcp_stream&& stream, Core& core) : ws_(std::move(stream)), core_(core) {}
  ~Page() { --core_.connections_; }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  Page(Page&&) = delete;
  Page& operator=(Page&&) = delete;

  void accept(const Request& request) {
    beast::get_lowest_layer(ws_).expires_never();  // the stream has times of its own
    websocket::stream_base::timeout times{core_.limits_.request, core_.limits_.silent, true};
    ws_.set_option(times);
    ws_.read_message_max(core_.limits_.message_bytes);
    ws_.binary(true);
    ws_.auto_fragment(false);
    ws_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error) return self->drop();
      self->open_ = true;
      self->core_.pages_open = self->core_.pages_.size();
      self->read();
    });
  }

  /// Sends what is new, unless the last frame is still on its way.
  void round(Clock::time_point now) {
    said_ = 0;
    if (writing_ || closing_) {
      if (now - since_ > core_.limits_.stalled) drop();
      return;
    }
    if (!open_) return;
    core_.source_.frame(seen_, frame_);
    writing_ = true;
    since_ = now;
    ws_.async_write(asio::buffer(frame_),
                    [self = shared_from_this()](const error_code& error, std::size_t) {
                      self->writing_ = false;
                      if (error) return self->drop();
                      if (self->core_.ending_) self->finish();
                    });
  }

  /// After the frame that is on its way, the last one; then the connection closes.
  void finish() {
    if (!open_ || writing_) return;
    if (std::exchange(last_sent_, true)) return close(websocket::close_code::going_away);
    round(Clock::now());
  }

  void drop() {
    open_ = false;
    if (std::exchange(has_spoken_, false)) core_.source_.left();
    beast::get_lowest_layer(ws_).close();
    auto& pages = core_.pages_;
    pages.erase(std::remove(pages.begin(), pages.end(), shared_from_this()), pages.end());
    core_.pages_open = pages.size();
    if (core_.ending_ && pages.empty()) core_.io_.stop();
  }

 private:
  void read() {
    ws_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->drop();
      self->take_message();
    });
  }

  void take_message() {
    const auto bytes = buffer_.data();
    const std::span message(static_cast<const std::byte*>(bytes.data()), bytes.size());
    has_spoken_ = true;
    const bool understood = ws_.got_binary() && ++said_ <= core_.limits_.messages_a_frame &&
                            core_.source_.message(message);
    if (!understood) return close(websocket::close_code::policy_error);
    buffer_.clear();
    read();
  }

  void close(websocket::close_code code) {
    if (!std::exchange(open_, false)) return;
    closing_ = true;
    since_ = Clock::now();
    ws_.async_close(code, [self = shared_from_this()](const error_code&) { self->drop(); });
  }

  websocket::stream<beast::tcp_stream, false> ws_;
  Core& core_;
  beast::flat_buffer buffer_;
  std::vector<std::byte> frame_;
  std::uint64_t seen_ = 0;
  std::size_t said_ = 0;  ///< messages since the last round
  bool has_spoken_ = false;
  bool open_ = false, writing_ = false, closing_ = false, last_sent_ = false;
  Clock::time_point since_;  ///< it has been writing or closing
};

/// One request, and its answer.
class Server::Core::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket&& socket, Core& core) : stream_(std::move(socket)), core_(core) {
    parser_.header_limit(static_cast<std::uint32_t>(core.limits_.header_bytes));
  }
  ~Connection() {
    if (!upgraded_) --core_.connections_;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  Connection(Connection&&) = delete;
  Connection& operator=(Connection&&) = delete;

  void start() {
    stream_.expires_after(core_.limits_.request);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       if (!error) self->serve();
                     });
  }

 private:
  void serve() {
    const Request& request = parser_.get();
    const std::string_view target = text_of(request.target());
    const std::size_t slash = target.find('/', 1);
    const std::string_view said = target.substr(0, slash).substr(target.empty() ? 0 : 1);
    const std::string_view place = slash == std::string_view::npos ? "" : target.substr(slash);
    if (!is_own_host(text_of(request[http::field::host]), core_.port_)) {
      return answer(http::status::forbidden, "Not this host's name.\n");
    }
    if (!same_token(said, core_.token_) || (place != "/" && place != "/live")) {
      return answer(http::status::not_found, "Nothing here: use the address that palpate said.\n");
    }
    if (place == "/live") return upgrade();
    if (request.method() != http::verb::get) {
      return answer(http::status::method_not_allowed, "Only GET.\n");
    }
    answer(http::status::ok, core_.page_);
  }

  void upgrade() {
    const Request& request = parser_.get();
    if (!is_own_origin(text_of(request[http::field::origin]), core_.port_)) {
      return answer(http::status::forbidden, "Not from a page of this address.\n");
    }
    if (!websocket::is_upgrade(request)) {
      return answer(http::status::upgrade_required, "A WebSocket.\n");
    }
    if (core_.pages_.size() >= core_.limits_.pages) {
      return answer(http::status::service_unavailable, "Too many pages: close one.\n");
    }
    upgraded_ = true;
    core_.pages_.push_back(std::make_shared<Page>(std::move(stream_), core_));
    core_.pages_.back()->accept(request);
  }

  void answer(http::status status, const std::string& body) {
    answer_ = {status, parser_.get().version()};
    const bool page = status == http::status::ok;
    answer_.set(http::field::content_type,
                page ? "text/html; charset=utf-8" : "text/plain; charset=utf-8");
    answer_.set(http::field::cache_control, "no-store");
    answer_.set("Referrer-Policy", "no-referrer");
    answer_.set("X-Content-Type-Options", "nosniff");
    answer_.set("Cross-Origin-Resource-Policy", "same-origin");
    answer_.set("Content-Security-Policy", page_policy(core_.port_));
    answer_.keep_alive(false);
    answer_.body() = body;
    answer_.prepare_payload();
    http::async_write(stream_, answer_, [self = shared_from_this()](error_code error, std::size_t) {
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
    });
  }

  beast::tcp_stream stream_;
  Core& core_;
  beast::flat_buffer buffer_{16384};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> answer_;
  bool upgraded_ = false;
};

Server::Core::Core(std::string page, std::uint16_t port, Source& source, const ServerLimits& limits)
    : page_(std::move(page)), source_(source), limits_(limits) {
  const tcp::endpoint here(asio::ip::address_v4::loopback(), port);
  error_code error;
  acceptor_.open(here.protocol(), error);
  check(error);
  // A program that this one starts, a browser, must not hold the port.
  ::fcntl(acceptor_.native_handle(), F_SETFD, FD_CLOEXEC);
  acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  check(error);
  acceptor_.bind(here, error);
  check(error);
  acceptor_.listen(static_cast<int>(limits_.connections), error);
  check(error);
  port_ = acceptor_.local_endpoint().port();
}

void Server::Core::start() {
  accept();
  next_round();
  thread_ = std::thread([this] {
    try {
      io_.run();
    } catch (const std::exception&) {  // out of memory: the view ends, the run goes on
      io_.stop();
    }
  });
}

void Server::Core::stop() {
  asio::post(io_, [this] { say_farewell(); });
  thread_.join();
  // What is still open ends with the sockets; each holds a reference to itself.
  for (const auto& page : std::exchange(pages_, {})) page->drop();
  io_.restart();
  io_.poll();
}

void Server::Core::accept() {
  accepting_ = true;
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {  // the process has no descriptors left, for instance
      accepting_ = false;
      return;
    }
    if (connections_ < limits_.connections) {
      ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      socket.set_option(tcp::socket::send_buffer_size(limits_.send_buffer_bytes), ignored);
      ++connections_;
      std::make_shared<Connection>(std::move(socket), *this)->start();
    }
    accept();
  });
}

void Server::Core::next_round() {
  timer_.expires_after(limits_.frame);
  timer_.async_wait([this](const error_code& error) {
    if (error || ending_) return;
    if (!accepting_) accept();
    round();
    next_round();
  });
}

void Server::Core::round() {
  source_.update();
  // A page that is dropped leaves the list.
  const auto pages = pages_;
  const Clock::time_point now = Clock::now();
  for (const auto& page : pages) page->round(now);
}

void Server::Core::say_farewell() {
  ending_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  source_.update();
  if (pages_.empty()) return io_.stop();
  const auto pages = pages_;
  for (const auto& page : pages) page->finish();
  timer_.expires_after(limits_.farewell);
  timer_.async_wait([this](const error_code&) { io_.stop(); });
}

Server::Server(std::string page, std::uint16_t port, Source& source, const ServerLimits& limits)
    : core_(std::make_unique<Core>(std::move(page), port, source, limits)) {
  core_->start();
}

Server::~Server() {
  try {
    core_->stop();
  } catch (const std::exception&) {  // out of memory: nobody is left to be told
  }
}

std::string Server::address() const {
  return "http://127.0.0.1:" + std::to_string(core_->port()) + "/" + core_->token() + "/";
}

std::size_t Server::pages() const noexcept { return core_->pages_open; }

}  // namespace palpate::live
