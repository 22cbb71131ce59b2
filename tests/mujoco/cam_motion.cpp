// What a crank needs that moves a ram by a cam, as CSV, for cam_test.py: the same in MuJoCo.
// Arguments: the URDF, repeats per turn, points "leader:follower" separated by commas. Reads lines
// "q dq ddq" of the crank, writes position, speed and acceleration of the ram and the torque of the
// crank.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "hg/model/cam.h"
#include "hg/model/chain_data.h"

namespace {

using namespace hg;

std::vector<model::CamPoint> points_of(const std::string& text) {
  std::vector<model::CamPoint> points;
  std::istringstream stream(text);
  char mark = 0;
  for (model::CamPoint p; stream >> p.leader >> mark >> p.follower; stream >> mark) {
    points.push_back(p);
  }
  return points;
}

// Throws SetupError.
void print(const std::string& urdf, int repeats, const std::string& points) {
  const double period = repeats > 0 ? 2.0 * std::numbers::pi / repeats : kInfinity;
  const model::Cam cam = model::make_cam(points_of(points), period);
  model::ChainOptions options;
  options.couplings = {{"slide", "turn", 1.0, 0.0, cam.curve}};
  model::ChainData chain(model::ChainModel::from_urdf_file(urdf, options));
  std::array<double, 3> x{};
  while (std::cin >> x[0] >> x[1] >> x[2]) {
    const auto [value, slope, curvature] = cam.curve->at(x[0]);
    const VectorA q = VectorA::Constant(1, x[0]), dq = VectorA::Constant(1, x[1]);
    const double torque = chain.inverse_dynamics(q, dq, VectorA::Constant(1, x[2]))[0];
    std::printf("%.17g,%.17g,%.17g,%.17g\n", value, slope * x[1],
                slope * x[2] + curvature * x[1] * x[1], torque);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "expected a URDF, repeats per turn, and points\n");
    return EXIT_FAILURE;
  }
  try {
    print(argv[1], std::atoi(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
