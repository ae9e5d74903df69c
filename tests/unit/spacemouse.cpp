// SPDX-License-Identifier: GPL-3.0-or-later
// A mouse of six axes as the hand: a puck of a script, and a daemon that is a socket of this test.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "../support/cube_scene.hpp"
#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"
#include "tools/spacemouse/leader.hpp"

namespace palpate::spacemouse {
namespace {

using std::chrono::milliseconds;

constexpr Pace kPace{0.1, 2};

TEST(LeadOf, axes_are_the_users_and_small_deflections_are_rest) {
  const hal::mock::Lead lead = lead_of(Heard::deflection, {{350, 0, -350}, {0, 350, 0}}, kPace);
  EXPECT_TRUE(lead.held && lead.paced);
  EXPECT_EQ(lead.pace.linear_m_per_s, (Vec3d{0.1, 0, -0.1}));
  EXPECT_EQ(lead.pace.angular_rad_per_s, (Vec3d{0, 2, 0}));
  EXPECT_EQ(lead_of(Heard::deflection, {{10, -15, 0}, {}}, kPace).pace.linear_m_per_s, Vec3d{});
  const double half = lead_of(Heard::deflection, {{180, 0, 0}, {}}, kPace).pace.linear_m_per_s.x;
  EXPECT_GT(half, 0.1 * 0.2);
  EXPECT_LT(half, 0.1 * 0.3);
}

TEST(LeadOf, no_number_leads_faster_than_all_the_way) {
  const int most = std::numeric_limits<int>::max(), least = std::numeric_limits<int>::min();
  const auto lead = lead_of(Heard::deflection, {{most, least, 0}, {least, most, 0}}, kPace);
  EXPECT_EQ(lead.pace.linear_m_per_s, (Vec3d{0.1, -0.1, 0}));
  EXPECT_EQ(lead.pace.angular_rad_per_s, (Vec3d{-2, 2, 0}));
}

TEST(LeadOf, button_and_what_is_gone_let_go) {
  EXPECT_FALSE(lead_of(Heard::button, {{350, 0, 0}, {}}, kPace).held);
  EXPECT_FALSE(lead_of(Heard::gone, {}, kPace).held);
}

class ScriptedPuck final : public Puck {
 public:
  explicit ScriptedPuck(std::deque<std::pair<Heard, Deflection>> script)
      : script_(std::move(script)) {}
  Heard next(Deflection& out, milliseconds most) override {
    if (script_.empty()) {
      std::this_thread::sleep_for(most);
      return Heard::nothing;
    }
    const auto [heard, deflection] = script_.front();
    script_.pop_front();
    if (heard == Heard::deflection) out = deflection;
    return heard;
  }

