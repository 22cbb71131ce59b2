/// Model-mediated teleoperation (Hannaford 1989; Mitra and Niemeyer 2008; Xu et al. 2016): the
/// remote half measures where its surroundings begin and how stiff they are, the leader renders
/// that at once. No force travels, so no delay is in the loop of hand and force.
///
/// A contact is a plane in port coordinates with a spring, found from force and position alone. The
/// leader has passed the plane by the time that it hears of it. It is not thrown back: the frame of
/// the leader shifts by the depth. When the hand withdraws, the remote machine waits at the surface
/// until the shift is gone; under load it goes back as far as the energy pays that the port has
/// taken. A spring that turns out stiffer keeps its force, one that turns out softer its depth:
/// both store less energy than before.
///
/// Until the leader knows a contact, the remote half presses with `touch_force` at most; then with
/// what the leader renders.
#pragma once

#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

/// Measures contacts: position, direction and stiffness.
class ContactEstimator {
 public:
  ContactEstimator(const MethodConfig& config, double dt)
      : threshold_(config.contact_force), dt_(dt) {}
  void start(Eigen::Index size) noexcept;
  void step(const PortVector& x, const PortVector& v, const PortVector& f) noexcept;
  const ContactModel& model() const noexcept { return model_; }

 private:
  void begin(const PortVector& x, const PortVector& f) noexcept;
  void refine(double depth, double speed, double force) noexcept;

  double threshold_, dt_;
  ContactModel model_;
  PortVector x_before_;         ///< Last position without a force
  PortVector x_first_;          ///< Position with the first force beyond the threshold
  double force_first_ = 0.0;    ///< That force
  int beyond_ = 0, below_ = 0;  ///< Samples in a row
  int since_change_ = 0;        ///< Samples
  // sums that forget: of depth d, speed v into the surface and force f, each times each
  double dd_ = 0.0, dv_ = 0.0, vv_ = 0.0, df_ = 0.0, vf_ = 0.0, weight_ = 0.0;
};

class ModelLeader final : public LeaderMethod {
 public:
  ModelLeader(const MethodConfig& config, double dt) : mass_(config.leader_mass), dt_(dt) {}
  void start(Eigen::Index size) noexcept override;
  PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                  LeaderPacket& packet) noexcept override;

 private:
  void take(const ContactModel& model, const PortVector& x) noexcept;
  void restore(const LeaderPort& port, double force) noexcept;
  double depth(const PortVector& x) const noexcept;

  double mass_, dt_;
  ContactModel model_;
  double stiffness_ = 0.0;  ///< Measured; that of `model_` becomes it
  PortVector shift_;        ///< Added to the leader's position
  PortVector sent_;         ///< The same in packets, without jumps
  double paid_ = 0.0;       ///< Energy spent on shifting back under load, J
};

class ModelRemote final : public RemoteMethod {
 public:
  ModelRemote(const MethodConfig& config, const MachineImpedance& machine, double dt)
      : config_(config), machine_(machine), contact_(config, dt) {}
  void start(const PortVector& x) noexcept override;
  RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                    RemotePacket& packet) noexcept override;

 private:
  MethodConfig config_;
  MachineImpedance machine_;
  ContactEstimator contact_;
};

}  // namespace hg::teleoperation
