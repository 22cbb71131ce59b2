#include "hg/signals/operator_desk.h"

#include "hg/core/index.h"

namespace hg {

void OperatorDesk::press_stop(std::uint64_t page) {
  bits_.fetch_or(kStop | kUnseenStop);
  stops_.fetch_add(1);
  pressed_by_.insert(page);
}

bool OperatorDesk::release_stop(std::uint64_t page) {
  if (page == kScript) {
    if (!is_script_stop_.load()) return false;
    script_releases_.fetch_add(1);
    return true;
  }
  if (pressed_by_.erase(page) == 0) return false;
  if (pressed_by_.empty()) bits_.fetch_and(~kStop);
  return true;
}

std::vector<std::uint64_t> OperatorDesk::stop_pressed_by() const {
  std::vector<std::uint64_t> pages(pressed_by_.begin(), pressed_by_.end());
  if (is_script_stop_.load()) pages.insert(pages.begin(), kScript);
  return pages;
}

std::uint64_t OperatorDesk::set(Input input, std::uint64_t page, bool is_on,
                                std::int64_t now_ns) noexcept {
  const std::size_t i = index(input);
  if (!is_on) {
    // switch off before marking as taken: the control thread never sees it taken and still on
    bits_.fetch_and(~on(input));
    bits_.fetch_or(taken(input));
    if (i < kHeldInputs) stops_.fetch_add(1);
    return 0;
  }
  if (i < kHeldInputs) {
    const bool is_held = (bits_.load() & on(input)) != 0 && !is_silent(i, now_ns);
    if (is_held && owner_[i] != page) return owner_[i];
    owner_[i] = page;
    heard_ns_[i].store(now_ns);
  }
  bits_.fetch_or(taken(input) | on(input));
  return 0;
}

void OperatorDesk::hear(std::uint64_t page, std::int64_t now_ns) noexcept {
  for (std::size_t i = 0; i < kHeldInputs; ++i) {
    if (owner_[i] == page && !is_silent(i, now_ns)) heard_ns_[i].store(now_ns);
  }
}

void OperatorDesk::leave(std::uint64_t page) noexcept {
  for (std::size_t i = 0; i < kHeldInputs; ++i) {
    if (owner_[i] == page) release(i);
  }
}

void OperatorDesk::ask_to_hold() noexcept {
  holds_.fetch_add(1);
  stops_.fetch_add(1);
}

void OperatorDesk::ask_to_end() noexcept {
  end_was_asked_.store(true);
  stops_.fetch_add(1);
}

void OperatorDesk::open() noexcept {
  bits_.fetch_and(kStop);
  end_was_asked_.store(false);
  is_script_stop_.store(false);
  is_clutch_open_.store(false);
  is_open_.store(true);
}

void OperatorDesk::look(std::int64_t now_ns, SafetyPanel& panel) noexcept {
  for (std::size_t i = 0; i < kHeldInputs; ++i) {
    if (is_silent(i, now_ns)) release(i);
  }
  const std::uint32_t bits = bits_.fetch_and(~kUnseenStop);
  const auto is = [bits](std::uint32_t bit) { return (bits & bit) != 0; };
  const auto is_taken = [&](Input input) { return is(taken(input)); };
  if (is(kStop) || is(kUnseenStop)) panel.emergency_stop = true;
  if (is_taken(Input::kOperatorEnable) && !is(on(Input::kOperatorEnable))) {
    panel.operator_enable = false;
  }
  if (is_taken(Input::kOverrideKey)) panel.override_key = is(on(Input::kOverrideKey));
  if (is_taken(Input::kPersonInField)) panel.person_in_field = is(on(Input::kPersonInField));
}

// Counts a stop only if the input was on.
void OperatorDesk::release(std::size_t input) noexcept {
  const std::uint32_t is_on = on(static_cast<Input>(input));
  if ((bits_.load() & is_on) == 0 || (bits_.fetch_and(~is_on) & is_on) == 0) return;
  stops_.fetch_add(1);
  lost_.fetch_or(1u << input);
}

}  // namespace hg
