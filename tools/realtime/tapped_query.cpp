// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/realtime/tapped_query.hpp"

#include <algorithm>

#include "tools/realtime/contact_force.hpp"

namespace palpate::realtime {
namespace {

std::array<float, 3> shown_vector(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

TappedQuery::TappedQuery(ContactQuery& contacts, hal::Mailbox<LiveTick>& out, std::uint32_t every,
                         const Settings& settings, Vec3d origin_m) noexcept
    : contacts_(contacts), out_(out), every_(every), settings_(settings), origin_m_(origin_m) {}

Status TappedQuery::tick(const Pose& tool, const Budget& budget, TickResult& out) noexcept {
  const Status status = contacts_.tick(tool, budget, out);
  if (++since_ >= every_ && status == Status::ok) {
    since_ = 0;
    show(tool, out);
  }
  return status;
}

void TappedQuery::show(const Pose& tool, const TickResult& result) noexcept {
  tick_.tool = tool;
  tick_.certificate = result.certificate;
  tick_.min_distance_m = result.min_distance_m;
  const std::size_t found = result.contacts.size();
  const std::size_t shown = std::min<std::size_t>(found, kMostLiveContacts);
  tick_.found = static_cast<std::uint32_t>(found);
  tick_.shown = static_cast<std::uint32_t>(shown);
  for (std::size_t i = 0; i < shown; ++i) {
    const Contact& from = result.contacts[i * found / shown];
    tick_.contacts[i] = {shown_vector(from.centre_m - origin_m_), shown_vector(from.normal),
                         static_cast<float>(from.distance_m),
                         static_cast<float>(contact_force(from, settings_))};
  }
  out_.write(tick_);
}

}  // namespace palpate::realtime
