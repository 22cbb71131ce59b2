/// The subcommands of hapticgiant-offline, with the descriptions that hapticgiant shows of them.
#pragma once

#include <string>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/offline_commands.h"

namespace hg::apps {

inline Command add_offline(Command app, const char* name) {
  return app.add_subcommand(name, std::string(offline_description(name)));
}

}  // namespace hg::apps
