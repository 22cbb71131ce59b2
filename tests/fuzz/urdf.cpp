#include <cstdio>
#include <cstdlib>
#include <string>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {

void urdf(Bytes bytes) {
  const std::string text(bytes.begin(), bytes.end());
  try {
    const model::Urdf urdf = model::read_urdf_text(text, "input.urdf");
    for (const model::UrdfJoint& joint : urdf.joints) {
      const auto links = static_cast<int>(urdf.links.size());
      if (joint.parent >= 0 && joint.parent < links && joint.child >= 0 && joint.child < links) {
        continue;
      }
      std::fputs("a joint without links\n", stderr);
      std::abort();
    }
    model::ChainData chain(model::ChainModel::from_urdf_text(text, "input.urdf"));
    if (chain.model().nv() > kMaxTwin) return;
    chain.update(chain.model().neutral(), VectorA::Zero(chain.model().nv()));
  } catch (const SetupError& error) {
    const std::string message = error.what();
    if (message.find("input.urdf") != std::string::npos) return;
    std::fprintf(stderr, "an error without a place: %s\n", message.c_str());
    std::abort();
  }
}

}  // namespace hg::fuzz
