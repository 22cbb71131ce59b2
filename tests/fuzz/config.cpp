#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/file_kind.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/tool.h"
#include "hg/config/twin.h"
#include "hg/core/error.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

namespace fs = std::filesystem;

// Everything that ships, so that an input may refer to it. Run from the source folder.
const std::vector<config::SourceText>& shipped() {
  static const std::vector<config::SourceText> texts = [] {
    std::vector<config::SourceText> found;
    for (const auto& entry : fs::recursive_directory_iterator("models")) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      found.push_back({entry.path().string(),
                       {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}});
    }
    return found;
  }();
  return texts;
}

// the input stands where a file of its kind does
const char* place_of(unsigned kind) {
  constexpr const char* kPlaces[] = {"models/haptic_giant/input.yaml",
                                     "models/twins/door/input.yaml", "models/scenarios/input.yaml",
                                     "models/tools/input.yaml"};
  return kPlaces[kind % 4];
}

void load(unsigned kind, std::vector<config::SourceText> sources) {
  const std::string file = place_of(kind);
  if (kind % 4 == 2) {
    config::load_scenario(std::move(sources));  // the first of them
    return;
  }
  config::SourceReader reader(std::move(sources));
  if (kind % 4 == 0) config::load_simulated_device(file, reader);
  if (kind % 4 == 1) config::load_twin(file, reader);
  if (kind % 4 == 3) config::load_tool(file, reader);
  config::kind_of(file, reader);
}

}  // namespace

void config(Bytes bytes) {
  if (bytes.empty()) return;
  const unsigned kind = bytes[0];
  std::vector<config::SourceText> sources = {{place_of(kind), {bytes.begin() + 1, bytes.end()}}};
  sources.insert(sources.end(), shipped().begin(), shipped().end());
  try {
    load(kind, std::move(sources));
  } catch (const SetupError& error) {
    if (*error.what() != '\0') return;
    std::fputs("an error without a text\n", stderr);
    std::abort();
  }
}

}  // namespace hg::fuzz
