/// Immediate inputs from the operator's web pages to a run: stops and held switches. Direct path
/// from the page server to the control loop.
///
/// An emergency stop belongs to the page that pressed it and stays pressed when the page leaves.
/// Enabling switch and override key belong to the page that took them: they are released when it
/// leaves or sends nothing for kPatience_ns. All times are of the steady clock.
///
/// The server thread writes, the control thread reads in every cycle: atomics only; no lock and no
/// allocation in the functions of the control thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "hg/signals/frames.h"

namespace hg {

/// Inputs of the operator's pages, shared by server thread and control thread.
class OperatorDesk {
 public:
  /// Longest silence of a page before its switches are released, ns.
  static constexpr std::int64_t kPatience_ns = 100'000'000;

  /// On/off inputs of the panel; the emergency stop is handled separately.
  enum class Input : std::uint8_t { kOperatorEnable = 0, kOverrideKey = 1, kPersonInField = 2 };

  /// Stands for the script in place of a page number.
  static constexpr std::uint64_t kScript = 0;

  // Server thread only. Page numbers start at 1.

  /// Presses the emergency stop for `page`; acts for at least one cycle even if released earlier.
  void press_stop(std::uint64_t page);
  /// Releases the emergency stop of `page` (or kScript). Returns false if it has pressed none.
  bool release_stop(std::uint64_t page);
  /// Pages (or kScript) whose emergency stop is active.
  std::vector<std::uint64_t> stop_pressed_by() const;

  /// Sets one input for `page`; from then on the script no longer sets it, except that it can
  /// still release the enabling switch. Returns 0 on success, else the other page that holds it.
  std::uint64_t set(Input input, std::uint64_t page, bool is_on, std::int64_t now_ns) noexcept;
  /// Reports `page` as alive: keeps its switches held.
  void hear(std::uint64_t page, std::int64_t now_ns) noexcept;
  /// Releases the switches of `page`.
  void leave(std::uint64_t page) noexcept;

  /// Opens or closes the clutch to a remote machine; it stays so when the page leaves.
  void set_clutch(bool is_open) noexcept { is_clutch_open_.store(is_open); }

  /// Requests a controlled stop of the device.
  void ask_to_hold() noexcept;
  /// Requests the end of the run.
  void ask_to_end() noexcept;

  // Any thread.

  /// Whether a run is reading the inputs; false between runs.
  bool is_open() const noexcept { return is_open_.load(); }
  /// Number of stops so far, of any kind. Requests made before the last one are obsolete.
  std::uint32_t stops() const noexcept { return stops_.load(); }
  /// Switches released since the last call because their page left or was silent: bit i is Input i.
  std::uint32_t take_lost() noexcept { return lost_.exchange(0); }

  // Thread of the run only, before and after its cycles.

  /// Starts a run: clears all inputs except pressed emergency stops.
  void open() noexcept;
  /// Ends a run.
  void close() noexcept { is_open_.store(false); }

  // Control thread only.

  /// Releases the switches of silent pages, then applies the inputs of the pages to `panel`, which
  /// holds the state set by the script.
  void look(std::int64_t now_ns, SafetyPanel& panel) noexcept;
  /// Whether a page has opened the clutch to a remote machine.
  bool is_clutch_open() const noexcept { return is_clutch_open_.load(std::memory_order_relaxed); }
  /// Reports whether the script presses the emergency stop.
  void tell_script_stop(bool is_pressed) noexcept { is_script_stop_.store(is_pressed); }
  /// Number of releases of the script's emergency stop by pages.
  std::uint32_t script_releases() const noexcept { return script_releases_.load(); }
  /// Number of calls of ask_to_hold().
  std::uint32_t holds() const noexcept { return holds_.load(); }
  /// Whether ask_to_end() was called in this run.
  bool end_was_asked() const noexcept { return end_was_asked_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kHeldInputs = 2;  // the first inputs need a live page

  static std::uint32_t taken(Input input) noexcept { return 1u << static_cast<unsigned>(input); }
  static std::uint32_t on(Input input) noexcept { return 8u << static_cast<unsigned>(input); }
  static constexpr std::uint32_t kStop = 64u;
  static constexpr std::uint32_t kUnseenStop = 128u;  // not yet read by the control thread

  void release(std::size_t input) noexcept;
  bool is_silent(std::size_t input, std::int64_t now_ns) const noexcept {
    return now_ns - heard_ns_[input].load() > kPatience_ns;
  }

  std::atomic<std::uint32_t> bits_{0};  ///< Inputs and emergency stop of the pages
  std::array<std::atomic<std::int64_t>, kHeldInputs> heard_ns_{};  ///< Last message of the holder
  std::atomic<std::uint32_t> stops_{0}, holds_{0}, script_releases_{0}, lost_{0};
  std::atomic<bool> is_open_{false}, end_was_asked_{false}, is_script_stop_{false},
      is_clutch_open_{false};

  // server thread only
  std::set<std::uint64_t> pressed_by_;
  std::array<std::uint64_t, kHeldInputs> owner_{};
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace hg
