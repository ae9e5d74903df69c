// SPDX-License-Identifier: Apache-2.0
// Bad code (a broken precondition) asserts; bad data is a Status. Asserts are on wherever NDEBUG is
// not defined.
#pragma once

namespace palpate {

/// Called when an assertion fails; must not return. The default stops the processor
/// (__builtin_trap).
using AssertHandler = void (*)(const char* expression, const char* file, int line);

/// Replaces the handler for the whole program; null restores the default. Not thread safe: call it
/// at start.
void set_assert_handler(AssertHandler handler) noexcept;

[[noreturn]] void assert_failed(const char* expression, const char* file, int line) noexcept;

}  // namespace palpate

#ifdef NDEBUG
#define PALPATE_ASSERT(expression) static_cast<void>(0)
#else
#define PALPATE_ASSERT(expression) \
  ((expression) ? static_cast<void>(0) : ::palpate::assert_failed(#expression, __FILE__, __LINE__))
#endif
