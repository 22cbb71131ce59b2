#include "hg/controller/state_hash.h"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "hg/core/fields.h"

namespace hg::controller {
namespace {

// The archive over the fields() of the states; names and notes are not part of the hash.
class Hash {
 public:
  std::uint64_t value() const noexcept { return value_; }

  template <typename T>
  void operator()(const char*, const T& value, const char* = "") noexcept {
    mix(value);
  }

  void mix(std::uint64_t word) noexcept {
    value_ = (std::rotl(value_, 5) ^ word) * 0x517cc1b727220a95ULL;
  }
  void mix(double number) noexcept { mix(std::bit_cast<std::uint64_t>(number)); }
  template <typename T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void mix(T value) noexcept { mix(static_cast<std::uint64_t>(value)); }
  template <typename Derived>
  void mix(const Eigen::PlainObjectBase<Derived>& v) noexcept {
    for (Eigen::Index i = 0; i < v.size(); ++i) mix(v.data()[i]);
  }
  void mix(const Interval& interval) noexcept {
    mix(interval.lb);
    mix(interval.ub);
  }
  template <typename T, std::size_t kSize>
  void mix(const std::array<T, kSize>& values) noexcept {
    mix_packed(values.data(), values.size());
  }
  template <HasFields T>
  void mix(const T& state) noexcept {
    fields(*this, state);
  }
  // mixes the first `count` values, packed into words
  template <typename T>
  void mix_packed(const T* values, std::size_t count) noexcept {
    constexpr std::size_t kInWord = sizeof(std::uint64_t) / sizeof(T);
    static_assert(kInWord > 1 && std::has_unique_object_representations_v<T>);
    std::uint64_t word = 0;
    std::size_t i = 0;
    for (; i + kInWord <= count; i += kInWord) {
      std::memcpy(&word, values + i, sizeof(word));
      mix(word);
    }
    if (i == count) return;
    word = 0;
    std::memcpy(&word, values + i, (count - i) * sizeof(T));
    mix(word);
  }
  template <typename First, typename Second, typename... More>
  void mix(const First& first, const Second& second, const More&... more) noexcept {
    mix(first);
    mix(second);
    (mix(more), ...);
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

// The state of the rendering is mixed by hand: of its arrays only the entries of this twin and of
// this problem count, and their numbers stand in other structs.
void mix(const rendering::TwinValues& values, std::size_t dofs, Hash& hash) noexcept {
  for (std::size_t i = 0; i < dofs; ++i) {
    const rendering::DofValues& dof = values.dofs[i];
    hash.mix(dof.stiffness, dof.rest, dof.preload, dof.damping, dof.quadratic_damping, dof.friction,
             dof.dq_max);
  }
  hash.mix(values.w_ref, values.loads.mass, values.loads.gravity);
}

void mix(const rendering::TwinInnerState& inner, std::size_t dofs, Hash& hash) noexcept {
  for (const rendering::LockState& lock : inner.locks) {
    hash.mix(std::uint64_t{lock.is_engaged} | std::uint64_t{lock.is_locked} << 1U);
    hash.mix(lock.edge);
  }
  hash.mix_packed(inner.sticks.data(), dofs);
  const rendering::TwinParameters& parameters = inner.parameters;
  mix(parameters.now, dofs, hash);
  mix(parameters.target, dofs, hash);
  for (std::size_t i = 0; i < dofs; ++i) {
    hash.mix(parameters.range[i], parameters.moving[i].q, parameters.moving[i].is_crossed);
  }
  hash.mix(parameters.holds);
  hash.mix_packed(parameters.may_be_overrun.data(), dofs);
}

void mix(const rendering::State& state, int rows, Hash& hash) noexcept {
  hash.mix(state.reference, state.twin);
  mix(state.inner, static_cast<std::size_t>(state.twin.dq_a.size()), hash);
  hash.mix_packed(state.active_set.state.data(), static_cast<std::size_t>(rows));
  hash.mix_packed(state.active_set.before.data(), static_cast<std::size_t>(rows));
  hash.mix(state.touched.lower, state.touched.upper);
  hash.mix(state.added.damping, state.added.inertia);
  hash.mix(state.contact.proxy, state.contact.is_started, state.contact.dent, state.contact.taken);
  hash.mix(state.motor_torque, state.ddq_p);
}

}  // namespace

std::uint64_t hash_of(const State& state, int rows) noexcept {
  Hash hash;
  mix(state.rendering, rows, hash);
  hash.mix(state.gantry_target, state.dq_p, state.room);
  hash.mix(std::uint64_t{state.is_blocked} |
           std::uint64_t{state.motion == Motion::kBrakeJoints} << 1U |
           std::uint64_t{state.was_on} << 2U | std::uint64_t{state.is_coasting} << 3U |
           std::uint64_t{state.is_apart} << 4U | std::uint64_t{state.was_alone} << 5U);
  hash.mix(state.force_share, state.cycle, state.next_sequence, state.supervisor, state.monitor,
           state.brakes, state.q_m, state.tau_m, state.collision, state.passivity, state.estimation,
           state.control, state.w_H);
  if (state.touch.dq.size() > 0) {  // contact detection is active
    hash.mix(state.touch, state.rendering.touch);
  }
  return hash.value();
}

}  // namespace hg::controller
