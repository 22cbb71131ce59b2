/// How the bridge finds a running program.
#pragma once

#include <string>

namespace hapticgiant {

/// Address of a program and its secret.
struct Link {
  std::string host, port, token;
};

/// Reads "ws://HOST:PORT/live?token=TOKEN" or the link of the page,
/// "http://HOST:PORT/#token=TOKEN". Throws std::runtime_error that says what was expected.
Link parse_link(const std::string& text);

/// The newest run of this user on this computer: each run leaves its address in the file PID.live
/// in $XDG_RUNTIME_DIR/hapticgiant, without that variable in /tmp/hapticgiant-UID. Throws
/// std::runtime_error when there is none, or when others could have written there.
Link newest_link();

}  // namespace hapticgiant
