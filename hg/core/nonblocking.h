/// Marks functions of the control thread: no allocation, lock, system call or exception inside.
///
/// `make rtsan` builds with RealtimeSanitizer of clang, which ends the program when a marked
/// function does one of these, at any depth. Other compilers ignore the mark. Placed after
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
