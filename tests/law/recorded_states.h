/// Recorded controller states of tests/reference: what went in, what came out.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hg/controller/rendering/rendering.h"
#include "hg/hqp/problem.h"

namespace hg {

/// One recording, see tests/reference/README.md. Conversions throw when a field is missing.
struct Recording {
  nlohmann::json header;
  std::vector<nlohmann::json> states;
  std::vector<hqp::Problem> problems;          ///< of the states
  std::vector<std::vector<double>> solutions;  ///< x, then the squared slack of each level
  std::vector<bool> is_skipped;                ///< too ill-conditioned to compare solutions
};

/// HG_REFERENCE_DATA, or tests/reference.
std::filesystem::path reference_folder();
/// NAME of every NAME.states.jsonl.gz.
std::vector<std::string> recording_names();
Recording read_recording(const std::string& name);

/// Numbers of a JSON array, "inf" and "-inf" included.
Eigen::VectorXd vector_of(const nlohmann::json& array);

/// Device, twin and options that the header describes. Degrees of freedom in `locked` have a lock
/// at zero that holds always.
DeviceModel recorded_device(const Recording& recording);
rendering::TwinModel recorded_twin(const Recording& recording, const std::vector<int>& locked);
rendering::RenderingOptions recorded_options(const Recording& recording);

}  // namespace hg
