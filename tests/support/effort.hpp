// SPDX-License-Identifier: Apache-2.0
// How much a test of many cases does.
#pragma once

namespace palpate::test {

/// `all`; under the thread sanitizer `few`, because every memory access costs some twenty times
/// there and code of one thread has nothing for it to see in more cases.
template <class T>
constexpr T effort([[maybe_unused]] T all, [[maybe_unused]] T few) {
#ifdef PALPATE_THREAD_SANITIZER
  return few;
#else
  return all;
#endif
}

}  // namespace palpate::test
