#include "hg/identify/inertia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hg/identify/pseudo_inertia.h"
#include "hg/simulator/random_stream.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFactor = 1.3;
const std::string kLink = "fr3_link4";

config::SimulatedDeviceConfig arm() {
  return config::load_simulated_device("models/arms/fr3/device.yaml");
}

// The arm with one link heavier by kFactor, at the same centre and with the same inertia about it.
config::SimulatedDeviceConfig heavier_arm() {
  config::SimulatedDeviceConfig device = arm();
  for (config::SourceText& text : device.sources) {
    if (!text.name.ends_with("fr3.urdf")) continue;
    const std::string mass = "<mass value=\"";
    const std::size_t link = text.content.find("<link name=\"" + kLink + "\"");
    const std::size_t begin = text.content.find(mass, link) + mass.size();
    const std::size_t end = text.content.find('"', begin);
    const double old = std::stod(text.content.substr(begin, end - begin));
    text.content.replace(begin, end - begin, std::to_string(kFactor * old));
    device.model.chain =
        model::ChainModel::from_urdf_text(text.content, text.name, device.chain_options);
  }
  return device;
}

// All joints swing, each with two frequencies of its own, while a hand pushes.
Moment moment_at(double t) {
  Moment m = {VectorXd(7), VectorXd(7), VectorXd(7), Vector6::Zero()};
  const VectorXd middle = (VectorXd(7) << 0.0, 0.0, 0.0, -1.5, 0.0, 1.8, 0.0).finished();
  for (int i = 0; i < 7; ++i) {
    const double a = 1.7 + 0.31 * i, b = 4.1 - 0.23 * i;
    m.q[i] = middle[i] + 0.5 * std::sin(a * t) + 0.2 * std::cos(b * t);
    m.dq[i] = 0.5 * a * std::cos(a * t) - 0.2 * b * std::sin(b * t);
    m.ddq[i] = -0.5 * a * a * std::sin(a * t) - 0.2 * b * b * std::cos(b * t);
  }
  for (int i = 0; i < 6; ++i) m.wrench_S[i] = (i < 3 ? 8.0 : 0.3) * std::sin((0.9 + 0.2 * i) * t);
  return m;
}

// What the torque sensors of the truth say of that motion, or of standing still.
std::vector<JointMotion> motion(const config::SimulatedDeviceConfig& truth, double duration_s,
                                bool moves) {
  InertiaModel model(truth);
  simulator::RandomStream random(1, simulator::RandomEffect::kTorqueNoise, 0);
  JointMotion part;
  const auto n = static_cast<Eigen::Index>(duration_s * truth.model.rate_Hz);
  part.q = part.tau = part.theta = part.command = Series::Zero(n, 7);
  part.q_p = Series::Zero(n, 0);
  part.wrench_S = Series::Zero(n, 6);
  for (Eigen::Index k = 0; k < n; ++k) {
    Moment m = moment_at(moves ? static_cast<double>(k) * truth.model.dt() : 0.0);
    if (!moves) m.dq = m.ddq = VectorXd::Zero(7);
    model.update(m);
    part.q.row(k) = m.q.transpose();
    part.wrench_S.row(k) = m.wrench_S.transpose();
    const VectorXd tau = model.nominal_torques() + model.wrench_columns() * model.user_wrench();
    for (int i = 0; i < 7; ++i) part.tau(k, i) = tau[i] + 0.1 + 0.05 * random.gaussian();
  }
  part.theta = part.command = part.q;
  return {part};
}

TEST(InertiaModel, TorquesAreLinearInTheParametersOfTheLinks) {
  InertiaModel nominal(arm()), truth(heavier_arm());
  const Moment m = moment_at(0.7);
  nominal.update(m);
  truth.update(m);
  const VectorXd more = nominal.regressor() * (truth.nominal() - nominal.nominal());
  EXPECT_GT(more.norm(), 0.1);
  EXPECT_LT((truth.nominal_torques() - nominal.nominal_torques() - more).norm(), 1e-6);
}

