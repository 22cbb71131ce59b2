/// The built page on the disk.
#pragma once

#include <string>

namespace hg::page {

/// Folder of the built page, whether it is there or not.
std::string page_folder();

/// The same if it is there; else empty.
std::string built_page();

/// Message where it is not built.
inline constexpr char kNoPage[] =
    "not built, running without it; with node 18 or newer:\n"
    "            cd viewer && npm ci && npm run build";

}  // namespace hg::page
