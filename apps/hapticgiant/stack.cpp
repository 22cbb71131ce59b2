#include "apps/hapticgiant/stack.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>

namespace hg::apps {
namespace {

constexpr rlim_t kUsual = 8 << 20;  // bytes
constexpr rlim_t kLeast = 2 << 20;  // the control thread alone touches 512 KiB at its start

}  // namespace

std::string provide_stack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0) return {};
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kLeast) return {};
  limit.rlim_cur = std::min(kUsual, limit.rlim_max);
  if (limit.rlim_cur < kLeast || setrlimit(RLIMIT_STACK, &limit) != 0) {
    return fmt::format("stack: needs {} kB, allowed are {} kB; ulimit -s {} allows more",
                       kLeast >> 10U, limit.rlim_cur >> 10U, kUsual >> 10U);
  }
  // that of new threads was fixed when the program was loaded
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, limit.rlim_cur);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  return {};
}

}  // namespace hg::apps
