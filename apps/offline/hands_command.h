/// `hapticgiant experiment hands`: looks for hands that bring a device out of its limits.
#pragma once

namespace hg::apps {

class Command;

/// Adds the command; running it sets `exit_code` to 1 when a run ended in a fault or left a limit.
void add_hands(Command experiment, int& exit_code);

}  // namespace hg::apps
