// SPDX-License-Identifier: Apache-2.0
#include "rt_core/base/status.hpp"

#include "rt_core/base/assert.hpp"

namespace palpate {

const char* describe(Status s) noexcept {
  switch (s) {
    case Status::ok:
      return "ok";
    case Status::image_too_small:
      return "smaller than an image header";
    case Status::image_misaligned:
      return "not on a 64-byte boundary";
    case Status::image_bad_magic:
      return "not a Palpate image (magic differs)";
    case Status::image_bad_version:
      return "another format version";
    case Status::image_bad_byte_order:
      return "written for the other byte order";
    case Status::image_bad_size:
      return "size differs from the header's (cut or padded)";
    case Status::image_bad_hash:
      return "SHA-256 differs (damaged)";
    case Status::image_bad_header:
      return "a header field is out of range";
    case Status::image_bad_section:
      return "a section lies outside the image";
    case Status::image_bad_level:
      return "a level record is inconsistent";
    case Status::image_bad_piece:
      return "a piece record is inconsistent";
    case Status::image_bad_tree:
      return "parent and child links do not form one tree";
    case Status::image_bad_index:
      return "an index is out of range";
    case Status::image_bad_float:
      return "a number is not finite or out of range";
    case Status::image_missing_section:
      return "a section that the engine needs is missing";
    case Status::image_over_limit:
      return "exceeds a capacity of this build";
    case Status::bad_argument:
      return "an argument is missing or out of range";
    case Status::not_enough_memory:
      return "less memory than required_bytes()";
    case Status::bad_pose:
      return "a pose is not finite or its quaternion not of unit length";
    case Status::image_too_coarse:
      return "the scene needs detail that was left out of an image";
    case Status::answer_too_old:
      return "no contact query has ended for too long";
  }
  return "unknown status";
}

namespace {
AssertHandler g_assert_handler = nullptr;
}

void set_assert_handler(AssertHandler handler) noexcept { g_assert_handler = handler; }

void assert_failed(const char* expression, const char* file, int line) noexcept {
  if (g_assert_handler != nullptr) g_assert_handler(expression, file, line);
  __builtin_trap();
}

}  // namespace palpate
