// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/realtime_thread.hpp"

#include <sched.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "tools/realtime/latency_request.hpp"

namespace palpate::realtime {
namespace {

/// Generous: the thread sanitizer keeps close to a megabyte of its own there.
constexpr std::size_t kStackBytes = std::size_t(1) << 21;
/// More than the loop and the contact engine use together, less than the stack.
constexpr std::size_t kTouchedStackBytes = std::size_t(1) << 18;

std::string reason(int error) { return std::generic_category().message(error); }

/// Maps the stack's pages before the loop needs them.
[[gnu::noinline]] void touch_stack() {
  constexpr std::size_t kPage = 4096;
  std::array<volatile char, kTouchedStackBytes> bytes;
  for (std::size_t i = 0; i < bytes.size(); i += kPage) bytes[i] = 0;
}

void pin_to(int cpu, HostGrant& grant) {
  if (cpu < 0) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  if (error != 0) {
    grant.notes.push_back("not kept on processor " + std::to_string(cpu) + " (" + reason(error) +
                          "): name one that is online");
  }
}

void schedule_fifo(int priority, HostGrant& grant) {
  if (priority == 0) return;
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  if (error == 0) {
    grant.scheduler = "SCHED_FIFO " + std::to_string(priority);
  } else {
    grant.notes.push_back("no real-time scheduling (" + reason(error) +
                          "): raise the rtprio limit, see `palpate doctor`");
  }
}

void schedule_ordinary() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
}

}  // namespace

RealtimeThread::RealtimeThread(const RealtimeOptions& options, std::function<void()> body)
    : options_(options), body_(std::move(body)) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  const int error = pthread_create(&thread_, &attributes, entry, this);
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start a thread");
}

RealtimeThread::~RealtimeThread() {
  if (!joined_) pthread_join(thread_, nullptr);
}

HostGrant RealtimeThread::join() {
  pthread_join(thread_, nullptr);
  joined_ = true;
  return grant_;
}

void* RealtimeThread::entry(void* self) {
  auto& thread = *static_cast<RealtimeThread*>(self);
  thread.prepare_and_run();
  thread.finished_.store(true, std::memory_order_release);
  return nullptr;
}

void RealtimeThread::prepare_and_run() {
  touch_stack();
  const LatencyRequest no_sleep_states;
  if (!no_sleep_states.granted()) {
    grant_.notes.emplace_back(
        "processor sleep states not bounded: give this user write access to /dev/cpu_dma_latency");
  }
  pin_to(options_.cpu, grant_);
  memory_.emplace();
  grant_.memory_locked = memory_->locked();
  if (!memory_->problem().empty()) grant_.notes.push_back(memory_->problem());
  // Last: what came before may take long, and nobody else could run meanwhile.
  schedule_fifo(options_.fifo_priority, grant_);
  body_();
  // First: the device's thread may share the processor, and has the last command to send.
  schedule_ordinary();
}

}  // namespace palpate::realtime
