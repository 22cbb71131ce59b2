/// Bindings of hapticgiant.limits: bounds of one coordinate, for arrays of states.
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hg/limits/acceleration_bounds.h"
#include "hg/limits/velocity_bounds.h"
#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {
namespace {

using limits::JointLimits;
using limits::RecoverableOptions;
using Bounds = std::pair<ArrayOut, ArrayOut>;

bool is_anything(PyObject*) { return true; }

// any array-like, not yet converted
struct ArrayLike : nb::object {
  NB_OBJECT(ArrayLike, nb::object, "numpy.typing.ArrayLike", is_anything)
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kArrays =
    " q, dq: numbers or arrays that broadcast. Returns (lb, ub) of their common shape; NaN gives "
    "NaN.";

std::vector<std::size_t> shape_of(const ArrayIn& in) {
  std::vector<std::size_t> shape(in.array.ndim());
  for (std::size_t i = 0; i < shape.size(); ++i) shape[i] = in.array.shape(i);
  return shape;
}

// bounds(q, dq) -> Interval, evaluated for every pair of states
template <typename Function>
Bounds for_each_state(const ArrayLike& q, const ArrayLike& dq, const Function& bounds) {
  const nb::object both = nb::module_::import_("numpy").attr("broadcast_arrays")(q, dq);
  const auto positions = nb::cast<ArrayIn>(both[0]);
  const auto speeds = nb::cast<ArrayIn>(both[1]);
  std::vector<double> lower(positions.size()), upper(positions.size());
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const double position = positions.data()[i], speed = speeds.data()[i];
    const bool is_known = !std::isnan(position) && !std::isnan(speed);
    const Interval interval = is_known ? bounds(position, speed) : Interval{kNaN, kNaN};
    lower[i] = interval.lb;
    upper[i] = interval.ub;
  }
  const std::vector<std::size_t> shape = shape_of(positions);
  return {to_numpy(std::move(lower), shape), to_numpy(std::move(upper), shape)};
}

void require_positive(const char* name, double value) {
  if (!(value > 0.0)) throw nb::value_error((std::string(name) + " must be positive").c_str());
}

void bind_structs(nb::module_& module) {
  nb::class_<JointLimits>(module, "JointLimits",
                          "Limits of one coordinate: a joint (rad), a prismatic joint or an axis "
                          "(m). Infinite: no limit.")
      .def(
          "__init__",
          [](JointLimits* self, double q_min, double q_max, double dq_max, double ddq_max) {
            const JointLimits given{q_min, q_max, dq_max, ddq_max};
            check_joint_limits(given, "JointLimits");
            new (self) JointLimits(given);
          },
          nb::arg("q_min") = -kInfinity, nb::arg("q_max") = kInfinity,
          nb::arg("dq_max") = kInfinity, nb::arg("ddq_max") = kInfinity)
      .def_ro("q_min", &JointLimits::q_min, "lowest position")
      .def_ro("q_max", &JointLimits::q_max, "highest position; equal to q_min: a lock")
      .def_ro("dq_max", &JointLimits::dq_max, "largest speed")
      .def_ro("ddq_max", &JointLimits::ddq_max, "largest acceleration");

  nb::class_<RecoverableOptions>(module, "RecoverableOptions", "Shape of recoverable bounds.")
      .def(nb::init<>())
      .def_rw("tau", &RecoverableOptions::tau, "time constant of the approach, s")
      .def_rw("tau_rec", &RecoverableOptions::tau_rec, "time constant of the return, s")
      .def_rw("v_rec", &RecoverableOptions::v_rec, "speed of the return, rad/s or m/s")
      .def_rw("ddq_rec_factor", &RecoverableOptions::ddq_rec_factor,
              "braking beyond the limits may use so many times ddq_max");
}

void bind_acceleration_bounds(nb::module_& module) {
  module.def(
      "recoverable_bounds",
      [](const JointLimits& joint, const ArrayLike& q, const ArrayLike& dq, double dt,
         const RecoverableOptions* given) {
        require_positive("dt", dt);
        const RecoverableOptions options =
            given ? *given : limits::recoverable_options(joint, dt, dt);
        check_recoverable_options(options, joint, dt, "RecoverableOptions");
        return for_each_state(q, dq, [&](double position, double speed) {
          return limits::recoverable_bounds(joint, options, position, speed, dt);
        });
      },
      nb::arg("limits"), nb::arg("q"), nb::arg("dq"), nb::arg("dt"),
      nb::arg("options") = nb::none(),
      (std::string("Bounds R on the acceleration of the next period dt (s).") + kArrays).c_str());

  const auto add = [&](const char* name, const char* period, auto* function, const char* text) {
    module.def(
        name,
        [period, function](const JointLimits& joint, const ArrayLike& q, const ArrayLike& dq,
                           double dt) {
          require_positive(period, dt);
          return for_each_state(q, dq, [&](double position, double speed) {
            return function(joint, position, speed, dt);
          });
        },
        nb::arg("limits"), nb::arg("q"), nb::arg("dq"), nb::arg(period),
        (std::string(text) + kArrays).c_str());
  };
  add("bounds_A", "dt", &limits::bounds_A, "Bounds A of [HG]: position and speed hold.");
  add("bounds_B", "dt", &limits::bounds_B, "Bounds B of [HG]: as A, and braking always suffices.");
  add("bounds_C", "T_C", &limits::bounds_C,
      "Bounds C of [HG], eq. (8): the position reaches its limits within T_C (s).");
}

}  // namespace

void bind_limits(nb::module_& module) {
  bind_structs(module);
  bind_acceleration_bounds(module);
  module.def(
      "braking_velocity_bounds",
      [](double q_min, double q_max, const ArrayLike& q, double tau, double ddq_max) {
        const limits::DriveResponse drive{.tau = tau, .ddq_max = ddq_max};
        check_drive_response(drive, "braking_velocity_bounds");
        return for_each_state(q, q, [&](double position, double) {
          return limits::braking_velocity_bounds({q_min, q_max}, drive, position);
        });
      },
      nb::arg("q_min"), nb::arg("q_max"), nb::arg("q"), nb::arg("tau"), nb::arg("ddq_max"),
      "Bounds on the velocity (m/s) of an axis whose drive follows tau (s) late and brakes with "
      "ddq_max (m/s^2). Returns (lb, ub) of the shape of q.");
}

}  // namespace hg::python
