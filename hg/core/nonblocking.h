/// Marks what the control thread calls: no allocation, lock, system call or exception inside.
///
/// `make rtsan` builds with RealtimeSanitizer of clang, which ends the program when a marked
/// function does one of these, however deep. Other compilers ignore the mark. Stands behind
/// noexcept.
#pragma once

#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define HG_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef HG_NONBLOCKING
#define HG_NONBLOCKING
#endif
