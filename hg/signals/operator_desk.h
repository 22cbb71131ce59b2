/// What the pages of an operator do to a run at once: stops, and the switches that they hold. The
/// way from the page's server to the control loop; nobody stands in between.
///
/// Emergency stops belong to the pages that pressed them and stay when those go. Enabling switch
/// and override key belong to the page that took them: they are let go the moment it leaves, or is
/// not heard for kPatience_ns. All times are of the steady clock.
///
/// The server's thread writes and the control thread looks in every cycle: atomics only, no lock,
/// no allocation in what the control thread calls.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "hg/signals/frames.h"

namespace hg {

class OperatorDesk {
 public:
  static constexpr std::int64_t kPatience_ns = 100'000'000;

  /// Inputs of the panel that are on or off; the emergency stop is more than that.
  enum class Input : std::uint8_t { kOperatorEnable = 0, kOverrideKey = 1, kPersonInField = 2 };

  /// Who pressed a stop that no page did.
  static constexpr std::uint64_t kScript = 0;

  // The server's thread. Pages have numbers from 1 on.

  /// In force for one cycle at least, even when it is released before that.
  void press_stop(std::uint64_t page);
  /// Takes back what `page` (or kScript) has pressed. False: it has pressed nothing.
  bool release_stop(std::uint64_t page);
  /// Everybody whose stop is in force.
  std::vector<std::uint64_t> stop_pressed_by() const;

  /// One input, for `page`; from then on it follows no script except where that lets go. Returns
  /// the other page that holds it, which then stays so; 0: done.
  std::uint64_t set(Input input, std::uint64_t page, bool is_on, std::int64_t now_ns) noexcept;
  /// `page` is still there, and holds what it holds.
  void hear(std::uint64_t page, std::int64_t now_ns) noexcept;
  void leave(std::uint64_t page) noexcept;

  void ask_to_hold() noexcept;
  void ask_to_end() noexcept;

  // Any thread.

  /// False between runs: nobody looks.
  bool is_open() const noexcept { return is_open_.load(); }
  /// Counts all that stops, however it came. What was asked for before the last one is out of date.
  std::uint32_t stops() const noexcept { return stops_.load(); }
  /// Switches that were let go because their page was gone or silent, since the last call: bit i
  /// is Input i.
  std::uint32_t take_lost() noexcept { return lost_.exchange(0); }

  // The thread of a run, before and after its cycles.

  /// A run begins: no input is taken. Emergency stops stay pressed.
  void open() noexcept;
  void close() noexcept { is_open_.store(false); }

  // The control thread.

  /// Lets go of what silent pages held, and puts what pages have done into `panel`, which is as the
  /// script wants it.
  void look(std::int64_t now_ns, SafetyPanel& panel) noexcept;
  /// Tells whether the script presses the emergency stop.
  void tell_script_stop(bool is_pressed) noexcept { is_script_stop_.store(is_pressed); }
  std::uint32_t script_releases() const noexcept { return script_releases_.load(); }
  std::uint32_t holds() const noexcept { return holds_.load(); }
  bool end_was_asked() const noexcept { return end_was_asked_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kHeldInputs = 2;  // the first ones need a page that is there

  static std::uint32_t taken(Input input) noexcept { return 1u << static_cast<unsigned>(input); }
  static std::uint32_t on(Input input) noexcept { return 8u << static_cast<unsigned>(input); }
  static constexpr std::uint32_t kStop = 64u;
  static constexpr std::uint32_t kUnseenStop = 128u;  // by the control thread

  void let_go(std::size_t input) noexcept;
  bool is_silent(std::size_t input, std::int64_t now_ns) const noexcept {
    return now_ns - heard_ns_[input].load() > kPatience_ns;
  }

  std::atomic<std::uint32_t> bits_{0};  ///< of the inputs, and whether a page presses the stop
  std::array<std::atomic<std::int64_t>, kHeldInputs> heard_ns_{};  ///< of who holds it
  std::atomic<std::uint32_t> stops_{0}, holds_{0}, script_releases_{0}, lost_{0};
  std::atomic<bool> is_open_{false}, end_was_asked_{false}, is_script_stop_{false};

  // of the server's thread
  std::set<std::uint64_t> pressed_by_;
  std::array<std::uint64_t, kHeldInputs> owner_{};
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace hg
