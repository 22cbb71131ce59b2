#include "hg/controller/estimation/inertial_units.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "hg/controller/estimation/joint_observer.h"
#include "hg/controller/estimation/low_pass.h"
#include "hg/core/cross.h"
#include "hg/core/error.h"

namespace hg::estimation {
namespace {

// by how much joints and structure move otherwise than expected, standard deviations
constexpr double kJoint = 1.0, kGantry = 0.5;                 // rad/s^2 or m/s^2 of a slide
constexpr double kBendShift = 0.3, kBendTurn = 0.3;           // m/s^2, rad/s^2
constexpr double kReading = 0.1;                              // of what a known unit shows, m/s^2
constexpr double kLeastReading = 0.03;                        // m/s^2
constexpr double kLeastVariance = 1e-2, kMostVariance = 1e3;  // times those above
constexpr double kUsual_s = 0.3;                              // averaging time of deviations
constexpr double kTurnReading = 5e-3;                         // the same of a gyroscope, rad/s
constexpr double kTurnRate = 5e-4;  // by which a bend is unsure in a period
constexpr double kNonsense = 20.0;  // beyond what is expected, m/s^2
constexpr double kMostShown = 1e3;  // m/s^2 or rad/s, of any sensor
constexpr int kFrozen = 20;         // periods without any new bit
constexpr double kTrust_s = 0.5;    // time from no trust to full trust
constexpr double kFade_s = 0.02;    // time constant of fading out a unit that dropped out
constexpr double kBend_s = 0.3;     // time constant of forgetting a steady bend
constexpr double kSlow_Hz = 60.0;   // observer of a joint whose acceleration is seen

}  // namespace

InertialUnits::InertialUnits(const InertialUnitsConfig& config, double dt, double link_pole_Hz,
                             double gantry_pole_Hz, const model::ChainModel& chain, int n_p)
    : config_(config),
      dt_(dt),
      chain_(chain),
      n_p_(n_p),
      n_(chain.nv()),
      delay_(std::max(1, static_cast<int>(std::lround(config.delay / dt)))) {
  if (config_.frames.size() > kMaxInertialUnits) {
    throw SetupError("estimation.inertial_units: at most " + std::to_string(kMaxInertialUnits) +
                     " are possible, got " + std::to_string(config_.frames.size()));
  }
  if (delay_ + 2 > InertialUnitsState::kPast) {
    throw SetupError("estimation.inertial_delay_s: at most " +
                     std::to_string(InertialUnitsState::kPast - 2) + " periods, got " +
                     std::to_string(delay_));
  }
  fast_Hz_ = VectorPM::Constant(n_, link_pole_Hz);
  fast_Hz_.head(n_p_).setConstant(gantry_pole_Hz);
  slow_Hz_ = fast_Hz_.cwiseMin(kSlow_Hz);
  variance_.resize(n_ + 6);
  for (int i = 0; i < n_; ++i) {
    const bool is_slide = chain_.model().joints()[i].is_slide();
    variance_[i] = is_slide ? kGantry * kGantry : kJoint * kJoint;
  }
  variance_.segment<3>(n_).setConstant(kBendShift * kBendShift);
  variance_.tail<3>().setConstant(kBendTurn * kBendTurn);
}

const EncoderSample& InertialUnits::ago(int periods,
                                        const InertialUnitsState& state) const noexcept {
  constexpr std::size_t kPast = InertialUnitsState::kPast;
  return state.past[(state.newest + kPast - periods) % kPast];
}

// At the posture and speed of the last update of the chain.
LinkMotion InertialUnits::motion_of(int frame, const VectorPM& ddq) const noexcept {
  constexpr double kGravity = 9.81;  // as in the model of the device
  const Eigen::Matrix3d R_L_B = chain_.pose(frame).R.transpose();
  Vector6 acceleration = chain_.bias_acceleration(frame);
  acceleration.noalias() += chain_.jacobian(frame).lazyProduct(ddq);
  acceleration[2] += kGravity;
  return {.a = R_L_B * acceleration.head<3>(),
          .omega = R_L_B * chain_.twist(frame).tail<3>(),
          .alpha = R_L_B * acceleration.tail<3>()};
}

// What accelerations of joints and root do to an accelerometer, 3 x (n + 6).
InertialUnits::Rows InertialUnits::effect_on(const UnitCalibration& unit,
                                             int frame) const noexcept {
  const Pose& T_B_L = chain_.pose(frame);
  const model::Jacobian& J = chain_.jacobian(frame);
  const AccelerometerGains gains = gains_of(unit);
  const Eigen::Matrix3d of_shift = gains.of_a * T_B_L.R.transpose();
  const Eigen::Matrix3d of_turn = gains.of_alpha * T_B_L.R.transpose();
  const Eigen::Vector3d from_root = T_B_L.p - chain_.pose(config_.frames.front()).p;
  Rows rows(3, n_ + 6);
  rows.leftCols(n_).noalias() = of_shift.lazyProduct(J.topRows<3>());
  rows.leftCols(n_).noalias() += of_turn.lazyProduct(J.bottomRows<3>());
  rows.middleCols<3>(n_) = of_shift;
  rows.rightCols<3>() = of_turn - of_shift * cross_matrix(from_root);
  return rows;
}

bool InertialUnits::is_alive(std::size_t unit, const UnitReading& reading,
                             InertialUnitsState& state) const noexcept {
  UnitReading& last = state.last[unit];
  const bool is_same = reading.a == last.a && reading.omega == last.omega;
  state.same[unit] = is_same ? std::min(state.same[unit] + 1, kFrozen) : 0;
  last = reading;
  const double most =
      std::max(reading.a.cwiseAbs().maxCoeff(), reading.omega.cwiseAbs().maxCoeff());
  return reading.a.allFinite() && reading.omega.allFinite() && most < kMostShown &&
         state.same[unit] < kFrozen;
}

void InertialUnits::start(const EncoderSample& encoders, InertialUnitsState& state) const noexcept {
  state.is_started = true;
  if (config_.known) state.units = *config_.known;
  state.past.fill(encoders);
  state.trust.setZero(config_.frames.size());
  state.found = state.carried = Unknowns::Zero(n_ + 6);
  state.variance = variance_;
  state.error.setConstant(state.trust.size(), kReading * kReading);
  state.unseen = VectorPM::Ones(n_);
  state.q = encoders.q;
  state.dq = encoders.dq;
}

// Learns from the reading of a unit and updates its trust; false: the unit took part and drops out
// at once.
bool InertialUnits::judge(std::size_t j, const UnitReading& reading, const LinkMotion& by_encoders,
                          const Eigen::Vector3d& beyond, InertialUnitsState& state) const noexcept {
  double& trust = state.trust[j];
  const bool is_nonsense = trust > 0.0 && !(beyond.norm() < kNonsense);
  if (!is_alive(j, reading, state) || is_nonsense || state.seen < InertialUnitsState::kPast) {
    const bool was_in = trust > 0.0;
    trust = 0.0;
    return !was_in;
  }
  UnitCalibration& unit = state.units[j];
  learn(dt_, by_encoders, reading, unit);
  if (j == state.turn) solve(unit);
  trust = std::clamp(trust + (is_known(unit) ? dt_ : -dt_) / kTrust_s, 0.0, 1.0);
  return true;
}

// How far from the expected everything usually is: expectation maximisation, one step per period.
void InertialUnits::learn_deviations(const Unknowns& found, const Unknowns& left,
                                     const Rests& rests, InertialUnitsState& state) const noexcept {
  if (state.share < 1.0) return;
  const double share = dt_ / kUsual_s;
  state.variance += share * (found.cwiseAbs2() + left - state.variance);
  state.variance = state.variance.cwiseMin(kMostVariance * variance_);
  state.variance = state.variance.cwiseMax(kLeastVariance * variance_);
  for (Eigen::Index j = 0; j < state.trust.size(); ++j) {
    if (state.trust[j] < 1.0) continue;
    double& error = state.error[j];
    error += share * (rests[j].squaredNorm() / 3.0 - error);
    error = std::max(error, kLeastReading * kLeastReading);
  }
}

void InertialUnits::step(const InertialReadings& readings, const EncoderSample& encoders,
                         InertialUnitsState& state) noexcept {
  if (!state.is_started) start(encoders, state);
  state.newest = (state.newest + 1) % state.past.size();
  state.past[state.newest] = encoders;
  state.seen = std::min(state.seen + 1, InertialUnitsState::kPast);
  const EncoderSample &before = ago(delay_ + 1, state), &then = ago(delay_, state),
                      &after = ago(delay_ - 1, state);
  chain_.update_kinematics(then.q, then.dq);
  const VectorPM by_encoders =
      (after.measured - 2.0 * then.measured + before.measured) / (dt_ * dt_);
  const VectorPM by_reference = 0.5 * (then.ddq_expected + after.ddq_expected);

  Equations all = equations(readings, by_encoders, by_reference, state);
  state.turn = (state.turn + 1) % config_.frames.size();
  solve_for_motion(then, all, state);
}

InertialUnits::Equations InertialUnits::equations(const InertialReadings& readings,
                                                  const VectorPM& by_encoders,
                                                  const VectorPM& by_reference,
                                                  InertialUnitsState& state) const noexcept {
  Equations all = {.normal = Normal::Zero(n_ + 6, n_ + 6),
                   .sum = Unknowns::Zero(n_ + 6),
                   .turn_normal = Eigen::Matrix3d::Identity() / (kTurnRate * kTurnRate)};
  all.normal.diagonal() = state.variance.cwiseInverse();
  for (std::size_t j = 0; j < config_.frames.size(); ++j) {
    const int frame = config_.frames[j];
    UnitReading reading;
    const auto at = 6 * static_cast<Eigen::Index>(j);
    if (readings.size() >= at + 6) {
      reading = {.a = readings.segment<3>(at), .omega = readings.segment<3>(at + 3)};
    }
    const UnitCalibration& unit = state.units[j];
    const UnitReading shown = expected(unit, motion_of(frame, by_reference));
    const Eigen::Vector3d beyond = reading.a - shown.a;
    if (!judge(j, reading, motion_of(frame, by_encoders), beyond, state)) all.has_lost_one = true;
    const double trust = state.trust[j];
    if (trust == 0.0) continue;
    const Rows& rows = all.rows[j] = effect_on(unit, frame);
    all.rests[j] = beyond;
    const double weight = trust / state.error[j];
    all.normal.noalias() += weight * rows.transpose().lazyProduct(rows);
    all.sum.noalias() += weight * rows.transpose().lazyProduct(beyond);

    const Eigen::Matrix3d of_turn =
        unit.gyroscope.topRows<3>().transpose() * chain_.pose(frame).R.transpose();
    const double turn_weight = trust / (kTurnReading * kTurnReading);
    all.turn_normal.noalias() += turn_weight * of_turn.transpose() * of_turn;
    all.turn_sum.noalias() += turn_weight * of_turn.transpose() *
                              (reading.omega - shown.omega - of_turn * state.bend_rate.tail<3>());
  }
  return all;
}

void InertialUnits::solve_for_motion(const EncoderSample& then, Equations& equations,
                                     InertialUnitsState& state) const noexcept {
  const Eigen::LLT<Normal> factor(equations.normal);
  const Unknowns found = factor.solve(equations.sum);
  Normal inverse = Normal::Identity(n_ + 6, n_ + 6);
  factor.solveInPlace(inverse);
  state.unseen = inverse.diagonal().head(n_).cwiseQuotient(state.variance.head(n_));
  for (std::size_t j = 0; j < config_.frames.size(); ++j) {
    if (state.trust[j] > 0.0) equations.rests[j] -= equations.rows[j] * found;
  }
  learn_deviations(found, inverse.diagonal(), equations.rests, state);
  if (equations.has_lost_one) state.carried = state.found - found;
  state.carried *= 1.0 - dt_ / kFade_s;
  state.found = found + state.carried;
  observe(then, state);
  state.bend_rate.tail<3>() += equations.turn_normal.llt().solve(equations.turn_sum);
  const bool has_trust = state.trust.maxCoeff() > 0.5;
  state.share = std::clamp(state.share + (has_trust ? dt_ : -dt_) / kTrust_s, 0.0, 1.0);
}

// Joints when the units saw them, from one period to the next; and the bending.
void InertialUnits::observe(const EncoderSample& then, InertialUnitsState& state) const noexcept {
  for (int i = 0; i < n_; ++i) {
    const double f = slow_Hz_[i] + std::sqrt(state.unseen[i]) * (fast_Hz_[i] - slow_Hz_[i]);
    LinkObserver joint = {.q = state.q[i], .dq = state.dq[i]};
    estimation::observe(low_pass_pole(f, dt_), dt_, then.ddq_expected[i] + state.found[i],
                        then.measured[i], joint);
    state.q[i] = joint.q;
    state.dq[i] = joint.dq;
  }
  const double kept = 1.0 - dt_ / kBend_s;
  state.bend_rate = kept * state.bend_rate + dt_ * state.found.tail<6>();
  state.bend = kept * state.bend + dt_ * state.bend_rate;
}

InertialReport InertialUnits::report(const InertialUnitsState& state) const noexcept {
  InertialReport report;
  if (!state.is_started) return report;
  report.q = state.q;
  report.dq = state.dq;
  for (int k = delay_ - 1; k >= 0; --k) {
    const VectorPM ddq = ago(k, state).ddq_expected + state.found.head(n_);
    report.q += dt_ * report.dq + 0.5 * dt_ * dt_ * ddq;
    report.dq += dt_ * ddq;
    report.ddq = ddq;
  }
  report.bend = state.bend;
  report.bend_rate = state.bend_rate;
  report.bend_acceleration = state.found.tail<6>();
  report.trust = state.trust;
  return report;
}

void InertialUnits::feed_back(const InertialUnitsState& state, RobotState& robot) const noexcept {
  if (!config_.feeds_back) return;
  const InertialReport now = report(state);
  const int n_m = n_ - n_p_;
  robot.q_m += state.share * (now.q.tail(n_m) - robot.q_m);
  robot.dq_m += state.share * (now.dq.tail(n_m) - robot.dq_m);
  robot.q_p += state.share * (now.q.head(n_p_) - robot.q_p);
  robot.dq_p += state.share * (now.dq.head(n_p_) - robot.dq_p);
  // bending under the arm shakes it like a motion of the axis beneath
  const model::Jacobian& J = chain_.jacobian(config_.frames.front());
  for (int i = 0; i < n_p_; ++i) {
    const double bent = J.col(i).dot(state.found.tail<6>()) / J.col(i).squaredNorm();
    robot.ddq_p[i] += state.share * (state.found[i] + bent);
  }
}

}  // namespace hg::estimation
