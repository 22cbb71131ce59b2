/// Exempts a section of a real-time thread from the rule not to block, for loops without a clock.
#pragma once

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#define HG_HAS_REALTIME_SANITIZER 1
#include <sanitizer/rtsan_interface.h>
#endif
#endif

namespace hg {

/// Disables RealtimeSanitizer on this thread for its lifetime.
class AllowedToWait {
#ifdef HG_HAS_REALTIME_SANITIZER
  __rtsan::ScopedDisabler disabler_;
#else
 public:
  AllowedToWait() noexcept {}  // not trivial: avoids the warning of an unused variable
#endif
};

}  // namespace hg
