/// `hapticgiant experiment remote`.
#pragma once

#include "apps/command_line/command.h"

namespace hg::apps {

void add_remote_operation(Command experiment, int& exit_code);

}  // namespace hg::apps
