// SPDX-License-Identifier: Apache-2.0
// One client of an exported device: bytes in, bytes out. Knows no socket and no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "hal/simulator/simulated_device.hpp"
#include "hal/usbip/messages.hpp"

namespace palpate::hal::usbip {

/// A device that clients may take, one at a time, while it is on its bus.
struct ExportedDevice {
  simulator::SimulatedDevice& device;
  bool taken = false;
  [[nodiscard]] bool to_be_had() const { return !taken && device.presence().on_bus; }
};

class Session {
 public:
  static constexpr std::size_t kMaxTransferBytes = 64 * 1024;
  static constexpr std::size_t kMaxPending = 256;  ///< IN transfers that wait for data

  explicit Session(ExportedDevice& exported) noexcept : exported_(exported) {}
  /// For a device that this client has taken, as if the plug were pulled.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(Session&&) = delete;

  /// Bytes of the client, cut anywhere. False where they break the protocol or ask for more than
  /// the limits above: the connection is to be closed. The device must have lived up to now.
  [[nodiscard]] bool receive(std::span<const std::byte> bytes);

  /// This client takes the device now, whatever it has said.
  void take();

  /// Answers waiting IN transfers with what the device has ready.
  void serve();

  /// What is to be sent; whoever sends takes it away from the front.
  [[nodiscard]] std::vector<std::byte>& output() noexcept { return output_; }

  /// The client has taken the device.
  [[nodiscard]] bool attached() const noexcept { return attached_; }

 private:
  struct Waiting {
    std::uint32_t sequence = 0;
    std::size_t room = 0;
  };
  /// Takes one message off the front: the bytes that it has, 0 while it is not whole. Sets broken_.
  std::size_t take_operation(std::span<const std::byte> bytes);
  std::size_t take_transfer(std::span<const std::byte> bytes);
  void list();
  void import(std::span<const std::byte> bus_id);
  void submit(const TransferHeader& header, std::span<const std::byte> data);
  void control(const TransferHeader& header, std::span<const std::byte> data);
  void unlink(const TransferHeader& header);
  void reply(std::uint32_t sequence, std::int32_t status, std::size_t moved,
             std::span<const std::byte> data);
  void say(std::span<const std::byte> bytes);

  ExportedDevice& exported_;
  bool attached_ = false;
  bool broken_ = false;
  std::vector<std::byte> input_;  ///< no whole message yet
  std::vector<std::byte> output_;
  std::deque<Waiting> waiting_;
};

}  // namespace palpate::hal::usbip
