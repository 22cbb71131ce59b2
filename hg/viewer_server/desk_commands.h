/// Commands that need no answer of the program: the server's thread passes them directly to the
/// operator's desk, so that they never wait for the program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/commands.h"

namespace hg::viewer_server {

/// Returns no value when the program has to answer `command`: it is of another kind, or not among
/// those `followed`. Else it was executed (empty text) or refused, with the reason. A stop of the
/// run is executed at once, and the program answers.
std::optional<std::string> obey_at_desk(const Command& command,
                                        const std::vector<CommandName>& followed,
                                        std::int64_t now_ns, OperatorDesk& desk);

}  // namespace hg::viewer_server
