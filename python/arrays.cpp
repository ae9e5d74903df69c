// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <cmath>
#include <sstream>

namespace palpate::python {
namespace {

std::string shape_of(const Poses& poses) {
  std::ostringstream text;
  text << "(";
  for (py::ssize_t i = 0; i < poses.ndim(); ++i) text << (i > 0 ? ", " : "") << poses.shape(i);
  text << ")";
  return text.str();
}

}  // namespace

const palpate_pose* poses_in(const Poses& poses, py::ssize_t dimensions, std::size_t bodies) {
  const bool fits = poses.ndim() == dimensions && poses.shape(dimensions - 1) == kPoseNumbers &&
                    poses.shape(dimensions - 2) == static_cast<py::ssize_t>(bodies);
  if (!fits) {
    throw Refused("poses: shape " + shape_of(poses) + ": give " +
                  (dimensions == 3 ? "(ticks, " : "(") + std::to_string(bodies) +
                  ", 7), a row px py pz qw qx qy qz for each body");
  }
  return static_cast<const palpate_pose*>(static_cast<const void*>(poses.data()));
}

std::string fault_of(const palpate_pose& pose, const std::string& name) {
  double squared = 0;
  bool finite = true;
  for (const double v : pose.position_m) finite = finite && std::isfinite(v);
  for (const double v : pose.orientation) squared += v * v;
  if (!finite || !std::isfinite(squared)) return name + ": not finite: give seven numbers";
  const double length = std::sqrt(squared);
  if (std::abs(length - 1) <= 1e-3) return {};
  std::ostringstream text;
  text << name << ": a quaternion of length " << length
       << ": give w x y z of length 1, after the position";
  return text.str();
}

py::array_t<double> view_of(const double (&numbers)[3], const py::handle& owner) {
  py::array_t<double> view({3}, {sizeof(double)}, numbers, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

}  // namespace palpate::python
