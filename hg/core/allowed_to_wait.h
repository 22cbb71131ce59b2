/// Where a thread that otherwise must not wait may: a loop that nothing keeps time for.
#pragma once

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#define HG_HAS_REALTIME_SANITIZER 1
#include <sanitizer/rtsan_interface.h>
#endif
#endif

namespace hg {

/// While it lives, RealtimeSanitizer does not look at this thread.
class AllowedToWait {
#ifdef HG_HAS_REALTIME_SANITIZER
  __rtsan::ScopedDisabler disabler_;
#else
 public:
  AllowedToWait() noexcept {}  // not trivial: it is no unused variable
#endif
};

}  // namespace hg
