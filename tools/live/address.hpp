// SPDX-License-Identifier: GPL-3.0-or-later
// Who may see a live view: whoever knows its address, from a page of that address.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::live {

/// 128 random bits in hexadecimal. Throws std::system_error where the system has none.
[[nodiscard]] std::string make_token();

/// Compares in a time that does not tell how much of it is right.
[[nodiscard]] bool same_token(std::string_view said, std::string_view token) noexcept;

/// Whether a Host header names this server on this machine: another name would be another site's,
/// pointed here.
[[nodiscard]] bool is_own_host(std::string_view host, std::uint16_t port);

/// Whether an Origin header is that of a page of this server. False for none.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::uint16_t port);

}  // namespace palpate::live
