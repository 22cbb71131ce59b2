#include "apps/hapticgiant/new_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/paths.h"
#include "hg/commissioning/generator/scaffold.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

fs::path output_of(const NewArguments& arguments, const char* kind) {
  const fs::path output = arguments.output.empty()
                              ? arguments.part.urdf.stem().string() + "_" + kind + ".yaml"
                              : arguments.output;
  std::error_code error;
  if (fs::exists(output, error) && !arguments.may_overwrite) {
    throw SetupError(output.string() +
                     ": exists already; --force overwrites it, -o FILE writes another file");
  }
  return output;
}

}  // namespace

int new_device(const NewArguments& arguments) {
  const fs::path output = output_of(arguments, "device");
  check_writable(output.string());
  write_output(output.string(), generator::device_yaml(arguments.part, output.parent_path()));
  print_out(
      "{0} written. Next:\n"
      "  hapticgiant check {0}\n"
      "  hapticgiant new twin TWIN.urdf --device {0}\n",
      output.string());
  return 0;
}

int new_twin(const NewArguments& arguments) {
  const fs::path output = output_of(arguments, "twin");
  const bool is_own = !arguments.device.empty();
  const config::Device device = config::load_device(
      is_own ? fs::path(arguments.device) : models_root() / "models/haptic_giant/device.yaml");
  check_writable(output.string());
  write_output(output.string(), generator::twin_yaml(arguments.part, output.parent_path(), device));
  const std::string with = is_own ? " --device " + arguments.device : "";
  print_out(
      "{0} written. Next:\n"
      "  hapticgiant check {2}{0}\n"
      "  hapticgiant run{1} --twin {0}\n",
      output.string(), with, is_own ? arguments.device + " " : "");
  return 0;
}

}  // namespace hg::apps
