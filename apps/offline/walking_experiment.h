/// `hapticgiant experiment walking`.
#pragma once

#include "apps/command_line/command.h"

namespace hg::apps {

void add_walking(Command experiment, int& exit_code);

}  // namespace hg::apps
