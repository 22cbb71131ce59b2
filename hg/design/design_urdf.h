/// The URDF of the HapticGiant with other lengths, masses and drives: every shape is stretched,
/// moved or scaled with the link that it belongs to. SI units.
#pragma once

#include <array>
#include <string>

#include "hg/model/haptic_giant.h"

namespace hg::design {

/// What a link of the arm gets.
struct DesignLink {
  double mass = 0.0;           ///< kg
  double centre = 0.0;         ///< Centre of mass along the link, m
  double inertia = 0.0;        ///< Transverse, about the centre of mass, kg m^2
  double axial_inertia = 0.0;  ///< About the link's axis, kg m^2
  double scale_start = 1.0;    ///< Cross-sections of the joint at the start over the base's
  double scale_end = 1.0;      ///< Of the joint at the end and of the collision shapes
  double velocity = 0.0, effort = 0.0;  ///< Of the joint that moves the link
};

struct UrdfChange {
  model::haptic_giant::Lengths from, to;
  std::array<DesignLink, 6> links;      ///< m1 to m6
  double wider_x = 0.0, wider_y = 0.0;  ///< By how much the gantry's frame is larger, m
  double higher = 0.0;                  ///< By how much joint 1 is higher above the floor, m
  std::array<double, 2> gantry_end{};   ///< Ends of the gantry's ranges, m
  std::string comment;                  ///< Says where the file is from
};

/// Throws SetupError where the text is not the URDF of a HapticGiant.
std::string changed_urdf(const std::string& text, const UrdfChange& change);

}  // namespace hg::design
