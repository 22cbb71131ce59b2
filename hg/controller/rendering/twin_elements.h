/// The elements of a twin: what its file can give it besides its bodies and their motion.
///
/// `check` and trials of devices iterate kElements and name none of them. Whoever adds a member to
/// TwinDof or TwinModel adds it to an element, or the numbers below do not compile. A force of a
/// joint is computed in twin_forces.cpp.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hg/controller/rendering/twin_model.h"
#include "hg/core/aggregate.h"

namespace hg::rendering {

/// Where in a sample the law takes a torque over position: at its begin, which may add energy, or
/// in its middle, which adds none.
enum class TorqueAt { kBegin, kMiddle };

/// An element, and what it adds to one degree of freedom; nullptr: nothing.
struct Element {
  std::string_view key;         ///< Key in twin.yaml, of those of a joint below joints.NAME
  std::string_view length_key;  ///< The same for a joint that slides; empty: it has no other
  int dof_members = 0;          ///< Members of TwinDof that describe it
  int twin_members = 0;         ///< Members of TwinModel that describe it, besides `dofs`
  /// Leaves it out, as a trial of a device does; nullptr: it is part of the motion that the device
  /// has to follow.
  void (*leave_out)(TwinModel& twin) = nullptr;
  TorqueAt torque_at = TorqueAt::kBegin;
  double (*stiffness)(const TwinDof& dof) = nullptr;  ///< Largest, Nm/rad or N/m
  double (*damping)(const TwinDof& dof) = nullptr;    ///< At rest, Nms/rad or Ns/m
  double (*friction)(const TwinDof& dof) = nullptr;   ///< Of Coulomb, at every position, Nm or N
};

/// Sets these members of every degree of freedom as they are without the element.
template <auto... kMembers>
void reset_dofs(TwinModel& twin) {
  for (TwinDof& dof : twin.dofs) ((dof.*kMembers = TwinDof().*kMembers), ...);
}

inline constexpr std::array kElements = {
    Element{.key = "q_max_rad", .length_key = "q_max_m", .dof_members = 1},  // and other limits
    Element{.key = "stiffness_Nm_per_rad",
            .length_key = "stiffness_N_per_m",
            .dof_members = 3,
            .leave_out = reset_dofs<&TwinDof::stiffness, &TwinDof::rest, &TwinDof::preload>,
            .stiffness = [](const TwinDof& dof) { return dof.stiffness; }},
    Element{.key = "damping_Nms_per_rad",
            .length_key = "damping_Ns_per_m",
            .dof_members = 1,
            .leave_out = reset_dofs<&TwinDof::damping>,
            .damping = [](const TwinDof& dof) { return dof.damping; }},
    Element{.key = "quadratic_damping_Nms2_per_rad2",
            .length_key = "quadratic_damping_Ns2_per_m2",
            .dof_members = 1,
            .leave_out = reset_dofs<&TwinDof::quadratic_damping>},
    Element{.key = "friction_Nm",
            .length_key = "friction_N",
            .dof_members = 1,
            .leave_out = reset_dofs<&TwinDof::friction>,
            .friction = [](const TwinDof& dof) { return dof.friction; }},
    Element{.key = "closer",
            .dof_members = 1,
            .leave_out = reset_dofs<&TwinDof::closer>,
            .stiffness = [](const TwinDof& dof) { return dof.closer.stiffness; }},
    Element{.key = "profile",
            .dof_members = 1,
            .leave_out = reset_dofs<&TwinDof::profile>,
            .torque_at = TorqueAt::kMiddle,
            .stiffness = [](const TwinDof& dof) { return dof.profile.steepest(); }},
    Element{.key = "locks",
            .twin_members = 1,
            .leave_out = [](TwinModel& twin) { twin.locks.clear(); }},
    Element{.key = "conditional_limits",
            .twin_members = 1,
            .leave_out = [](TwinModel& twin) { twin.conditional_limits.clear(); }},
    Element{.key = "collision_spheres", .twin_members = 1},
    Element{.key = "reference_wrench",
            .twin_members = 1,
            .leave_out = [](TwinModel& twin) { twin.w_ref.setZero(); }},
    Element{.key = "mass_scale", .twin_members = 1},
    Element{.key = "felt_scale", .twin_members = 1},
    Element{.key = "couplings"},  // part of the chain, as are the next
    Element{.key = "loops"},
    Element{.key = "cams"},
};

/// Members of TwinDof that are none of an element: name, q_index, is_angle.
inline constexpr int kDofMembers = 3;
/// Members of TwinModel that are none of an element: chain, end_effector, q_start, dofs.
inline constexpr int kTwinMembers = 4;

/// Members of these elements.
constexpr int members_of(std::span<const Element> elements, int Element::*which) {
  int members = 0;
  for (const Element& element : elements) members += element.*which;
  return members;
}
static_assert(member_count<TwinDof>() == kDofMembers + members_of(kElements, &Element::dof_members),
              "an element in kElements must cover each member of TwinDof");
static_assert(member_count<TwinModel>() ==
                  kTwinMembers + members_of(kElements, &Element::twin_members),
              "an element in kElements must cover each member of TwinModel");

using Property = double (*Element::*)(const TwinDof& dof);

/// What elements add to a degree of freedom together, and the one of them that adds most; where
/// none adds anything, the first that could. `elements` must outlive it.
struct Total {
  double value = 0.0;
  const Element* most = nullptr;
};
/// Of a property; with `at` only of the elements with such a torque.
Total total_of(Property property, const TwinDof& dof, std::optional<TorqueAt> at = {},
               std::span<const Element> elements = kElements);

/// Path of the element's key in twin.yaml: "joints.hinge.damping_Nms_per_rad".
std::string item_of(const Element& element, const TwinDof& dof);

/// Leaves out all elements that are no part of the motion, see Element::leave_out.
void leave_out_forces(TwinModel& twin, std::span<const Element> elements = kElements);

}  // namespace hg::rendering
