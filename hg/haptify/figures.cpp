#include "hg/haptify/figures.h"

namespace hg::haptify {

const Figure* Benchmark::find(const std::string& id) const {
  for (const std::vector<Figure>* figures : {&table, &beyond}) {
    for (const Figure& figure : *figures) {
      if (figure.id == id) return &figure;
    }
  }
  return nullptr;
}

}  // namespace hg::haptify
