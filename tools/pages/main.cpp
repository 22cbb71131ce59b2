/// hg_pages: prints what pages and files are generated from, as JSON; pages.py writes them.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/pages/configuration_facts.h"
#include "tools/pages/datagram_facts.h"
#include "tools/pages/message_facts.h"
#include "tools/pages/safety_facts.h"

int main() {
  const nlohmann::ordered_json facts = {{"configuration", hg::pages::configuration_facts()},
                                        {"datagrams", hg::pages::datagram_facts()},
                                        {"safety", hg::pages::safety_facts()},
                                        {"messages", hg::pages::message_facts()}};
  std::puts(facts.dump(1).c_str());
}
