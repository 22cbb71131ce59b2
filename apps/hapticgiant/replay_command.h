/// `hapticgiant replay`: runs the cycle of a recording again and compares, or shows it on the page,
/// alone or with another recording.
#pragma once

#include <cstdint>
#include <string>

namespace hg::apps {

class Command;

struct ReplayArguments {
  std::string file;
  std::string compare;    ///< second recording, shown through the first; empty = none
  bool has_view = false;  ///< shows the page; false = print the content and run it again
  double speed = 1.0;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;
  bool opens_browser = true;
};

/// Exit code: 0 fine, 1 the cycle now gives a different result. Throws SetupError for bad input.
int replay(const ReplayArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_replay(Command app, int& exit_code);

}  // namespace hg::apps
