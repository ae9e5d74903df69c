// SPDX-License-Identifier: Apache-2.0
// validate() against hostile bytes whose envelope (magic, size, hash) is made right, so that the
// deep checks are reached. What it accepts is walked as an engine would walk it.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "../support/tiny_image.hpp"
#include "../support/walk_image.hpp"
#include "rt_core/image/view.hpp"

extern "C" {
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned seed);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
}

namespace palpate::test {
namespace {

const std::vector<AlignedBytes>& sound_images() {
  static const std::vector<AlignedBytes> images = {
      seal(parts_of({triangle_part({0, 0, 0}, {1, 0, 0}, {0, 1, 0})})),
      seal(parts_of({tetrahedron_part(), triangle_part({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}),
                     ball_part(0.5f, 5, 8)})),
      seal(parts_of({box_part({0.3f, 0, 0}, {0.1f, 0.1f, 0.1f}),
                     box_part({-0.3f, 0, 0}, {0.1f, 0.1f, 0.1f}), tetrahedron_part(),
                     box_part({0, 0.3f, 0}, {0.1f, 0.1f, 0.1f}), tetrahedron_part()}))};
  return images;
}

void fix_envelope(AlignedBytes& bytes) {
  if (bytes.size() < sizeof(image::Header)) return;
  image::Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  std::memcpy(header.magic, image::kMagic, sizeof(header.magic));
  header.format_major = image::kFormatMajor;
  header.byte_order_mark = image::kByteOrderMark;
  header.total_bytes = bytes.size();
  std::memcpy(bytes.data(), &header, sizeof(header));
  rehash(bytes);
}

void check(const AlignedBytes& bytes) {
  ImageView view;
  if (validate(bytes, view) == Status::ok && !walk_image(view).empty()) __builtin_trap();
}

// One 32-bit word becomes a value that indices, counts and floats are sensitive to.
void spoil_word(std::uint8_t* data, std::size_t size, std::mt19937& random) {
  const std::size_t words = size / 4;
  const std::size_t at = random() % words * 4;
  std::uint32_t value = 0;
  std::memcpy(&value, data + at, 4);
  std::uint32_t other = 0;
  std::memcpy(&other, data + random() % words * 4, 4);
  const std::uint32_t choices[] = {
      0, 1, value + 1, value - 1, other, image::kNone, value ^ 0x80000000u, 0x7f800000u};
  value = choices[random() % std::size(choices)];
  std::memcpy(data + at, &value, 4);
}

}  // namespace
}  // namespace palpate::test

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned seed) {
  using namespace palpate::test;
  std::mt19937 random(seed);
  if (size < sizeof(palpate::image::Header) || random() % 32 == 0) {
    const AlignedBytes& image = sound_images()[random() % sound_images().size()];
    if (image.size() <= max_size) {
      std::memcpy(data, image.data(), image.size());
      return image.size();
    }
  }
  if (size < 4 || random() % 4 == 0) return LLVMFuzzerMutate(data, size, max_size);
  for (unsigned i = random() % 3 + 1; i > 0; --i) spoil_word(data, size, random);
  return size;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate::test;
  AlignedBytes bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  check(bytes);
  fix_envelope(bytes);
  check(bytes);
  return 0;
}
