// SPDX-License-Identifier: Apache-2.0
#include "hal/usbip/client.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <string_view>
#include <utility>

#include "hal/protocol/packets.hpp"

namespace palpate::hal::usbip {
namespace {

constexpr std::uint64_t kNsPerSecond = 1'000'000'000;
constexpr long kPatience_s = 2;  // in the middle of a message
constexpr int kConnectWithin_ms = 3000;
constexpr std::uint32_t kSetupWithin_ms = 2000;
constexpr std::uint64_t kEndWithin_ns = kNsPerSecond;
constexpr std::uint32_t kMostDevices = 256;
constexpr std::size_t kDescriptorsBytes = 1024;

/// A socket with an owner; -1: none.
class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket(Socket&&) = delete;
  Socket& operator=(Socket&&) = delete;
  [[nodiscard]] int fd() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

bool send_whole(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

bool receive_whole(int fd, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t got = ::recv(fd, bytes.data(), bytes.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

void set_patience(int fd) {
  const timeval patience{kPatience_s, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  const int at_once = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
}

bool connect_within(int fd, const addrinfo& to) {
  // A send timeout bounds connect() too.
  const timeval patience{kConnectWithin_ms / 1000, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  return ::connect(fd, to.ai_addr, to.ai_addrlen) == 0;
}

/// -1 where nobody answers.
int connect_to(const std::string& host, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) return -1;
  int fd = -1;
  for (const addrinfo* to = found; to != nullptr && fd < 0; to = to->ai_next) {
    Socket socket(::socket(to->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (socket.fd() >= 0 && connect_within(socket.fd(), *to)) fd = socket.release();
  }
  ::freeaddrinfo(found);
  if (fd >= 0) set_patience(fd);
  return fd;
}

std::uint32_t big_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (const std::byte b : bytes.first(4)) value = value << 8 | std::to_integer<std::uint32_t>(b);
  return value;
}

bool is_open_protocol(std::span<const std::byte> class_and_more) {
  return std::to_integer<std::uint8_t>(class_and_more[0]) == protocol::kInterfaceClass &&
         std::to_integer<std::uint8_t>(class_and_more[1]) == protocol::kInterfaceSubclass &&
         std::to_integer<std::uint8_t>(class_and_more[2]) == protocol::kInterfaceProtocol;
}

// In the record of a device.
constexpr std::size_t kBusIdAt = 256;
constexpr std::size_t kBusNumberAt = kBusIdAt + kBusIdBytes;

/// The bus id of the first device of the open protocol; empty: none.
std::optional<std::string> find_bus_id(int fd) {
  std::array<std::byte, kOperationBytes + 4> head{};
  if (!send_whole(fd, encode(Operation{})) || !receive_whole(fd, head)) return std::nullopt;
  const Operation reply = decode_operation(std::span(head).first<kOperationBytes>());
  const std::uint32_t devices = big_endian(std::span(head).subspan(kOperationBytes));
  if (reply.code != Code::list_reply || reply.status != 0 || devices > kMostDevices) {
    return std::nullopt;
  }
  std::string bus_id;
  for (std::uint32_t i = 0; i < devices; ++i) {
    std::array<std::byte, kDeviceBytes> device{};
    if (!receive_whole(fd, device)) return std::nullopt;
    bool is_wanted = false;
    const auto interfaces = std::to_integer<std::size_t>(device.back());
    for (std::size_t k = 0; k < interfaces; ++k) {
      std::array<std::byte, kInterfaceBytes> interface {};
      if (!receive_whole(fd, interface)) return std::nullopt;
      is_wanted = is_wanted || is_open_protocol(interface);
    }
    if (!is_wanted || !bus_id.empty()) continue;
    for (const std::byte b : std::span(device).subspan(kBusIdAt, kBusIdBytes)) {
      if (b == std::byte{0}) break;
      bus_id += static_cast<char>(b);
    }
  }
  return bus_id;
}

// Of USB's descriptors.
constexpr std::uint8_t kInterfaceDescriptor = 4, kEndpointDescriptor = 5;
constexpr std::size_t kInterfaceDescriptorBytes = 9, kEndpointDescriptorBytes = 7;

/// The first interface of the open protocol with an endpoint of each direction.
std::optional<ClientInterface> find_interface(std::span<const std::byte> descriptors) {
  std::optional<ClientInterface> found;
  bool has_in = false, has_out = false;
  const auto number = [](std::byte b) { return std::to_integer<std::uint8_t>(b); };
  for (std::size_t at = 0; at + 2 <= descriptors.size();) {
    const std::size_t length = number(descriptors[at]);
    if (length < 2 || length > descriptors.size() - at) break;
    const auto one = descriptors.subspan(at, length);
    at += length;
    if (number(one[1]) == kInterfaceDescriptor && length >= kInterfaceDescriptorBytes) {
      if (found && has_in && has_out) return found;
      found.reset();
      has_in = has_out = false;
      const bool is_first_setting = number(one[3]) == 0;
      if (is_first_setting && is_open_protocol(one.subspan(5, 3))) found = ClientInterface{};
      if (found) found->number = number(one[2]);
    }
    if (number(one[1]) == kEndpointDescriptor && length >= kEndpointDescriptorBytes && found) {
      const std::uint8_t address = number(one[2]);
      const bool is_in = (address & 0x80u) != 0;
      bool& has = is_in ? has_in : has_out;
      if (!has) (is_in ? found->in_endpoint : found->out_endpoint) = address & 0x0fu;
      has = true;
    }
  }
  return found && has_in && has_out ? found : std::nullopt;
}

/// As a kernel sets up a device that has been plugged in.
std::optional<ClientInterface> set_up(ClientTransport& transport) {
  constexpr ControlRequest kGetConfiguration{0x80, 6, 0x0200, 0};
  std::array<std::byte, kDescriptorsBytes> descriptors{};
  const IoResult got = transport.control_in(kGetConfiguration, descriptors, kSetupWithin_ms);
  if (!got.ok() || got.bytes < 9) return std::nullopt;
  const auto interface = find_interface(std::span(descriptors).first(got.bytes));
  const ControlRequest set_configuration{0, 9, std::to_integer<std::uint16_t>(descriptors[5]), 0};
  if (!interface || !transport.control_out(set_configuration, {}, kSetupWithin_ms).ok()) {
    return std::nullopt;
  }
  return interface;
}

}  // namespace

ClientTransport::ClientTransport(int fd, const ClientInterface& interface)
    : fd_(fd), interface_(interface) {
  set_patience(fd);
}

ClientTransport::~ClientTransport() { ::close(fd_); }

bool ClientTransport::import(std::string_view bus_id) {
  std::array<std::byte, kOperationBytes + kBusIdBytes> request{};
  const auto head = encode(Operation{kVersion, Code::import_request, 0});
  std::copy(head.begin(), head.end(), request.begin());
  if (bus_id.size() >= kBusIdBytes) return false;
  std::transform(bus_id.begin(), bus_id.end(), request.begin() + kOperationBytes,
                 [](char c) { return static_cast<std::byte>(c); });
  std::array<std::byte, kOperationBytes> reply{};
  if (!send_all(request) || !receive_all(reply)) return false;
  const Operation said = decode_operation(reply);
  if (said.code != Code::import_reply || said.status != 0) return false;
  std::array<std::byte, kDeviceBytes> device{};
  if (!receive_all(device)) return false;
  const auto numbers = std::span<const std::byte>(device).subspan(kBusNumberAt, 8);
  device_ = big_endian(numbers) << 16 | (big_endian(numbers.subspan(4)) & 0xffffu);
  return true;
}

IoResult ClientTransport::control_in(const ControlRequest& request, std::span<std::byte> out,
                                     std::uint32_t timeout_ms) {
  TransferHeader header;
  header.is_in = true;
  header.length = static_cast<std::uint32_t>(out.size());
  header.setup = encode_setup({request, static_cast<std::uint16_t>(out.size())});
  return finish(send(Use::alone, header, {}), out, timeout_ms);
}

IoResult ClientTransport::control_out(const ControlRequest& request,
                                      std::span<const std::byte> data, std::uint32_t timeout_ms) {
  TransferHeader header;
  header.length = static_cast<std::uint32_t>(data.size());
  header.setup = encode_setup({request, static_cast<std::uint16_t>(data.size())});
  return finish(send(Use::alone, header, data), {}, timeout_ms);
}

IoStatus ClientTransport::select_alternate(std::uint8_t setting) {
  return control_out({0x01, 0x0b, setting, interface_.number}, {}, kSetupWithin_ms).status;
}

IoResult ClientTransport::read(std::span<std::byte> out, std::uint32_t timeout_ms) {
  TransferHeader header;
  header.is_in = true;
  header.endpoint = interface_.in_endpoint;
  header.length = static_cast<std::uint32_t>(out.size());
  return finish(send(Use::alone, header, {}), out, timeout_ms);
}

IoResult ClientTransport::write(std::span<const std::byte> data, std::uint32_t timeout_ms) {
  TransferHeader header;
  header.endpoint = interface_.out_endpoint;
  header.length = static_cast<std::uint32_t>(data.size());
  return finish(send(Use::alone, header, data), {}, timeout_ms);
}

void ClientTransport::stream_in() {
  TransferHeader header;
  header.is_in = true;
  header.endpoint = interface_.in_endpoint;
  header.length = kInBytes;
  if (send(Use::stream_in, header, {}) == 0) lost_ = true;
}

IoStatus ClientTransport::begin_stream() {
  for (std::size_t i = 0; i < kInTransfers && !lost_; ++i) stream_in();
  return lost_ ? IoStatus::lost : IoStatus::ok;
}

bool ClientTransport::submit(std::span<const std::byte> data) {
  if (lost_ || pending() == kOutTransfers) return false;
  TransferHeader header;
  header.endpoint = interface_.out_endpoint;
  header.length = static_cast<std::uint32_t>(data.size());
  return send(Use::stream_out, header, data) != 0;
}

std::size_t ClientTransport::pending() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(requests_.begin(), requests_.end(),
                    [](const Request& r) { return r.use == Use::stream_out && !r.unwanted; }));
}

IoStatus ClientTransport::wait(std::uint64_t until_ns, StreamSink& sink) {
  while (!lost_) {
    const auto end = next_end(until_ns);
    if (!end) break;
    if (end->request.use != Use::stream_in || end->request.unwanted) continue;
    const bool arrived = end->status == kDone;
    if (arrived) sink.received(std::span(data_).first(end->bytes), clock_.now_ns());
    stream_in();
    if (arrived) break;
  }
  return lost_ ? IoStatus::lost : IoStatus::ok;
}

void ClientTransport::end_stream() noexcept {
  const auto is_open = [](const Request& r) { return r.use != Use::none && !r.unwanted; };
  for (const Request request : std::array<Request, kRequests>(requests_)) {
    if (is_open(request) && request.use != Use::unlink && !lost_) unlink(request);
  }
  const auto is_left = [](const Request& r) { return r.use != Use::none; };
  const std::uint64_t give_up_ns = clock_.now_ns() + kEndWithin_ns;
  while (!lost_ && std::any_of(requests_.begin(), requests_.end(), is_left)) {
    if (!next_end(give_up_ns)) break;
  }
}

void ClientTransport::unlink(const Request& request) {
  if (Request* const own = find(request.sequence)) own->unwanted = true;
  TransferHeader header;
  header.command = Command::unlink;
  header.victim = request.sequence;
  send(Use::unlink, header, {});
}

ClientTransport::Request* ClientTransport::find(std::uint32_t sequence) noexcept {
  const auto found = std::find_if(requests_.begin(), requests_.end(), [sequence](const Request& r) {
    return r.use != Use::none && r.sequence == sequence;
  });
  return found == requests_.end() ? nullptr : &*found;
}

std::uint32_t ClientTransport::send(Use use, TransferHeader header,
                                    std::span<const std::byte> data) {
  const auto free = std::find_if(requests_.begin(), requests_.end(),
                                 [](const Request& r) { return r.use == Use::none; });
  if (lost_ || free == requests_.end() || header.length > kMostBytes) return 0;
  if (++sequence_ == 0) ++sequence_;
  header.sequence = sequence_;
  header.device = device_;
  *free = {sequence_, use, header.is_in && use != Use::unlink, false, header.length, header.victim};
  const auto head = encode(header);
  std::copy(head.begin(), head.end(), message_.begin());
  std::copy(data.begin(), data.end(), message_.begin() + head.size());
  if (!send_all(std::span(message_).first(head.size() + data.size()))) lost_ = true;
  return lost_ ? 0 : sequence_;
}

std::optional<ClientTransport::End> ClientTransport::next_end(std::uint64_t until_ns) {
  if (lost_) return std::nullopt;
  const std::uint64_t now_ns = clock_.now_ns();
  const std::uint64_t left_ns = until_ns > now_ns ? until_ns - now_ns : 0;
  pollfd file{fd_, POLLIN, 0};
  const timespec patience{static_cast<time_t>(left_ns / kNsPerSecond),
                          static_cast<long>(left_ns % kNsPerSecond)};
  if (::ppoll(&file, 1, &patience, nullptr) <= 0) return std::nullopt;
  std::array<std::byte, kTransferHeaderBytes> head{};
  TransferHeader header;
  lost_ = true;  // until the message is whole and answers something
  if (!receive_all(head) || !decode(head, header)) return std::nullopt;
  Request* const request = find(header.sequence);
  if (request == nullptr) return std::nullopt;
  End end{*request, header.status, 0};
  const bool is_unlink = request->use == Use::unlink;
  if (header.command != (is_unlink ? Command::unlink_reply : Command::submit_reply)) {
    return std::nullopt;
  }
  if (!is_unlink) {
    end.bytes = header.length;
    if (end.bytes > request->room) return std::nullopt;
    if (request->is_in && !receive_all(std::span(data_).first(end.bytes))) return std::nullopt;
  }
  request->use = Use::none;
  // A request that was given up gets no answer of its own.
  Request* const victim = is_unlink && header.status != 0 ? find(end.request.victim) : nullptr;
  if (victim != nullptr) victim->use = Use::none;
  lost_ = false;
  return end;
}

IoResult ClientTransport::finish(std::uint32_t sequence, std::span<std::byte> out,
                                 std::uint32_t timeout_ms) {
  if (sequence == 0) return {lost_ ? IoStatus::lost : IoStatus::failed};
  const std::uint64_t until_ns = clock_.now_ns() + std::uint64_t{timeout_ms} * 1'000'000;
  while (const auto end = next_end(until_ns)) {
    if (end->request.sequence != sequence) continue;  // of what was given up before
    if (end->status == kStalled) return {IoStatus::stalled};
    if (end->status != kDone) return {IoStatus::failed};
    std::copy_n(data_.begin(), std::min(out.size(), end->bytes), out.begin());
    return {IoStatus::ok, end->bytes};
  }
  if (lost_) return {IoStatus::lost};
  if (const Request* const request = find(sequence)) unlink(Request(*request));
  return {IoStatus::timed_out};
}

bool ClientTransport::send_all(std::span<const std::byte> bytes) const {
  return send_whole(fd_, bytes);
}
bool ClientTransport::receive_all(std::span<std::byte> bytes) const {
  return receive_whole(fd_, bytes);
}

std::variant<std::unique_ptr<Transport>, DeviceProblem> open_device(const std::string& host,
                                                                    std::uint16_t port) {
  const std::string where = host + ":" + std::to_string(port);
  const DeviceProblem no_answer{"find", "no server of USB/IP answers at " + where,
                                "start one there: palpate-sim, or usbipd"};
  const Socket asking(connect_to(host, port));
  const auto bus_id = asking.fd() >= 0 ? find_bus_id(asking.fd()) : std::nullopt;
  if (!bus_id) return no_answer;
  if (bus_id->empty()) {
    return DeviceProblem{"find", where + " has no device of the open protocol to give",
                         "end what uses it, or export it there ('usbip bind')"};
  }
  const int fd = connect_to(host, port);
  if (fd < 0) return no_answer;
  auto transport = std::make_unique<ClientTransport>(fd);
  if (!transport->import(*bus_id)) {
    return DeviceProblem{"claim", "another program has the device of " + where, "end that program"};
  }
  const auto interface = set_up(*transport);
  if (!interface) {
    return DeviceProblem{"descriptors", "the device of " + where + " does not say what it is",
                         "switch it off and on, or start palpate-sim again"};
  }
  transport->use(*interface);
  return transport;
}

}  // namespace palpate::hal::usbip
