// SPDX-License-Identifier: Apache-2.0
// Interfaces and endpoints of a configuration descriptor.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace palpate::hal::test {

/// Calls a function with the number of each interface of a configuration, and each endpoint with
/// the interface that it belongs to.
template <class OnInterface, class OnEndpoint>
void walk(const std::vector<std::uint8_t>& configuration, OnInterface on_interface,
          OnEndpoint on_endpoint) {
  constexpr std::uint8_t kInterface = 4, kEndpoint = 5;
  unsigned interface = 0;
  for (std::size_t at = 0; at + 2 < configuration.size(); at += configuration[at]) {
    if (configuration[at] < 3) return;
    if (configuration[at + 1] == kInterface) on_interface(interface = configuration[at + 2]);
    if (configuration[at + 1] == kEndpoint) on_endpoint(configuration[at + 2], interface);
  }
}

[[nodiscard]] inline bool has_interface(const std::vector<std::uint8_t>& configuration,
                                        unsigned number) {
  bool found = false;
  walk(
      configuration, [&](unsigned interface) { found = found || interface == number; },
      [](unsigned, unsigned) {});
  return found;
}

[[nodiscard]] inline std::optional<unsigned> interface_of(
    const std::vector<std::uint8_t>& configuration, std::uint8_t endpoint) {
  std::optional<unsigned> found;
  walk(
      configuration, [](unsigned) {},
      [&](unsigned address, unsigned interface) {
        if (address == endpoint) found = interface;
      });
  return found;
}

}  // namespace palpate::hal::test
