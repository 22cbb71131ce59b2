/// Ctrl-C and other termination signals of the system.
#pragma once

#include <atomic>

namespace hg::apps {

/// Installs signal handlers; the flag becomes true after SIGINT, SIGTERM, SIGQUIT or SIGHUP (but
/// not under nohup). SIGPIPE, SIGUSR1 and SIGUSR2 are ignored: a run continues when the reader of
/// its output closes.
const std::atomic<bool>& watch_interruption();

/// Whether such a signal has arrived; false if no handler is installed.
bool was_interrupted() noexcept;

}  // namespace hg::apps
