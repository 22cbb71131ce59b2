#include "hg/simulator/safety_plc.h"

#include <algorithm>
#include <cmath>

namespace hg::simulator {
namespace {

// Both channels on: initial value of an input that starts switched on
constexpr std::uint8_t kFree = 3;

int periods_of(double time, double period) noexcept {
  return static_cast<int>(std::lround(time / period));
}

}  // namespace

std::uint8_t SafetyPlc::Delay::shift(std::uint8_t value) noexcept {
  values[next] = value;
  next = (next + 1) % values.size();
  return values[next];
}

SafetyPlc::SafetyPlc(const SafetyPlcConfig& config)
    : config_(config),
      discrepancy_(periods_of(config.discrepancy, config.period)),
      stop_time_(periods_of(config.stop_time, config.period)) {
  const auto values = [&](double time) { return periods_of(time, config.period) + 1; };
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const bool is_on = i < 2;  // stop buttons and operator: initially not stopped
    inputs_[i].values.assign(values(config.response), is_on ? kFree : std::uint8_t{0});
  }
  field_.values.assign(values(config.scanner_response), 0);
}

void SafetyPlc::step(const SafetyPlcInput& input) noexcept {
  evaluate_all(input);
  if (!permit_.stop_free) trip(PlcTrip::kStopButton);
  has_disagreement_ = has_disagreement_ || differs_now_;
  watch_motion(input);
  reset(input);

  // a latched trip removes the power after the time of a controlled stop, as a switch does; power
  // returns only to drives that the program has switched off
  const bool may_have_power = permit_.has_power() && trip_ == PlcTrip::kNone && !has_disagreement_;
  no_power_ = may_have_power ? 0 : no_power_ + 1;
  if (may_have_power && !input.drives_on) has_power_ = true;
  if (no_power_ > stop_time_) has_power_ = false;

  outputs_ = {.emergency_stop = trip_ != PlcTrip::kNone && trip_ != PlcTrip::kScanner,
              .operator_enable = permit_.operator_enable,
              .override_key = permit_.override_key,
              .is_field_clear = permit_.is_field_clear && trip_ != PlcTrip::kScanner,
              .has_disagreement = has_disagreement_};
}

// On when both channels are; differing channels count as off at once and as a fault after a time.
bool SafetyPlc::evaluate(int input, TwoChannels channels, const HardwareFaults& faults) noexcept {
  if (has_bit(faults.open_channels, input)) channels.is_on[0] = false;
  if (has_bit(faults.stuck_channels, input)) channels.is_on[0] = true;
  const auto now =
      static_cast<std::uint8_t>((channels.is_on[0] ? 1 : 0) | (channels.is_on[1] ? 2 : 0));
  const std::uint8_t delayed = inputs_[input].shift(now);
  const bool differs = delayed == 1 || delayed == 2;
  differing_[input] = differs ? differing_[input] + 1 : 0;
  if (differing_[input] > discrepancy_) differs_now_ = true;
  return delayed == kFree;
}

void SafetyPlc::evaluate_all(const SafetyPlcInput& input) noexcept {
  differs_now_ = false;
  permit_.stop_free = evaluate(0, input.stop_free, input.faults);
  permit_.operator_enable = evaluate(1, input.operator_enable, input.faults);
  permit_.user_hold = evaluate(2, input.user_hold, input.faults);
  permit_.override_key = evaluate(3, input.override_key, input.faults);
  const double speed = std::max(input.hand_speed, input.gantry_speed);
  permit_.is_slow = speed <= config_.safe_speed;
  const auto field =
      static_cast<ScannerField>(field_.shift(static_cast<std::uint8_t>(input.field)));
  permit_.is_field_clear =
      field == ScannerField::kNone || (field == ScannerField::kLarge && permit_.is_slow);
}

// When autonomous motion ends because of speed or scanner, that is a trip. Any other end of the
// permission leaves the device the time to stop; then standstill is required.
void SafetyPlc::watch_motion(const SafetyPlcInput& input) noexcept {
  const double speed = std::max(input.hand_speed, input.gantry_speed);
  const bool moves = has_power_ && input.drives_on && speed > config_.standstill;
  const bool is_alone = permit_.has_power() && permit_.override_key && !permit_.user_hold;
  if (moved_alone_ && is_alone && input.drives_on) {
    if (!permit_.is_slow) trip(PlcTrip::kSafeSpeed);
    if (!permit_.is_field_clear && moves) trip(PlcTrip::kScanner);
  }
  moved_alone_ = is_alone && permit_.is_given();
  not_permitted_ = permit_.is_given() || !input.drives_on ? 0 : not_permitted_ + 1;
  if (not_permitted_ > stop_time_ && moves) trip(PlcTrip::kStandstill);
}

void SafetyPlc::trip(PlcTrip cause) noexcept {
  if (trip_ == PlcTrip::kNone) trip_ = cause;
}

void SafetyPlc::reset(const SafetyPlcInput& input) noexcept {
  const bool is_edge = input.reset && !was_reset_;
  was_reset_ = input.reset;
  const bool is_clear = trip_ != PlcTrip::kScanner || permit_.is_field_clear;
  if (!is_edge || !permit_.stop_free || differs_now_ || !is_clear) return;
  trip_ = PlcTrip::kNone;
  has_disagreement_ = false;
}

}  // namespace hg::simulator
