// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/address.hpp"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace palpate::live {

std::string make_token() {
  std::array<unsigned char, 16> bits{};
  if (::getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size())) {
    throw std::system_error(errno, std::generic_category(), "no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bits) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

bool same_token(std::string_view said, std::string_view token) noexcept {
  if (said.size() != token.size()) return false;
  unsigned differ = 0;
  for (std::size_t i = 0; i < said.size(); ++i) {
    differ |= static_cast<unsigned>(said[i]) ^ static_cast<unsigned>(token[i]);
  }
  return differ == 0;
}

bool is_own_host(std::string_view host, std::uint16_t port) {
  const std::string end = ":" + std::to_string(port);
  return host == "127.0.0.1" + end || host == "localhost" + end;
}

bool is_own_origin(std::string_view origin, std::uint16_t port) {
  constexpr std::string_view kScheme = "http://";
  return origin.substr(0, kScheme.size()) == kScheme &&
         is_own_host(origin.substr(kScheme.size()), port);
}

}  // namespace palpate::live
