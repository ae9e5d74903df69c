// SPDX-License-Identifier: Apache-2.0
// How much a test of many cases does.
#pragma once

namespace palpate::test {

/// `all`; under sanitizers `few`, because every memory access costs several times there, the thread
/// sanitizer's some twenty times, and more cases take the same ways through the code.
template <class T>
constexpr T effort([[maybe_unused]] T all, [[maybe_unused]] T few) {
#ifdef PALPATE_SANITIZED
  return few;
#else
  return all;
#endif
}

}  // namespace palpate::test
