/// Bystander in the way of the arm: a body part that a point of the arm hits.
///
/// Source: ISO/TS 15066:2016 Annex A, the body model of A.3.5: a mass behind a spring. The spring
/// pushes along the normal of the skin and never pulls; there is no friction and no damping. A body
/// that is not clamped is pushed away and does not come back; a clamped one stands against a wall.
/// The force is that of the positions at the start of a step, the body moves on in it
/// (semi-implicit), so that the energy of the impact neither grows nor shrinks.
///
/// SI units. No allocation, noexcept after set-up. Copyable.
#pragma once

#include <array>
#include <string_view>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/signals/touch.h"

namespace hg::simulator {

/// One body part: a row of Tables A.2 and A.3.
struct BodyPart {
  std::string_view name;
  double stiffness;  ///< N/m
  double mass;       ///< kg
  double force;      ///< permissible quasi-static force, N
  /// Permissible quasi-static pressure at the most sensitive spot of the part, N/cm^2
  double pressure;
  double transient;  ///< factor on both for a transient contact; 1 where the source allows none
};

/// Body parts of ISO/TS 15066:2016, Tables A.2 and A.3; docs/concepts/compliance.md says what was
/// verified.
inline constexpr std::array kBodyParts = {
    BodyPart{"skull", 150e3, 4.4, 130.0, 110.0, 1.0},
    BodyPart{"face", 75e3, 4.4, 65.0, 110.0, 1.0},
    BodyPart{"neck", 50e3, 1.2, 150.0, 140.0, 2.0},
    BodyPart{"back", 35e3, 40.0, 210.0, 160.0, 2.0},
    BodyPart{"chest", 25e3, 40.0, 140.0, 120.0, 2.0},
    BodyPart{"abdomen", 10e3, 40.0, 110.0, 140.0, 2.0},
    BodyPart{"pelvis", 25e3, 40.0, 180.0, 210.0, 2.0},
    BodyPart{"upper_arm", 30e3, 3.0, 150.0, 190.0, 2.0},
    BodyPart{"lower_arm", 40e3, 2.0, 160.0, 180.0, 2.0},
    BodyPart{"hand", 75e3, 0.6, 140.0, 190.0, 2.0},
    BodyPart{"thigh", 50e3, 75.0, 220.0, 220.0, 2.0},
    BodyPart{"lower_leg", 60e3, 75.0, 130.0, 210.0, 2.0},
};

/// Finds a body part by name; null: no such part.
const BodyPart* find_body_part(std::string_view name) noexcept;

/// Set-up data of a bystander.
struct BystanderConfig {
  const BodyPart* part = nullptr;
  int frame = -1;  ///< frame of the arm whose origin hits the body
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< point on the skin, m in B
  Eigen::Vector3d facing = Eigen::Vector3d::UnitX();   ///< outward normal of the skin, in B
  double reach = 0.15;  ///< lateral extent of the body around `position`, m, [A]
  double area = 10e-4;  ///< contact area, m^2, [A]: a tube of 10 cm on flesh
  bool is_clamped = false;
};

class Bystander {
 public:
  Bystander() = default;
  /// `facing` is normalised.
  explicit Bystander(const BystanderConfig& config);

  /// Advances by one step of `h` seconds with the arm's point at `p`. Returns the force on the arm,
  /// N in B. Contact is made from the front only.
  Eigen::Vector3d step(double h, const Eigen::Vector3d& p) noexcept;

  const BystanderReport& report() const noexcept { return report_; }
  /// Kinetic and spring energy of the body, J.
  double energy() const noexcept;

 private:
  BystanderConfig config_;
  bool is_in_front_ = false;           ///< the arm was in front of the skin in the last step
  double pushed_ = 0.0, speed_ = 0.0;  ///< displacement and speed of the pushed body
  BystanderReport report_;
};

}  // namespace hg::simulator
