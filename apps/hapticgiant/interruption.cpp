#include "apps/hapticgiant/interruption.h"

#include <csignal>

namespace hg::apps {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // written by a signal handler

void interrupt(int) { interrupted.store(true); }

}  // namespace

const std::atomic<bool>& watch_interruption() {
  interrupted.store(false);
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  std::signal(SIGQUIT, interrupt);
  if (std::signal(SIGHUP, interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
  for (const int ignored : {SIGPIPE, SIGUSR1, SIGUSR2}) std::signal(ignored, SIG_IGN);
  return interrupted;
}

bool was_interrupted() noexcept { return interrupted.load(); }

}  // namespace hg::apps