TEST(InertiaModel, ParametersAndInertialsAreTheSame) {
  const VectorXd p = InertiaModel(arm()).nominal();
  EXPECT_LT((parameters_of(inertial_of(p.segment<10>(30))) - p.segment<10>(30)).norm(), 1e-12);
}

TEST(BaseParameters, ShowInEveryMotionAndAreNamed) {
  const config::SimulatedDeviceConfig device = arm();
  InertiaModel model(device);
  const BaseParameters base = base_parameters(model, 7, 7);
  EXPECT_EQ(base.chosen.size(), 43u) << "as published for arms of this kind";
  model.update(moment_at(1.3));
  const MatrixXd Y = model.regressor();
  EXPECT_LT((Y - Y(Eigen::all, base.chosen) * base.combination).norm(), 1e-8 * Y.norm());
  EXPECT_EQ(base.names[0], "fr3_link1 I_zz + 1 fr3_link2 I_yy");
}

TEST(IdentifyInertia, FindsALinkThatTheFilesHaveWrong) {
  const config::SimulatedDeviceConfig truth = heavier_arm();
  const InertiaEstimate found = identify_inertia(motion(truth, 25.0, true), arm());
  EXPECT_EQ(found.missing, "");
  const VectorXd p = InertiaModel(truth).nominal();
  const VectorXd base = base_parameters(InertiaModel(truth), 7, 7).combination * p;
  int covered = 0;
  for (std::size_t i = 0; i < found.base.size(); ++i) {
    const Figure& figure = found.base[i].found;
    const double away = std::abs(figure.value - base[static_cast<Eigen::Index>(i)]);
    EXPECT_LT(away, 2.5 * figure.interval()) << found.base[i].name;
    if (away < figure.interval()) ++covered;
  }
  EXPECT_GE(covered, 38);
  EXPECT_GT(found.joints[1].before, 2.0 * found.joints[1].after);
  const LinkInertia& link = found.links.at(3);
  EXPECT_EQ(link.name, kLink);
  EXPECT_LT(std::abs(link.figures[0].value - kFactor * link.nominal.mass),
            link.figures[0].interval());
  for (const LinkInertia& each : found.links)
    EXPECT_NO_THROW(check_inertial(each.found, each.name));
}

TEST(IdentifyInertia, SaysThatTheMotionShowsTooLittleOrIsTooShort) {
  const InertiaEstimate still = identify_inertia(motion(arm(), 20.0, false), arm());
  EXPECT_NE(still.missing.find("of 43 base parameters, half are needed"), std::string::npos)
      << still.missing;
  const InertiaEstimate brief = identify_inertia(motion(arm(), 5.0, true), arm());
  EXPECT_NE(brief.missing.find("s only, 15 are needed"), std::string::npos) << brief.missing;
  EXPECT_TRUE(brief.links.empty());
}

TEST(ConsistentParameters, StayThoseOfBodiesWhateverTheRecordingSays) {
  const VectorXd nominal = InertiaModel(arm()).nominal().head<10>();
  const MatrixXd C = MatrixXd::Identity(1, 10);  // the mass alone shows
  const auto found = [&](double mass, double information) {
    return consistent_parameters(VectorXd::Constant(1, mass), MatrixXd::Constant(1, 1, information),
                                 C, nominal);
  };
  EXPECT_LT((found(9.0, 1e-12).p - nominal).norm(), 1e-6) << "nothing is known: the URDF";
  EXPECT_NEAR(found(4.0, 1e8).p[0], 4.0, 1e-3);
  for (const double mass : {-3.0, 0.1, 4.0}) {
    const Eigen::Matrix4d P = pseudo_inertia(found(mass, 1e4).p);
    EXPECT_EQ(P.llt().info(), Eigen::Success) << mass;
  }
}

}  // namespace
}  // namespace hg::identify
