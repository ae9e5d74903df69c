// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces belong to which convex patch while both change.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/decompose/decompose.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {

/// Patches keep their number; a patch that merges into another or loses its last face names an
/// heir.
class PatchLists {
 public:
  PatchLists(const Surface& surface, std::span<const Patch> patches);

  [[nodiscard]] std::uint32_t of(std::uint32_t face) const { return of_[face]; }
  [[nodiscard]] const std::vector<std::uint32_t>& of_faces() const { return of_; }
  [[nodiscard]] std::uint32_t size(std::uint32_t patch) const { return size_[patch]; }
  [[nodiscard]] bool alive(std::uint32_t patch) const { return size_[patch] > 0; }
  [[nodiscard]] std::uint32_t living() const { return living_; }
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(size_.size()); }
  [[nodiscard]] bool back_open(std::uint32_t patch) const { return back_open_[patch] != 0; }
  /// A whole component: no face next to one of another patch, or to none.
  [[nodiscard]] bool closed(std::uint32_t patch) const { return border_[patch] == 0; }
  /// The living patch that took over from a patch; itself while alive.
  [[nodiscard]] std::uint32_t heir(std::uint32_t patch) const;

  /// Calls visit(face) for the faces of a patch.
  template <class Visit>
  void for_each(std::uint32_t patch, Visit visit) const {
    for (std::uint32_t f = head_[patch]; f != kNothing; f = next_[f]) visit(f);
  }

  /// Around a change of the surface: first suspend() with the faces that will change or go, then
  /// drop() those that went, then resume() with those that are left.
  void suspend(const Surface& surface, std::span<const std::uint32_t> faces);
  void drop(std::uint32_t face, std::uint32_t heir_face);
  void resume(const Surface& surface, std::span<const std::uint32_t> faces);

  /// Joins two neighbours; returns the number that the union keeps, that of the larger.
  std::uint32_t merge(const Surface& surface, std::uint32_t a, std::uint32_t b);

 private:
  [[nodiscard]] std::uint32_t borders(const Surface& surface, std::uint32_t face) const;
  void unlink(std::uint32_t face);
  void link(std::uint32_t face, std::uint32_t patch);

  std::vector<std::uint32_t> of_, next_, previous_;         // by face
  std::vector<std::uint32_t> head_, size_, border_, heir_;  // by patch
  std::vector<char> back_open_;
  std::uint32_t living_ = 0;
};

}  // namespace palpate::bake
