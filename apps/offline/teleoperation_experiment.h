/// `hapticgiant experiment teleoperation`.
#pragma once

#include "apps/command_line/command.h"

namespace hg::apps {

void add_teleoperation(Command experiment, int& exit_code);

}  // namespace hg::apps
