/// Commands that nobody has to be asked for: the server's thread takes them to the operator's desk
/// itself, so that they never wait for the program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/commands.h"

namespace hg::viewer_server {

/// Nothing when the program has to answer `command`: it is of another kind, or not among those that
/// are `followed`. Else it has been followed (empty) or was refused, with the reason. A stop of the
/// run is done at once, and the program answers.
std::optional<std::string> obey_at_desk(const Command& command,
                                        const std::vector<CommandName>& followed,
                                        std::int64_t now_ns, OperatorDesk& desk);

}  // namespace hg::viewer_server
