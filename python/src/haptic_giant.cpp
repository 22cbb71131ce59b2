/// Bindings of hapticgiant.haptic_giant: the closed forms of [HG].
#include "hg/model/haptic_giant.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <tuple>

#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {

void bind_haptic_giant(nb::module_& module) {
  namespace giant = model::haptic_giant;
  using giant::InverseStatus;
  const auto gantry = [](const ArrayIn& q_p) { return Eigen::Vector2d(vector_of(q_p, 2, "q_p")); };
  const auto joints = [](const ArrayIn& q_m) { return Vector6(vector_of(q_m, 6, "q_m")); };

  nb::enum_<InverseStatus>(module, "InverseStatus", "How an inverse ended.")
      .value("SOLVED", InverseStatus::kSolved)
      .value("SINGULAR", InverseStatus::kSingular, "hand axis vertical: exact, with q6 = 0")
      .value("HEIGHT_OUT_OF_REACH", InverseStatus::kHeightOutOfReach, "the nearest is returned")
      .value("DISTANCE_OUT_OF_REACH", InverseStatus::kDistanceOutOfReach,
             "the nearest is returned");
  module.def(
      "hand_pose",
      [=](const ArrayIn& q_p, const ArrayIn& q_m) {
        return giant::hand_pose(gantry(q_p), joints(q_m));
      },
      nb::arg("q_p"), nb::arg("q_m"), "Pose of the handle for gantry (2, m) and joints (6, rad).");
  module.def(
      "elbow",
      [=](const ArrayIn& q_p, const ArrayIn& q_m) {
        return to_numpy(giant::elbow(gantry(q_p), joints(q_m)));
      },
      nb::arg("q_p"), nb::arg("q_m"), "(3) origin of joint 4 in B, m.");
  module.def(
      "inverse",
      [=](const Pose& pose, const ArrayIn& q_p, const std::array<int, 3>& branch) {
        for (int sign : branch) {
          if (sign != 1 && sign != -1)
            throw nb::value_error("branch: expected three signs 1 or -1");
        }
        Vector6 q_m;
        const InverseStatus status =
            giant::inverse(pose, gantry(q_p), {branch[0], branch[1], branch[2]}, q_m);
        return std::tuple(to_numpy(q_m), status);
      },
      nb::arg("pose"), nb::arg("q_p"), nb::arg("branch") = std::array{1, 1, 1},
      "(q_m, status): joints (6, rad) that bring the handle to `pose`; `branch` is the signs of "
      "sin(q4+q5), sin q4, sin q2.");
  module.def(
      "inverse_at_target",
      [](const Pose& pose) {
        Eigen::Vector2d q_p;
        Vector6 q_m;
        const InverseStatus status = giant::inverse_at_target(pose, q_p, q_m);
        return std::tuple(to_numpy(q_p), to_numpy(q_m), status);
      },
      nb::arg("pose"),
      "(q_p, q_m, status): gantry and joints that hold `pose` in the best posture.");
  module.def(
      "jacobian_determinant",
      [=](const ArrayIn& q_m) { return giant::jacobian_determinant(joints(q_m)); }, nb::arg("q_m"),
      "Determinant of the Jacobian of m1..m6; zero where singular.");
  module.def(
      "gantry_target",
      [=](const ArrayIn& q_p, const ArrayIn& q_m) {
        return to_numpy(giant::gantry_target(gantry(q_p), joints(q_m)));
      },
      nb::arg("q_p"), nb::arg("q_m"), "(2) gantry position of [HG] (30), m.");
}

}  // namespace hg::python
