// SPDX-License-Identifier: GPL-3.0-or-later
// The baker's one way to use several threads.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

#if defined(PALPATE_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace palpate::bake {

/// Calls work(i) for every i below count, on as many threads as oneTBB may use. Calls must not
/// depend on one another; all have ended when this returns.
///
/// Debian's oneTBB is not built for the thread sanitizer, which therefore does not see that tasks
/// begin after the call and end before its return; it is told so here, and finds what is left.
template <class Work>
void parallel_for(std::size_t count, const Work& work) {
#if defined(PALPATE_THREAD_SANITIZER)
  char begin = 0;
  char end = 0;
  __tsan_release(&begin);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    __tsan_acquire(&begin);
    work(i);
    __tsan_release(&end);
  });
  __tsan_acquire(&end);
#else
  tbb::parallel_for(std::size_t{0}, count, work);
#endif
}

}  // namespace palpate::bake
