// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/patch_lists.hpp"

#include <cassert>
#include <cstddef>
#include <utility>

namespace palpate::bake {

PatchLists::PatchLists(const Surface& surface, std::span<const Patch> patches)
    : of_(surface.faces.size(), kNothing),
      next_(surface.faces.size(), kNothing),
      previous_(surface.faces.size(), kNothing),
      head_(patches.size(), kNothing),
      size_(patches.size(), 0),
      border_(patches.size(), 0),
      living_(static_cast<std::uint32_t>(patches.size())) {
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    heir_.push_back(p);
    back_open_.push_back(patches[p].back_open ? 1 : 0);
    for (const std::uint32_t f : patches[p].faces) link(f, p);
  }
  for (std::uint32_t f = 0; f < of_.size(); ++f) border_[of_[f]] += borders(surface, f);
}

std::uint32_t PatchLists::heir(std::uint32_t patch) const {
  while (heir_[patch] != patch) patch = heir_[patch];
  return patch;
}

/// Sides of a face on its patch's border.
std::uint32_t PatchLists::borders(const Surface& surface, std::uint32_t face) const {
  std::uint32_t count = 0;
  for (std::uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
    const std::uint32_t t = surface.twin[h];
    if (t == kNothing || of_[t / 3] != of_[face]) ++count;
  }
  return count;
}

void PatchLists::link(std::uint32_t face, std::uint32_t patch) {
  of_[face] = patch;
  next_[face] = head_[patch];
  previous_[face] = kNothing;
  if (head_[patch] != kNothing) previous_[head_[patch]] = face;
  head_[patch] = face;
  ++size_[patch];
}

void PatchLists::unlink(std::uint32_t face) {
  const std::uint32_t patch = of_[face];
  if (previous_[face] == kNothing) {
    head_[patch] = next_[face];
  } else {
    next_[previous_[face]] = next_[face];
  }
  if (next_[face] != kNothing) previous_[next_[face]] = previous_[face];
  --size_[patch];
}

void PatchLists::suspend(const Surface& surface, std::span<const std::uint32_t> faces) {
  for (const std::uint32_t f : faces) border_[of_[f]] -= borders(surface, f);
}

void PatchLists::resume(const Surface& surface, std::span<const std::uint32_t> faces) {
  for (const std::uint32_t f : faces) border_[of_[f]] += borders(surface, f);
}

void PatchLists::drop(std::uint32_t face, std::uint32_t heir_face) {
  const std::uint32_t patch = of_[face];
  unlink(face);
  if (size_[patch] > 0) return;
  assert(of_[heir_face] != patch);
  heir_[patch] = of_[heir_face];
  --living_;
}

std::uint32_t PatchLists::merge(const Surface& surface, std::uint32_t a, std::uint32_t b) {
  if (size_[a] < size_[b]) std::swap(a, b);
  for (std::uint32_t f = head_[b]; f != kNothing; f = next_[f])
    for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      if (surface.twin[h] != kNothing && of_[surface.twin[h] / 3] == a) border_[a] -= 2;
  border_[a] += border_[b];
  while (head_[b] != kNothing) {
    const std::uint32_t f = head_[b];
    unlink(f);
    link(f, a);
  }
  heir_[b] = a;
  --living_;
  return a;
}

}  // namespace palpate::bake
