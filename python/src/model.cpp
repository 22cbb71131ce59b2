/// Bindings of hapticgiant.model: serial chains.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <variant>
#include <vector>

#include "hg/model/chain_data.h"
#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {
namespace {

using model::ChainData;
using model::ChainModel;
using Frame = std::variant<int, std::string>;

int index_of(const ChainModel& chain, const Frame& frame) {
  if (const auto* name = std::get_if<std::string>(&frame)) return chain.frame(*name);
  const int index = std::get<int>(frame);
  if (index < 0 || index >= static_cast<int>(chain.frame_names().size())) {
    throw nb::index_error("frame index out of range");
  }
  return index;
}

// calls function(q, dq) with arrays of the right sizes
template <typename Function>
auto with_state(const ChainModel& chain, const ArrayIn& q, const ArrayIn& dq,
                const Function& function) {
  return function(vector_of(q, chain.nq(), "q"), vector_of(dq, chain.nv(), "dq"));
}

model::ChainOptions options_from(const Pose& placement, bool gravity, bool floating_root,
                                 const std::string& root_link, const std::string& tip_link) {
  model::ChainOptions options;
  options.T_B_root = placement;
  options.gravity = gravity;
  options.floating_root = floating_root;
  options.root_link = root_link;
  options.tip_link = tip_link;
  return options;
}

void bind_joint(nb::module_& module) {
  using model::Joint;
  nb::class_<Joint>(module, "Joint", "One moving joint of a chain.")
      .def_ro("name", &Joint::name)
      .def_prop_ro("type", [](const Joint& joint) { return std::string(to_string(joint.type)); })
      .def_ro("q_index", &Joint::q_index, "of its first coordinate in q")
      .def_ro("v_index", &Joint::v_index, "of its first velocity in dq")
      .def_ro("nq", &Joint::nq, "7 for a floating joint")
      .def_ro("nv", &Joint::nv, "6 for a floating joint")
      .def_prop_ro(
          "q_min", [](const Joint& joint) { return joint.position.lb; }, "rad or m")
      .def_prop_ro(
          "q_max", [](const Joint& joint) { return joint.position.ub; }, "rad or m")
      .def_ro("dq_max", &Joint::velocity_max, "rad/s or m/s")
      .def_ro("effort_max", &Joint::effort_max, "Nm or N");
}

void bind_set_up(nb::class_<ChainData>& chain) {
  const auto placement = nb::arg("placement") = Pose{};
  const auto gravity = nb::arg("gravity") = true;
  const auto floating_root = nb::arg("floating_root") = false;
  const auto root_link = nb::arg("root_link") = "";
  const auto tip_link = nb::arg("tip_link") = "";
  chain
      .def_static(
          "from_urdf_file",
          [](const std::string& file, const Pose& at, bool has_gravity, bool floats,
             const std::string& root, const std::string& tip) {
            return ChainData(
                ChainModel::from_urdf_file(file, options_from(at, has_gravity, floats, root, tip)));
          },
          nb::arg("file"), placement, gravity, floating_root, root_link, tip_link,
          "Reads a URDF; `placement` is the pose of its root in frame B.")
      .def_static(
          "from_urdf_text",
          [](const std::string& text, const std::string& source, const Pose& at, bool has_gravity,
             bool floats, const std::string& root, const std::string& tip) {
            return ChainData(ChainModel::from_urdf_text(
                text, source, options_from(at, has_gravity, floats, root, tip)));
          },
          nb::arg("text"), nb::arg("source") = "urdf", placement, gravity, floating_root, root_link,
          tip_link, "The same from text; `source` stands for the file in messages.")
      .def_prop_ro("name", [](const ChainData& self) { return self.model().name(); })
      .def_prop_ro(
          "nq", [](const ChainData& self) { return self.model().nq(); }, "number of coordinates")
      .def_prop_ro(
          "nv", [](const ChainData& self) { return self.model().nv(); }, "number of velocities")
      .def_prop_ro("joints", [](const ChainData& self) { return self.model().joints(); })
      .def_prop_ro("frame_names", [](const ChainData& self) { return self.model().frame_names(); });
}

void bind_kinematics(nb::class_<ChainData>& chain) {
  const auto frame = nb::arg("frame");
  chain
      .def(
          "neutral", [](const ChainData& self) { return to_numpy(self.model().neutral()); },
          "(nq) zeros; identity for floating joints.")
      .def(
          "integrate",
          [](const ChainData& self, const ArrayIn& q, const ArrayIn& step) {
            return with_state(self.model(), q, step, [&](const auto& at, const auto& by) {
              return to_numpy(self.model().integrate(at, by));
            });
          },
          nb::arg("q"), nb::arg("step"), "(nq) q moved by step (nv) = dq * dt.")
      .def(
          "update",
          [](ChainData& self, const ArrayIn& q, const ArrayIn& dq) {
            with_state(self.model(), q, dq,
                       [&](const auto& at, const auto& with) { self.update(at, with); });
          },
          nb::arg("q"), nb::arg("dq"),
          "Sets the state, q (nq) and dq (nv), that all results below are for.")
      .def(
          "pose",
          [](const ChainData& self, const Frame& f) {
            return self.pose(index_of(self.model(), f));
          },
          frame, "Pose of a frame relative to B; frames by name or index.")
      .def(
          "twist",
          [](const ChainData& self, const Frame& f) {
            return to_numpy(self.twist(index_of(self.model(), f)));
          },
          frame, "(6) velocity of its origin, then angular velocity, in B.")
      .def(
          "jacobian",
          [](const ChainData& self, const Frame& f) {
            return to_numpy(self.jacobian(index_of(self.model(), f)));
          },
          frame, "(6, nv) twist = jacobian @ dq.")
      .def(
          "bias_acceleration",
          [](const ChainData& self, const Frame& f) {
            return to_numpy(self.bias_acceleration(index_of(self.model(), f)));
          },
          frame, "(6) derivative of the jacobian times dq.");
}

void bind_dynamics(nb::class_<ChainData>& chain) {
  chain
      .def_prop_ro(
          "M", [](const ChainData& self) { return to_numpy(self.M()); }, "(nv, nv) mass matrix")
      .def_prop_ro(
          "c", [](const ChainData& self) { return to_numpy(self.c()); },
          "(nv) Coriolis, centrifugal and gravity torques: M ddq + c = tau + J^T w")
      .def_prop_ro(
          "gravity", [](const ChainData& self) { return to_numpy(self.gravity()); },
          "(nv) the part of c that gravity makes")
      .def(
          "inverse_dynamics",
          [](ChainData& self, const ArrayIn& q, const ArrayIn& dq, const ArrayIn& ddq) {
            return with_state(self.model(), q, dq, [&](const auto& at, const auto& with) {
              return to_numpy(
                  self.inverse_dynamics(at, with, vector_of(ddq, self.model().nv(), "ddq")));
            });
          },
          nb::arg("q"), nb::arg("dq"), nb::arg("ddq"),
          "(nv) tau = M ddq + c; leaves the results of update() as they are.");
}

}  // namespace

void bind_model(nb::module_& module) {
  bind_joint(module);
  nb::class_<ChainData> chain(
      module, "Chain",
      "A serial kinematic chain. Results are resolved in frame B, linear part "
      "first, and belong to the last update().");
  bind_set_up(chain);
  bind_kinematics(chain);
  bind_dynamics(chain);
  module.def(
      "free_body",
      [](double mass, const ArrayIn& inertia, const ArrayIn& p_handle_com, bool gravity) {
        model::FreeBody body;
        body.mass = mass;
        assign(inertia, "inertia", body.inertia);
        assign(p_handle_com, "p_handle_com", body.p_handle_com);
        return ChainData(ChainModel::free_body(body, {.gravity = gravity}));
      },
      nb::arg("mass"), nb::arg("inertia"), nb::arg("p_handle_com") = std::vector{0.0, 0.0, 0.0},
      nb::arg("gravity") = true,
      "A rigid body that moves freely: mass (kg), inertia (3, 3) about its centre (kg m^2), centre "
      "of mass in frame \"handle\" (m).");
}

}  // namespace hg::python
