#include "hg/config/bus/machine_file.h"

#include <algorithm>

#include "hg/config/bus/machine_schema.h"
#include "hg/config/loader.h"

namespace hg::config {
namespace {

bool has_equal_names(const std::vector<ethercat::Slave>& slaves) {
  std::vector<std::string> names;
  for (const ethercat::Slave& slave : slaves) names.push_back(slave.name);
  std::ranges::sort(names);
  return std::ranges::adjacent_find(names) != names.end();
}

// Names of joints that no drive, or more than one, moves.
void check_joints(Loader& loader, const ethercat::Machine& machine,
                  const std::vector<std::string>& joints) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto drives =
        std::ranges::count(machine.slaves, static_cast<int>(i), &ethercat::Slave::joint);
    loader.rule(drives == 1, "slaves", "joint '" + joints[i] + "' must have one drive",
                std::to_string(drives));
  }
}

}  // namespace

ethercat::Machine load_machine(const std::filesystem::path& path, SourceReader& reader,
                               const std::vector<std::string>& joints) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  file.knows_names = !joints.empty();
  ethercat::Machine machine;
  load_file(file, [&](Loader& loader) {
    describe(loader, machine, joints);
    if (file.faults.count() > 0) return;
    loader.rule(!machine.slaves.empty(), "slaves", "must not be empty");
    loader.rule(!has_equal_names(machine.slaves), "slaves", "two slaves have the same name");
    check_joints(loader, machine, joints);
  });
  return machine;
}

}  // namespace hg::config
