// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::hal::test {

inline constexpr std::uint64_t kMs = 1'000'000;  ///< in nanoseconds

}  // namespace palpate::hal::test
