/// `hapticgiant bridge NAME`: runs the bridge to another world of tools, a program of its own.
#pragma once

namespace hg::apps {

class Command;

void add_bridge(Command app);

}  // namespace hg::apps
