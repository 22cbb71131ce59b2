/// Writes viewer/src/messages.ts: the types of all messages between program and page.
#pragma once

#include <string>

namespace hg::pages {

std::string typescript_text();

}  // namespace hg::pages
