#include "hg/viewer_server/desk_commands.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace hg::viewer_server {
namespace {

constexpr std::string_view kOver = "the run is over: start it again";

struct NamedInput {
  std::string_view name;
  OperatorDesk::Input input;
};
constexpr NamedInput kInputs[] = {{"operator_enable", OperatorDesk::Input::kOperatorEnable},
                                  {"override_key", OperatorDesk::Input::kOverrideKey},
                                  {"person_in_field", OperatorDesk::Input::kPersonInField}};

std::string obey_panel(const Command& command, std::int64_t now_ns, OperatorDesk& desk) {
  const auto named = std::find_if(std::begin(kInputs), std::end(kInputs),
                                  [&](const auto& i) { return i.name == command.argument; });
  if (named == std::end(kInputs)) return "there is no such switch: " + command.argument;
  if (command.value != 0.0 && command.value != 1.0) return "a switch is 0 (off) or 1 (on)";
  // switching off counts between runs as well: it overtakes a run that is being prepared
  if (!desk.is_open() && command.value != 0.0) return std::string(kOver);
  const std::uint64_t holder = desk.set(named->input, command.page, command.value != 0.0, now_ns);
  return holder == 0 ? "" : "page " + std::to_string(holder) + " holds it";
}

std::string release(const Command& command, OperatorDesk& desk) {
  const bool is_page = command.value >= 0.0 && command.value <= kLargestPage &&
                       command.value == std::floor(command.value);
  if (!is_page) return "a stop is released by the number of its page, 0 for the script";
  const auto page = static_cast<std::uint64_t>(command.value);
  if (desk.release_stop(page)) return {};
  return (page == OperatorDesk::kScript ? "the script" : "page " + std::to_string(page)) +
         " does not press it";
}

std::string set_clutch(const Command& command, OperatorDesk& desk) {
  if (command.value != 0.0 && command.value != 1.0) return "the clutch is 0 (closed) or 1 (open)";
  if (!desk.is_open()) return std::string(kOver);
  desk.set_clutch(command.value != 0.0);
  return {};
}

}  // namespace

std::optional<std::string> obey_at_desk(const Command& command,
                                        const std::vector<CommandName>& followed,
                                        std::int64_t now_ns, OperatorDesk& desk) {
  if (std::ranges::find(followed, command.name) == followed.end()) return {};
  switch (command.name) {
    case CommandName::kEmergencyStop:
      desk.press_stop(command.page);
      return "";
    case CommandName::kReleaseStop:
      return release(command, desk);
    case CommandName::kPanel:
      return obey_panel(command, now_ns, desk);
    case CommandName::kClutch:
      return set_clutch(command, desk);
    case CommandName::kMode:
      if (command.argument != "hold") return {};
      desk.ask_to_hold();
      return "";
    case CommandName::kStop:
      desk.ask_to_end();
      return {};
    default:
      return {};
  }
}

}  // namespace hg::viewer_server
