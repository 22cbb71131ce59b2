/// What all clients of the live interface see: parameters, latched messages, assets.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/live/channels.h"
#include "hg/live/frame.h"

namespace hg::live {

/// A setting of the run that clients may change.
struct Parameter {
  std::string name, unit;
  double value = 0.0;           ///< infinite: unlimited
  double min = 0.0, max = 0.0;  ///< accepted range
};

struct Board {
  std::string session;  ///< name of this start of the program
  std::vector<Parameter> parameters;
  std::array<std::optional<Message>, kTopicCount> latched;  ///< by channel
  /// Content of an asset; null = there is none of this name.
  std::function<Bytes(std::string_view name)> find_asset;

  /// Null: there is none of this name.
  const Parameter* find_parameter(std::string_view name) const {
    for (const Parameter& parameter : parameters) {
      if (parameter.name == name) return &parameter;
    }
    return nullptr;
  }
};

}  // namespace hg::live
