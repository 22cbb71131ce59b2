#include "hg/lab_streaming/liblsl.h"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "hg/core/error.h"

namespace hg::lab_streaming {
namespace {

// of its log: errors and worse
constexpr char kQuiet[] = "[log]\nlevel = -2\n";

// The places where liblsl looks for its configuration.
bool has_configuration() {
  std::error_code error;
  const char* home = std::getenv("HOME");
  const std::array<std::string, 3> files = {"lsl_api.cfg",
                                            std::string(home ? home : "") + "/lsl_api/lsl_api.cfg",
                                            "/etc/lsl_api/lsl_api.cfg"};
  for (const std::string& file : files) {
    if (std::filesystem::exists(file, error)) return true;
  }
  return std::getenv("LSLAPICFG") != nullptr;
}

}  // namespace

Liblsl::Liblsl(std::span<const std::string> candidates) {
  std::string tried;
  for (const std::string& candidate : candidates) {
    handle_ = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL);
    file_ = candidate;
    if (handle_ != nullptr) break;
    tried += (tried.empty() ? "" : ", ") + candidate;
  }
  if (handle_ == nullptr) {
    throw SetupError("--lsl: needs liblsl, which is in none of these: " + tried +
                     "; pip install pylsl, or name the library in PYLSL_LIB");
  }
  const auto load = [&]<typename Function>(const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(dlsym(handle_, name));
    if (function == nullptr) throw SetupError("--lsl: " + file_ + " has no " + name);
  };
  load("lsl_create_streaminfo", create_info);
  load("lsl_destroy_streaminfo", destroy_info);
  load("lsl_get_desc", get_description);
  load("lsl_append_child", append_child);
  load("lsl_append_child_value", append_value);
  load("lsl_create_outlet", create_outlet);
  load("lsl_destroy_outlet", destroy_outlet);
  load("lsl_have_consumers", has_readers);
  load("lsl_push_chunk_dtnp", push_numbers);
  load("lsl_push_sample_strtp", push_text);
  load("lsl_local_clock", local_clock);
  // from version 1.17 on
  using Configure = void(const char*);
  auto* configure = reinterpret_cast<Configure*>(dlsym(handle_, "lsl_set_config_content"));
  if (configure != nullptr && !has_configuration()) configure(kQuiet);
}

// Stays loaded: threads of the library may outlive its outlets.
Liblsl::~Liblsl() = default;

}  // namespace hg::lab_streaming
