#include "hg/config/file_kind.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "hg/config/loader.h"

namespace hg::config {
namespace {

// Keys of the top map that no other kind has; the first one is required.
struct Signature {
  FileKind kind;
  std::vector<std::string> keys;
};

const std::array<Signature, 7>& signatures() {
  static const std::array<Signature, 7> kAll = {{
      {FileKind::kDevice,
       {"manipulator", "gantry", "flange", "kinematics", "rate_Hz", "virtual_joints",
        "cartesian_limits", "drive", "synchronisation", "prepositioning", "estimation", "monitor",
        "sanitiser"}},
      {FileKind::kTwin,
       {"end_effector", "placement", "free_body", "gravity", "floating_root", "locks"}},
      {FileKind::kScenario, {"twin", "device", "person", "title", "description", "events"}},
      {FileKind::kScript, {"segments", "frame", "hand", "walk", "grasp_s"}},
      {FileKind::kTool, {"mass_kg", "centre_of_mass_m", "inertia_kg_m2", "dead_man"}},
      {FileKind::kSimulation,
       {"sensors", "seed", "step_s", "factors", "safety", "end_stops", "gear_ratio", "flexible"}},
      {FileKind::kMachine, {"slaves", "watchdog_s", "answer_s", "moves_with_frames"}},
  }};
  return kAll;
}

std::string no_kind(const std::vector<std::string>& given) {
  std::string message = "is no kind of file that is known: a ";
  std::vector<std::string> first_keys;
  for (const Signature& signature : signatures()) {
    if (!first_keys.empty()) message += ", a ";
    (message += to_string(signature.kind)) += " has the key '" + signature.keys.front() + "'";
    first_keys.push_back(signature.keys.front());
  }
  message += "; here are ";
  if (given.empty()) return message + "no keys";
  for (std::size_t i = 0; i < std::min<std::size_t>(given.size(), 5); ++i) {
    (message += i > 0 ? ", '" : "'") += given[i] + "'";
  }
  return message;
}

}  // namespace

std::string_view to_string(FileKind kind) noexcept {
  switch (kind) {
    case FileKind::kDevice:
      return "device";
    case FileKind::kTwin:
      return "twin";
    case FileKind::kScenario:
      return "scenario";
    case FileKind::kScript:
      return "script";
    case FileKind::kTool:
      return "tool";
    case FileKind::kSimulation:
      return "simulation";
    case FileKind::kMachine:
      return "machine";
  }
  return "";
}

FileKind kind_of(const std::filesystem::path& path, SourceReader& reader) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  const std::vector<std::string> given = read_keys(file);
  FileKind best = FileKind::kDevice;
  std::ptrdiff_t most = 0;
  for (const Signature& signature : signatures()) {
    const auto hits = std::ranges::count_if(given, [&](const std::string& key) {
      return std::ranges::find(signature.keys, key) != signature.keys.end();
    });
    if (hits > most) {
      most = hits;
      best = signature.kind;
    }
  }
  if (most == 0) {
    file.faults.add({}, "", no_kind(given));
    file.faults.throw_if_any();
  }
  return best;
}

}  // namespace hg::config
