#include "hg/controller/rendering/twin_elements.h"

namespace hg::rendering {

Total total_of(Property property, const TwinDof& dof, std::optional<TorqueAt> at,
               std::span<const Element> elements) {
  Total total;
  double largest = 0.0;
  for (const Element& element : elements) {
    if (element.*property == nullptr || (at && element.torque_at != *at)) continue;
    const double value = (element.*property)(dof);
    total.value += value;
    if (total.most == nullptr || value > largest) {
      total.most = &element;
      largest = value;
    }
  }
  return total;
}

std::string item_of(const Element& element, const TwinDof& dof) {
  const bool is_slide = !dof.is_angle && !element.length_key.empty();
  const std::string key(is_slide ? element.length_key : element.key);
  if (dof.q_index >= 0) return "joints." + dof.name + "." + key;
  // a floating joint: "root rx" belongs to joint root
  const std::string joint = dof.name.substr(0, dof.name.find_last_of(' '));
  return "joints." + joint + (dof.is_angle ? ".angular_" : ".") + key;
}

void leave_out_forces(TwinModel& twin, std::span<const Element> elements) {
  for (const Element& element : elements) {
    if (element.leave_out != nullptr) element.leave_out(twin);
  }
}

}  // namespace hg::rendering
