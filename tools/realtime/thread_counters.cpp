// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/thread_counters.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_COUNT_ALLOCATIONS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define PALPATE_COUNT_ALLOCATIONS 0
#endif
#endif
#ifndef PALPATE_COUNT_ALLOCATIONS
#ifdef __GLIBC__
#define PALPATE_COUNT_ALLOCATIONS 1
#else
#define PALPATE_COUNT_ALLOCATIONS 0
#endif
#endif

#if PALPATE_COUNT_ALLOCATIONS

namespace {

// Initial-exec: reached without a call into the loader, which may itself allocate.
__attribute__((tls_model("initial-exec"))) thread_local std::uint64_t t_allocator_calls = 0;

}  // namespace

// The C library's own allocator under the names that it keeps for those who replace the public
// ones. NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void* block);
void* memalign(std::size_t alignment, std::size_t bytes) noexcept;
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

extern "C" {

void* malloc(std::size_t bytes) noexcept {
  ++t_allocator_calls;
  return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
  ++t_allocator_calls;
  return __libc_calloc(count, bytes);
}

void* realloc(void* block, std::size_t bytes) noexcept {
  ++t_allocator_calls;
  return __libc_realloc(block, bytes);
}

void free(void* block) noexcept {
  ++t_allocator_calls;
  __libc_free(block);
}

void* memalign(std::size_t alignment, std::size_t bytes) noexcept {
  ++t_allocator_calls;
  return __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return memalign(alignment, bytes);
}

int posix_memalign(void** out, std::size_t alignment, std::size_t bytes) noexcept {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* const block = memalign(alignment, bytes);
  if (block == nullptr) return ENOMEM;
  *out = block;
  return 0;
}

}  // extern "C"

#endif

namespace palpate::realtime {
namespace {

std::optional<std::uint64_t> allocator_calls() noexcept {
#if PALPATE_COUNT_ALLOCATIONS
  return t_allocator_calls;
#else
  return std::nullopt;
#endif
}

}  // namespace

ThreadCounters thread_counters() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {allocator_calls(), static_cast<std::uint64_t>(usage.ru_minflt),
          static_cast<std::uint64_t>(usage.ru_majflt)};
}

ThreadCounters operator-(const ThreadCounters& later, const ThreadCounters& earlier) noexcept {
  ThreadCounters moved;
  if (later.allocator_calls && earlier.allocator_calls) {
    moved.allocator_calls = *later.allocator_calls - *earlier.allocator_calls;
  }
  moved.minor_faults = later.minor_faults - earlier.minor_faults;
  moved.major_faults = later.major_faults - earlier.major_faults;
  return moved;
}

}  // namespace palpate::realtime
