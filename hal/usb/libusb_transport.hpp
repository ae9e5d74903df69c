// SPDX-License-Identifier: Apache-2.0
// A transport on libusb. All calls on one thread at a time: it owns the context and handles its
// events itself.
//
// While streaming, kInTransfers IN transfers are pending at all times, so that the host controller
// fills the next one without waiting for this process; OUT transfers come from a fixed pool; no
// transfer has a timeout, so that libusb arms no timer. libusb allocates at each submission: here,
// never on the real-time thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/transport/transport.hpp"
#include "hal/usb/interfaces.hpp"
#include "hal/usb/usb_session.hpp"

namespace palpate::hal::usb {

class LibusbTransport final : public Transport {
 public:
  static constexpr std::size_t kInTransfers = 4;
  static constexpr std::size_t kOutTransfers = 4;
  static constexpr std::size_t kMaxInBytes = 512;
  static constexpr std::size_t kMaxOutBytes = 64;
  /// Failed transfers in a row after which the device counts as lost: unplugging shows as errors on
  /// some host controllers.
  static constexpr int kErrorsToLost = 16;

  /// Takes over an open device whose interface is claimed.
  LibusbTransport(Context context, Handle handle, const Interface& interface);
  ~LibusbTransport() override;

  [[nodiscard]] std::uint8_t interface_number() const noexcept override {
    return interface_.number;
  }
  IoResult control_in(const ControlRequest& request, std::span<std::byte> out,
                      std::uint32_t timeout_ms) override;
  IoResult control_out(const ControlRequest& request, std::span<const std::byte> data,
                       std::uint32_t timeout_ms) override;
  IoStatus select_alternate(std::uint8_t setting) override;
  IoResult read(std::span<std::byte> out, std::uint32_t timeout_ms) override;
  IoResult write(std::span<const std::byte> data, std::uint32_t timeout_ms) override;
  IoStatus begin_stream() override;
  bool submit(std::span<const std::byte> data) override;
  [[nodiscard]] std::size_t pending() const noexcept override;
  IoStatus wait(std::uint64_t until_ns, StreamSink& sink) override;
  void end_stream() noexcept override;

 private:
  struct TransferDeleter {
    void operator()(libusb_transfer* transfer) const noexcept { libusb_free_transfer(transfer); }
  };
  /// A transfer with its buffer; libusb points into it while it is under way.
  struct Slot {
    LibusbTransport* owner = nullptr;
    std::unique_ptr<libusb_transfer, TransferDeleter> transfer;
    bool under_way = false;
    bool halted = false;  ///< stalled; to be cleared outside of the callback
    std::array<unsigned char, kMaxInBytes> bytes{};
  };

  static void on_in(libusb_transfer* transfer) noexcept;
  static void on_out(libusb_transfer* transfer) noexcept;
  /// Counts what a completed transfer says; true where it worked.
  bool note(libusb_transfer_status status) noexcept;
  void submit_in(Slot& slot) noexcept;
  void clear_halts() noexcept;
  void handle_events(std::uint64_t for_ns) noexcept;
  [[nodiscard]] bool any_under_way() const noexcept;
  IoResult transfer_now(std::uint8_t address, std::uint8_t type, unsigned char* bytes,
                        std::size_t length, std::uint32_t timeout_ms);

  Context context_;
  Handle handle_;
  Interface interface_;
  std::vector<std::unique_ptr<Slot>> in_;
  std::vector<std::unique_ptr<Slot>> out_;
  StreamSink* sink_ = nullptr;  ///< during wait() only
  bool streaming_ = false;
  bool lost_ = false;
  bool delivered_ = false;  ///< since wait() began
  int completed_ = 0;       ///< what libusb looks at before it sleeps
  int errors_in_a_row_ = 0;
};

}  // namespace palpate::hal::usb
