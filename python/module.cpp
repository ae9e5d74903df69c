// SPDX-License-Identifier: Apache-2.0
// palpate._engine: rt_core/palpate.h for Python.
#include <pybind11/stl.h>

#include "engine.hpp"
#include "image.hpp"

namespace palpate::python {
namespace {

constexpr const char* kContactWords[] = {"ruled_out", "undecided", "found"};

void add_image(py::module_& m) {
  py::class_<Image, std::shared_ptr<Image>>(m, "Image",
                                            R"(A baked image (palpate bake), used in place.

Image(path) maps the file and proves that it is sound; it must not be written to while it is open.
Image.from_bytes(buffer) takes bytes in memory: in place where they lie on a 64-byte boundary, else
a copy of them.)")
      .def(py::init<const py::object&>(), py::arg("path"))
      .def_static("from_bytes", &Image::from_bytes, py::arg("buffer"))
      .def_property_readonly("nbytes", &Image::size, "Size of the image, bytes.")
      .def_property_readonly("name", &Image::name, "The path as given.")
      .def("__repr__", [](const Image& i) {
        return "<palpate.Image " + i.name() + ", " + std::to_string(i.size()) + " bytes>";
      });
}

/// A vector of the result as a view into it.
template <double (palpate_result::*member)[3]>
py::array_t<double> vector_of(const py::object& self) {
  return view_of(self.cast<const palpate_result&>().*member, self);
}

void add_result(py::module_& m) {
  using R = palpate_result;
  py::class_<R>(m, "Result", R"(What one tick found, with its certificate. World axes, SI units.)")
      .def_property_readonly("force_N", &vector_of<&R::force_N>, "(3,) force on the tool, N.")
      .def_property_readonly("torque_Nm", &vector_of<&R::torque_Nm>,
                             "(3,) torque on the tool about its origin, N m.")
      .def_readonly("min_distance_m", &R::min_distance_m,
                    "Least signed distance over contacts, m; NaN without contacts.")
      .def_readonly("error_bound_m", &R::error_bound_m,
                    "Certificate: the true least distance is within this of min_distance_m, or of "
                    "delta where there is no contact, m.")
      .def_readonly("force_bound_N", &R::force_bound_N,
                    "Certificate: bound of the force's error, N (regions).")
      .def_readonly("s_worst", &R::s_worst,
                    "Certificate: largest weighted surface deviation left unrefined, relative to "
                    "the radius (levels).")
      .def_readonly("units_used", &R::units_used, "Work units that the tick took.")
      .def_readonly("queries", &R::queries, "Convex-pair queries (levels) or box tests (regions).")
      .def_readonly("front_nodes", &R::front_nodes, "Nodes in the front; near regions.")
      .def_readonly("contacts", &R::contacts, "How many contacts; Engine.contacts() gives them.")
      .def_readonly("clusters", &R::clusters, "Directions that are felt.")
      .def_property_readonly(
          "contact", [](const R& r) { return kContactWords[r.contact]; },
          "Certificate: 'found', 'ruled_out' (there is certainly none) or 'undecided'.")
      .def_property_readonly(
          "truncated",
          [](const R& r) {
            return (r.truncated_by_time | r.truncated_by_units | r.truncated_by_memory) != 0;
          },
          "Whether the budget or memory ended refinement.")
      .def_property_readonly(
          "truncated_by_time", [](const R& r) { return r.truncated_by_time != 0; },
          "Whether the deadline ended refinement.")
      .def_property_readonly(
          "truncated_by_units", [](const R& r) { return r.truncated_by_units != 0; },
          "Whether the work units ended refinement.")
      .def_property_readonly(
          "truncated_by_memory", [](const R& r) { return r.truncated_by_memory != 0; },
          "Whether nodes, contacts or clusters were used up.")
      .def_property_readonly(
          "on_reserve", [](const R& r) { return r.on_reserve != 0; },
          "Whether the tick went on for a first contact.")
      .def("__repr__", [](const R& r) {
        return "<palpate.Result contact=" + std::string(kContactWords[r.contact]) + ", " +
               std::to_string(r.contacts) + " contacts>";
      });
}

void add_engine(py::module_& m) {
  const auto spending = [](std::optional<std::uint64_t> units, std::optional<double> budget_us,
                           std::uint64_t reserve_units, double reserve_us) {
    return Spending{units, budget_us, reserve_units, reserve_us};
  };
  py::class_<Engine>(m, "Engine", R"(A contact engine over a few bodies.

Engine(images, pairs=None, tool=0, limits={}, **settings)
  images    list of palpate.Image, 2 to 64
  pairs     list of (a, b), indices of bodies that may touch, normals from b to a; None: the tool
            against every other body
  tool      index of the body that the wrench acts on
  limits    {"nodes": n, "contacts": n, "clusters": n}, room for each
  settings  engine="levels" or "regions", delta_m, s0, kappa, exact, bounds="tight" or
            "paper", order="force" or "deviation", force_tolerance_N, stiffness_N_per_m,
            cluster_radius_m, max_force_N, max_torque_Nm: as [engine] and [force] of a scene, but
            the wrench is limited only where it is said

One thread at a time ticks an engine; others of Python's run meanwhile.)")
      .def(py::init<std::vector<std::shared_ptr<Image>>, const std::optional<Engine::Pairs>&,
                    std::uint32_t, const py::dict&, const py::kwargs&>(),
           py::arg("images"), py::arg("pairs") = py::none(), py::arg("tool") = 0,
           py::arg("limits") = py::dict())
      .def("configure", &Engine::configure,
           "Changes settings between ticks; all but `engine`. What is not named stays.")
      .def_property_readonly("settings", &Engine::settings, "All settings, a dict.")
      .def_property_readonly("memory_bytes", &Engine::memory_bytes,
                             "Memory of the engine beside its images, bytes.")
      .def_property_readonly("bodies", &Engine::bodies, "How many bodies.")
      .def_property_readonly("tool", &Engine::tool, "Index of the tool.")
      .def_property_readonly(
          "pairs",
          [](const Engine& e) {
            Engine::Pairs pairs;
            for (const palpate_pair& p : e.pairs()) pairs.emplace_back(p.a, p.b);
            return pairs;
          },
          "The pairs that may touch, (a, b).")
      .def(
          "tick",
          [spending](Engine& e, const Poses& poses, std::optional<std::uint64_t> units,
                     std::optional<double> budget_us, std::uint64_t reserve_units,
                     double reserve_us) {
            return e.tick(poses, spending(units, budget_us, reserve_units, reserve_us));
          },
          py::arg("poses"), py::kw_only(), py::arg("units") = py::none(),
          py::arg("budget_us") = py::none(), py::arg("reserve_units") = 0,
          py::arg("reserve_us") = 0.0, R"(One contact query and its wrench: a Result.

poses          (bodies, 7) float64, rows px py pz qw qx qy qz, m and unit quaternion, body to world;
               read in place where contiguous
units          work units after which refinement ends; the same bits on every machine
budget_us      time after which it ends, microseconds; neither: until nothing is left to refine
reserve_units  more of each for a tick of "regions" that feels nothing and cannot rule out a
reserve_us     contact, until it can)")
      .def(
          "ticks",
          [spending](Engine& e, const Poses& poses, std::optional<std::uint64_t> units,
                     std::optional<double> budget_us, std::uint64_t reserve_units,
                     double reserve_us) {
            return e.ticks(poses, spending(units, budget_us, reserve_units, reserve_us));
          },
          py::arg("poses"), py::kw_only(), py::arg("units") = py::none(),
          py::arg("budget_us") = py::none(), py::arg("reserve_units") = 0,
          py::arg("reserve_us") = 0.0, R"(A tick for each set of poses of a motion.

poses    (ticks, bodies, 7) float64, as tick() takes them
returns  (ticks,) structured array with the fields of Result: force_N (3,), torque_Nm (3,),
         min_distance_m, error_bound_m, force_bound_N, s_worst, contacts, ...; `contact` is 0 where
         one is ruled out, 1 where it is undecided, 2 where one is found)")
      .def("contacts", &Engine::contacts, R"(The contacts of the last tick.

returns  (contacts,) structured array, world axes: point_a_m, point_b_m, normal (from b to a) and
         centre_m (where its force acts), each (3,), m; distance_m, negative in overlap; weight (its
         force is weight * stiffness * (delta - distance)); pair, piece_a, level_a, piece_b, level_b)")
      .def("predict", &Engine::predict, py::arg("tool"),
           R"(The wrench of the last tick at a pose of the tool nearby, without a query.

tool     (7,) px py pz qw qx qy qz
returns  (force_N (3,), torque_Nm (3,)))");
}

}  // namespace
}  // namespace palpate::python

PYBIND11_MODULE(_engine, m) {
  namespace py = pybind11;
  m.doc() = "rt_core/palpate.h for Python; import palpate";
  py::register_exception<palpate::python::Refused>(m, "Error", PyExc_ValueError).attr("__doc__") =
      "What is refused, where, and how to fix it.";
  PYBIND11_NUMPY_DTYPE(palpate_result, force_N, torque_Nm, min_distance_m, error_bound_m, s_worst,
                       force_bound_N, units_used, queries, front_nodes, contacts, clusters,
                       truncated_by_time, truncated_by_units, truncated_by_memory,
                       iteration_cap_met, contact, on_reserve);
  PYBIND11_NUMPY_DTYPE(palpate_contact, point_a_m, point_b_m, normal, distance_m, weight, pair,
                       piece_a, level_a, piece_b, level_b, centre_m);
  palpate::python::add_image(m);
  palpate::python::add_result(m);
  palpate::python::add_engine(m);
}
