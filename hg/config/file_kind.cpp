#include "hg/config/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "hg/core/input_fault.h"

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

std::ptrdiff_t hits_of(const Signature& signature, const std::vector<std::string>& given) {
  return std::ranges::count_if(given, [&](const std::string& key) {
    return std::ranges::find(signature.keys, key) != signature.keys.end();
  });
}

// What a file is instead of the kind that is wanted; empty: it may be of this kind.
std::string what_it_is(FileKind wanted, const std::filesystem::path& path, SourceReader reader) {
  const std::string name = path.generic_string();
  const std::string text = reader.read(path);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '<') {
    const bool is_made_of_it = wanted == FileKind::kDevice || wanted == FileKind::kTwin;
    return fmt::format(
        "is a URDF, expected a {0} file{1}", to_string(wanted),
        is_made_of_it ? fmt::format("; 'hapticgiant new {} {}' makes one", to_string(wanted), name)
                      : "");
  }
  LoaderFile file = {path, reader, Faults(name)};
  const std::vector<std::string> given = read_keys(file);
  const auto of_wanted = std::ranges::find(signatures(), wanted, &Signature::kind);
  if (hits_of(*of_wanted, given) > 0) return "";
  for (const Signature& other : signatures()) {
    const bool has_first = std::ranges::find(given, other.keys.front()) != given.end();
    if (!has_first && hits_of(other, given) < 2) continue;
    return fmt::format("is a {} file, expected a {} file", to_string(other.kind),
                       to_string(wanted));
  }
  return "";
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
    const std::ptrdiff_t hits = hits_of(signature, given);
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

void load_file_of_kind(FileKind wanted, LoaderFile& file,
                       const std::function<void(Loader&)>& read) {
  try {
    load_file(file, read);
  } catch (const InputError&) {
    std::string other;
    try {
      other = what_it_is(wanted, file.path, file.sources);
    } catch (const InputError&) {  // its own faults say more
    }
    if (other.empty()) throw;
    throw InputError(InputFault{.file = file.path.generic_string(), .what = other});
  }
}

}  // namespace hg::config
