/// Ctrl-C and other requests of the system to come to an end.
#pragma once

#include <atomic>

namespace hg::apps {

/// From now on true once SIGINT, SIGTERM, SIGQUIT or SIGHUP (but not under nohup) has come.
/// SIGPIPE, SIGUSR1 and SIGUSR2 are ignored: a run goes on when the reader of its output goes.
const std::atomic<bool>& watch_interruption();

/// Whether that is so; false where nothing is watched.
bool was_interrupted() noexcept;

}  // namespace hg::apps
