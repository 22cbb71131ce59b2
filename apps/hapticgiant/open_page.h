/// How a page is presented on a terminal.
#pragma once

#include <string>

namespace hg::apps {

/// Path of the built page; empty when it is not built, after printing how to get it.
std::string find_page();

/// Prints the page's URL and who can reach it, and opens it if there is a display and an
/// interactive terminal.
void present_page(const std::string& url, const std::string& address, bool opens_browser);

}  // namespace hg::apps
