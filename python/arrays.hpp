// SPDX-License-Identifier: Apache-2.0
// What the module's classes share: errors, and poses as NumPy arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <stdexcept>
#include <string>

#include "rt_core/palpate.h"

namespace palpate::python {

namespace py = pybind11;

/// palpate.Error in Python.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Rows of px py pz qw qx qy qz. Read in place where they are float64 and contiguous, else copied.
using Poses = py::array_t<double, py::array::c_style | py::array::forcecast>;

// A row is a palpate_pose.
static_assert(sizeof(palpate_pose) == 7 * sizeof(double));
inline constexpr py::ssize_t kPoseNumbers = 7;

/// The array's poses. Throws Refused where its shape is not (leading..., bodies, 7).
/// @param dimensions  2: one set of poses; 3: any number of them
const palpate_pose* poses_in(const Poses& poses, py::ssize_t dimensions, std::size_t bodies);

/// Why a pose cannot be used, with the cure; empty where it can. @param name  as in "poses[1]"
std::string fault_of(const palpate_pose& pose, const std::string& name);

/// A view of three numbers inside of an object of Python's, which the view keeps alive.
py::array_t<double> view_of(const double (&numbers)[3], const py::handle& owner);

}  // namespace palpate::python