 private:
  std::deque<std::pair<Heard, Deflection>> script_;
};

TEST(Leader, leads_until_the_puck_is_gone_and_then_lets_go) {
  std::mutex mutex;
  std::vector<hal::mock::Lead> leads;
  std::atomic<bool> gone{false};
  {
    const Leader leader(
        std::make_unique<ScriptedPuck>(std::deque<std::pair<Heard, Deflection>>{
            {Heard::nothing, {}}, {Heard::deflection, {{350, 0, 0}, {}}}, {Heard::gone, {}}}),
        kPace,
        [&](const hal::mock::Lead& lead) {
          const std::lock_guard lock(mutex);
          leads.push_back(lead);
        },
        [&] { gone = true; });
    for (int i = 0; i < 500 && !gone; ++i) std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_TRUE(gone);
  ASSERT_EQ(leads.size(), 2u);
  EXPECT_EQ(leads[0].pace.linear_m_per_s.x, 0.1);
  EXPECT_FALSE(leads[1].held);
}

/// spacenavd's side of its socket, as old ones speak it: events of eight numbers, no answers.
class Daemon {
 public:
  explicit Daemon(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    path.copy(name.sun_path, sizeof name.sun_path - 1);
    auto* const address = static_cast<sockaddr*>(static_cast<void*>(&name));
    EXPECT_EQ(::bind(socket_, address, sizeof name), 0);
    EXPECT_EQ(::listen(socket_, 1), 0);
  }
  ~Daemon() {
    hang_up();
    ::close(socket_);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  Daemon(Daemon&&) = delete;
  Daemon& operator=(Daemon&&) = delete;

  void accept() { client_ = ::accept(socket_, nullptr, nullptr); }
  /// Who waits in accept() waits no longer.
  void refuse() const { ::shutdown(socket_, SHUT_RDWR); }
  void hang_up() {
    if (client_ >= 0) ::close(std::exchange(client_, -1));
  }
  /// @return whether somebody listens
  bool say(const std::array<std::int32_t, 8>& event) const {
    return ::send(client_, event.data(), sizeof event, MSG_NOSIGNAL) == sizeof event;
  }

 private:
  int socket_;
  int client_ = -1;
};

class SpaceMouse : public ::testing::Test {
 protected:
  SpaceMouse() { ::setenv("SPNAV_SOCKET", socket_.c_str(), 1); }
  ~SpaceMouse() override { ::unsetenv("SPNAV_SOCKET"); }

  std::vector<std::string> command() {
    folder_.write("cube.palp", test::cube_image());
    const auto scene = folder_.write("scene.toml", test::cube_loop_scene());
    return {PALPATE_EXECUTABLE, "run", scene, "--device", "spacemouse", "--seconds", "2", "--json"};
  }

  test::TemporaryFolder folder_;
  std::string socket_ = folder_.path() / "spnav.sock";
};

TEST_F(SpaceMouse, run_without_a_daemon_or_a_library_says_what_to_install) {
  const test::Outcome outcome = test::run(command());
  EXPECT_EQ(outcome.status, 4) << outcome.err;
#ifdef PALPATE_SPNAV
  EXPECT_NE(outcome.err.find("spacenavd"), std::string::npos) << outcome.err;
#else
  EXPECT_NE(outcome.err.find("libspnav-dev"), std::string::npos) << outcome.err;
#endif
}

#ifdef PALPATE_SPNAV
TEST_F(SpaceMouse, what_the_daemon_says_is_heard_and_its_end_too) {
  Daemon daemon(socket_);
  std::thread accepting([&] { daemon.accept(); });
  auto opened = open_puck();
  accepting.join();
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<Puck>>(opened));
  auto& puck = *std::get<std::unique_ptr<Puck>>(opened);
  Deflection deflection;
  EXPECT_EQ(puck.next(deflection, milliseconds(1)), Heard::nothing);
  daemon.say({0, 1, 2, 3, 4, 5, 6, 16});  // right, up, away
  EXPECT_EQ(puck.next(deflection, milliseconds(1000)), Heard::deflection);
  EXPECT_EQ(deflection.push, (std::array<int, 3>{1, 3, 2}));
  EXPECT_EQ(deflection.turn, (std::array<int, 3>{4, 6, 5}));
  daemon.say({1, 0, 0, 0, 0, 0, 0, 0});  // a button goes down
  EXPECT_EQ(puck.next(deflection, milliseconds(1000)), Heard::button);
  daemon.say({2, 0, 0, 0, 0, 0, 0, 0});  // and up
  EXPECT_EQ(puck.next(deflection, milliseconds(1000)), Heard::nothing);
  daemon.say({99, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(puck.next(deflection, milliseconds(1000)), Heard::nothing);
  daemon.hang_up();
  EXPECT_EQ(puck.next(deflection, milliseconds(1000)), Heard::gone);
}

TEST_F(SpaceMouse, pushes_the_tool_against_the_other_within_the_limits) {
  Daemon daemon(socket_);
  std::thread pushing([&] {
    daemon.accept();
    while (daemon.say({0, -350, 0, 0, 0, 0, 0, 16})) {
      std::this_thread::sleep_for(milliseconds(16));
    }
  });
  const test::Outcome outcome = test::run(command());
  daemon.refuse();
  pushing.join();
  ASSERT_TRUE(outcome.status == 0 || outcome.status == 5) << outcome.err;
  const auto j = nlohmann::json::parse(outcome.out);
  if (!j["faults"].empty()) GTEST_SKIP() << "the machine is too busy to hold the loop up";
  EXPECT_GT(j["force_N"]["max"].get<double>(), 0.02);
  EXPECT_LE(j["force_N"]["max"].get<double>(), 0.5 * (1 + 1e-9));
#ifndef PALPATE_SANITIZED
  EXPECT_EQ(j["allocations"], 0);
#endif
}
#endif

}  // namespace
}  // namespace palpate::spacemouse
