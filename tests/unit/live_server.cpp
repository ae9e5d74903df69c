// SPDX-License-Identifier: GPL-3.0-or-later
// The live view's server against pages of every kind.
#include "tools/live/server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <system_error>
#include <thread>

#include "../support/live_client.hpp"

namespace palpate::live {
namespace {

using test::LiveAddress;
using test::LiveClient;

/// Frames of a size, with a number that goes up; takes messages of 8 bytes.
class Numbers final : public Source {
 public:
  void update() override { ++rounds; }
  void frame(std::uint64_t& seen, std::vector<std::byte>& out) const override {
    out.assign(frame_bytes, std::byte{7});
    out[0] = std::byte{static_cast<std::uint8_t>(seen++)};
    out[1] = std::byte{static_cast<std::uint8_t>(ended ? 1 : 0)};
  }
  bool message(std::span<const std::byte> bytes) override {
    ++messages;
    return bytes.size() == 8;
  }
  std::atomic<std::size_t> frame_bytes{100};
  void left() override { ++lefts; }
  std::atomic<int> rounds{0}, messages{0}, lefts{0};
  std::atomic<bool> ended{false};
};

/// Waits for what another thread does.
template <class Condition>
bool comes_true(Condition condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return condition();
}

class LiveServer : public ::testing::Test {
 protected:
  LiveServer() {
    limits_.frame = std::chrono::milliseconds(5);
    limits_.stalled = std::chrono::milliseconds(300);
    limits_.request = std::chrono::milliseconds(500);
    restart();
  }
  void restart() {
    server_.reset();
    server_ = std::make_unique<Server>("<p>the page</p>", 0, source_, limits_);
    address_ = LiveAddress(server_->address());
  }
  std::string get(const std::string& path, const std::string& host) {
    LiveClient client(address_.port);
    client.send("GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
    return client.read_all();
  }
  std::string get(const std::string& path) { return get(path, address_.host()); }
  LiveClient page(int receive_buffer_bytes = 0) {
    LiveClient client(address_.port, receive_buffer_bytes);
    EXPECT_EQ(client.upgrade(address_), 101);
    return client;
  }
  static std::vector<std::byte> bytes(std::size_t count) {
    return std::vector<std::byte>(count, std::byte{1});
  }

  ServerLimits limits_;
  Numbers source_;
  std::unique_ptr<Server> server_;
  LiveAddress address_{"http://127.0.0.1:0/"};
};

TEST_F(LiveServer, gives_the_page_to_whoever_has_the_token) {
  const std::string answer = get(address_.path);
  EXPECT_EQ(answer.rfind("HTTP/1.1 200", 0), 0u) << answer;
  EXPECT_NE(answer.find("<p>the page</p>"), std::string::npos);
  EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(answer.find("Referrer-Policy: no-referrer"), std::string::npos);
}

TEST_F(LiveServer, other_paths_find_nothing) {
  std::string wrong = address_.path;
  wrong[5] = wrong[5] == '0' ? '1' : '0';
  for (const std::string& path : {std::string("/"), std::string("/live"), std::string("//"),
                                  std::string("*"), wrong, wrong + "live", address_.path + "..",
                                  address_.path.substr(0, 33), address_.path + "live/"}) {
    const std::string answer = get(path);
    EXPECT_EQ(answer.rfind("HTTP/1.1 404", 0), 0u) << path << ": " << answer;
    EXPECT_EQ(answer.find("the page"), std::string::npos);
  }
}

TEST_F(LiveServer, other_names_of_this_host_are_refused) {
  for (const char* host : {"example.org", "127.0.0.1", "example.org:80", ""}) {
    EXPECT_EQ(get(address_.path, host).rfind("HTTP/1.1 403", 0), 0u) << host;
  }
  EXPECT_EQ(
      get(address_.path, "localhost:" + std::to_string(address_.port)).rfind("HTTP/1.1 200", 0),
      0u);
}

TEST_F(LiveServer, pages_of_other_origins_are_refused) {
  for (const char* origin : {"", "null", "https://example.org", "http://127.0.0.1:1", "file://"}) {
    LiveClient client(address_.port);
    EXPECT_EQ(client.upgrade(address_, origin), 403) << origin;
  }
  EXPECT_EQ(server_->pages(), 0u);
}

TEST_F(LiveServer, page_is_shown_frames_in_order) {
  LiveClient client = page();
  for (std::uint8_t i = 0; i < 20; ++i) {
    const auto frame = client.message();
    ASSERT_TRUE(frame);
    EXPECT_EQ((*frame)[0], std::byte{i});
  }
  EXPECT_TRUE(comes_true([&] { return server_->pages() == 1; }));
}

TEST_F(LiveServer, port_that_is_taken_is_an_error) {
  EXPECT_THROW(Server("", address_.port, source_, limits_), std::system_error);
}

TEST_F(LiveServer, what_a_page_says_arrives) {
  LiveClient client = page();
  for (int i = 0; i < 3; ++i) client.send(LiveClient::masked(2, bytes(8)));
  EXPECT_TRUE(comes_true([&] { return source_.messages == 3; }));
  EXPECT_TRUE(client.message());
}

TEST_F(LiveServer, page_that_had_spoken_and_is_gone_is_told_of_once) {
  {
    const LiveClient silent = page();
    const LiveClient client = page();
    client.send(LiveClient::masked(2, bytes(8)));
    ASSERT_TRUE(comes_true([&] { return source_.messages == 1; }));
  }
  EXPECT_TRUE(comes_true([&] { return server_->pages() == 0; }));
  EXPECT_EQ(source_.lefts, 1);
}

TEST_F(LiveServer, messages_that_are_not_understood_disconnect) {
  const auto too_long = LiveClient::masked(2, bytes(limits_.message_bytes + 1));
  std::string unmasked = LiveClient::masked(2, bytes(8));
  unmasked[1] = 8;
  std::string endless = LiveClient::masked(2, bytes(8));
  endless[1] = char(0xff);  // a length of 64 bits follows
  for (const std::string& said : {LiveClient::masked(2, bytes(7)), LiveClient::masked(1, bytes(8)),
                                  too_long, unmasked, endless + std::string(20, '\x7f'),
                                  std::string(20, '\xff'), std::string("GET / HTTP/1.1\r\n\r\n")}) {
    LiveClient client = page();
    client.send(said);
    EXPECT_TRUE(client.closes());
  }
  EXPECT_TRUE(comes_true([&] { return server_->pages() == 0; }));
  EXPECT_TRUE(page().message());  // others are served as before
}

TEST_F(LiveServer, page_that_says_too_much_is_disconnected) {
  limits_.frame = std::chrono::milliseconds(200);
  restart();
  LiveClient client = page();
  std::string all;
  for (std::size_t i = 0; i < 3 * limits_.messages_a_frame; ++i) {
    all += LiveClient::masked(2, bytes(8));
  }
  client.send(all);
  EXPECT_TRUE(client.closes());
}

TEST_F(LiveServer, page_that_stops_reading_is_dropped_and_others_go_on) {
  source_.frame_bytes = 100'000;
  LiveClient reader = page();
  LiveClient stopped = page(4096);
  ASSERT_TRUE(comes_true([&] { return server_->pages() == 2; }));
  for (int i = 0; i < 1000 && server_->pages() == 2; ++i) ASSERT_TRUE(reader.message());
  EXPECT_EQ(server_->pages(), 1u);
  EXPECT_TRUE(reader.message());
  EXPECT_TRUE(stopped.closes());
}

TEST_F(LiveServer, page_that_does_not_answer_pings_is_dropped) {
  limits_.silent = std::chrono::milliseconds(300);
  restart();
  LiveClient client = page();
  EXPECT_TRUE(client.closes());
}

TEST_F(LiveServer, one_page_too_many_is_told_so) {
  std::vector<LiveClient> pages;
  for (std::size_t i = 0; i < limits_.pages; ++i) pages.push_back(page());
  LiveClient another(address_.port);
  EXPECT_EQ(another.upgrade(address_), 503);
  pages.pop_back();
  EXPECT_TRUE(comes_true([&] {
    LiveClient again(address_.port);
    return again.upgrade(address_) == 101;
  }));
}

TEST_F(LiveServer, connections_that_say_nothing_make_room_again) {
  std::vector<std::unique_ptr<LiveClient>> silent;
  for (std::size_t i = 0; i < limits_.connections; ++i) {
    silent.push_back(std::make_unique<LiveClient>(address_.port));
  }
  EXPECT_TRUE(comes_true([&] { return get(address_.path).rfind("HTTP/1.1 200", 0) == 0; }));
  for (const auto& client : silent) EXPECT_TRUE(client->closes());
}

TEST_F(LiveServer, unsound_requests_are_closed) {
  for (const std::string& request :
       {std::string("nonsense\r\n\r\n"), "GET / HTTP/1.1\r\nX: " + std::string(20000, 'a'),
        std::string(20000, 'a'), std::string(100, '\0'),
        "POST " + address_.path + " HTTP/1.1\r\nHost: " + address_.host() +
            "\r\nContent-Length: 5\r\n\r\n12345"}) {
    LiveClient client(address_.port);
    client.send(request);
    EXPECT_TRUE(client.closes()) << request.substr(0, 40);
  }
  EXPECT_EQ(get(address_.path).rfind("HTTP/1.1 200", 0), 0u);
}

TEST_F(LiveServer, only_get_is_answered_and_live_is_a_websocket) {
  LiveClient client(address_.port);
  client.send("DELETE " + address_.path + " HTTP/1.1\r\nHost: " + address_.host() + "\r\n\r\n");
  EXPECT_EQ(client.read_all().rfind("HTTP/1.1 405", 0), 0u);
  EXPECT_EQ(get(address_.path + "live").rfind("HTTP/1.1 403", 0), 0u);  // no origin
}

TEST_F(LiveServer, end_sends_a_last_frame_and_closes) {
  LiveClient client = page();
  ASSERT_TRUE(client.message());
  source_.ended = true;
  server_.reset();
  bool last = false;
  while (const auto frame = client.message()) last = (*frame)[1] == std::byte{1};
  EXPECT_TRUE(last);
}

TEST_F(LiveServer, end_does_not_wait_for_a_page_that_does_not_read) {
  source_.frame_bytes = 1'000'000;
  limits_.stalled = std::chrono::seconds(60);
  restart();
  const LiveClient stopped = page(4096);
  ASSERT_TRUE(comes_true([&] { return source_.rounds > 20; }));
  server_.reset();  // the test would not end
}

}  // namespace
}  // namespace palpate::live
