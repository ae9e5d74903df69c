// SPDX-License-Identifier: GPL-3.0-or-later
// What the real-time side of a device on USB calls: every lock, wait, libusb call and allocation of
// the thread that receives and sends is counted, while the real libusb works on the other side.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>

#include <atomic>
#include <thread>

#include "../support/emulated_usbfs.hpp"
#include "hal/protocol/host_driver.hpp"
#include "hal/simulator/open_device.hpp"
#include "hal/transport/streamed_device.hpp"
#include "hal/usb/libusb_transport.hpp"
#include "tools/realtime/thread_counters.hpp"

namespace {

thread_local bool t_realtime = false;
std::atomic<std::uint64_t> g_realtime_calls{0};
std::atomic<std::uint64_t> g_other_calls{0};

void count() { ++(t_realtime ? g_realtime_calls : g_other_calls); }

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

// The executable's definitions come before the libraries', for libusb too.
extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const kNext = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  count();
  return kNext(mutex);
}

int libusb_submit_transfer(libusb_transfer* transfer) {
  static auto* const kNext = next<int(libusb_transfer*)>("libusb_submit_transfer");
  count();
  return kNext(transfer);
}

int libusb_handle_events_timeout_completed(libusb_context* context, timeval* timeout,
                                           int* completed) {
  static auto* const kNext =
      next<int(libusb_context*, timeval*, int*)>("libusb_handle_events_timeout_completed");
  count();
  return kNext(context, timeout, completed);
}
}

namespace palpate::hal::usb {
namespace {

constexpr std::uint64_t kMs = 1'000'000;

std::unique_ptr<LibusbTransport> transport_of(test::EmulatedUsbfs& usbfs) {
  libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  Context context = make_context();
  libusb_device_handle* handle = nullptr;
  EXPECT_EQ(libusb_wrap_sys_device(context.get(), usbfs.open(), &handle), 0);
  Handle owned(handle);
  const auto interface = find_interface(Kind::open_protocol, libusb_get_device(handle));
  EXPECT_TRUE(interface);
  return std::make_unique<LibusbTransport>(std::move(context), std::move(owned), *interface);
}

TEST(RealtimeSide, neither_locks_nor_waits_nor_allocates_nor_enters_libusb) {
  simulator::OpenDeviceOptions options;
  options.capabilities.max_life_us = protocol::kMaxCommandLife_us;
  options.capabilities.max_state_age_us = 1'000'000;
  simulator::OpenDevice model(options);
  test::EmulatedUsbfs usbfs(model);
  MonotonicClock clock;
  StreamedDevice device(transport_of(usbfs), std::make_unique<protocol::HostDriver>(), clock, {});
  ASSERT_FALSE(device.open());
  ASSERT_FALSE(device.start());

  std::uint64_t readings = 0, rounds = 0, waits = 0;
  realtime::ThreadCounters spent;
  std::thread realtime_side([&] {
    DeviceState reading;
    DeviceCommand command;
    rusage before{}, after{};
    const std::uint64_t end_ns = clock.now_ns() + 1000 * kMs;
    const realtime::ThreadCounters counted = realtime::thread_counters();
    ::getrusage(RUSAGE_THREAD, &before);
    t_realtime = true;
    for (std::uint64_t now_ns = clock.now_ns(); now_ns < end_ns; now_ns = clock.now_ns()) {
      if (device.receive(reading)) ++readings;
      ++command.sequence;
      command.time_ns = now_ns;
      command.expires_ns = now_ns + 1000 * kMs;
      command.answers = reading.sequence;
      command.state_time_ns = reading.time_ns;
      device.send(command);
      ++rounds;
    }
    t_realtime = false;
    ::getrusage(RUSAGE_THREAD, &after);
    spent = realtime::thread_counters() - counted;
    waits = static_cast<std::uint64_t>(after.ru_nvcsw - before.ru_nvcsw);
  });
  realtime_side.join();
  device.stop();
  EXPECT_GT(readings, 20u);
  EXPECT_GT(rounds, 1000u);
  EXPECT_EQ(g_realtime_calls, 0u);
  EXPECT_GT(g_other_calls, 1000u);  // they are counted where they are made
  EXPECT_EQ(waits, 0u);
  EXPECT_EQ(spent.allocator_calls.value_or(0), 0u);
  RecordProperty("rounds", static_cast<int>(rounds));
  RecordProperty("calls_of_the_other_threads", static_cast<int>(g_other_calls));
}

}  // namespace
}  // namespace palpate::hal::usb
