/// Messages between program and page, of hg/viewer_server/ and hg/signals/, for
/// viewer/src/messages.ts.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hg::pages {

/// Per message its name, note, and rows of field, TypeScript type and note.
nlohmann::ordered_json message_facts();

}  // namespace hg::pages
