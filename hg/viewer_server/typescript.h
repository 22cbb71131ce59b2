/// The types of all messages in TypeScript: the text of viewer/src/messages.ts.
#pragma once

#include <string>

namespace hg::viewer_server {

std::string typescript_text();

}  // namespace hg::viewer_server
