/// Ctrl-C and other requests of the system to come to an end.
#pragma once

#include <atomic>

namespace hg::apps {

/// From now on true once SIGINT, SIGTERM or SIGHUP (but not under nohup) has come; SIGPIPE is
/// ignored: a run goes on when the reader of its output goes.
const std::atomic<bool>& watch_interruption();

}  // namespace hg::apps
