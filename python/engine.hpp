// SPDX-License-Identifier: Apache-2.0
// palpate.Engine: scene, settings and memory of one contact engine.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "image.hpp"

namespace palpate::python {

/// What one tick may spend; absent: no limit of the kind, and no reserve.
struct Spending {
  std::optional<std::uint64_t> units;
  std::optional<double> budget_us;
  std::uint64_t reserve_units = 0;
  double reserve_us = 0;
};

class Engine {
 public:
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  /// @param pairs     absent: the tool against every other body
  /// @param limits    nodes, contacts, clusters; each may be missing
  /// @param settings  fields of palpate_settings
  Engine(std::vector<std::shared_ptr<Image>> images, const std::optional<Pairs>& pairs,
         std::uint32_t tool, const py::dict& limits, const py::kwargs& settings);

  void configure(const py::kwargs& settings);
  [[nodiscard]] py::dict settings() const;
  [[nodiscard]] std::size_t memory_bytes() const noexcept { return size_; }
  [[nodiscard]] std::size_t bodies() const noexcept { return images_.size(); }
  [[nodiscard]] std::uint32_t tool() const noexcept { return scene_.tool; }
  [[nodiscard]] const std::vector<palpate_pair>& pairs() const noexcept { return pairs_; }

  palpate_result tick(const Poses& poses, const Spending& spending);
  py::array_t<palpate_result> ticks(const Poses& poses, const Spending& spending);
  [[nodiscard]] py::array_t<palpate_contact> contacts() const;
  [[nodiscard]] py::tuple predict(const Poses& tool) const;

 private:
  void tick_one(const palpate_pose* poses, const Spending& spending, const std::string& name,
                palpate_result& out);

  std::vector<std::shared_ptr<Image>> kept_;
  std::vector<palpate_image> images_;
  std::vector<palpate_pair> pairs_;
  palpate_scene scene_{};
  palpate_settings settings_{};
  std::unique_ptr<void, void (*)(void*)> memory_;
  std::size_t size_ = 0;
  palpate_engine* engine_ = nullptr;
  std::uint32_t last_contacts_ = 0;
  mutable std::mutex one_at_a_time_;  ///< threads of Python run during a tick
};

}  // namespace palpate::python
