#include "apps/hapticgiant/experiments/paper_experiments.h"

#include <array>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::apps {
namespace {

// Segments of models/scripts; 0.5 s more where the spring of the hand stretches first.
constexpr EventWindow kCartesian[] = {
    {"t_a", 1.0, 15.0, "the hand walks 1.15 turns of a circle of 0.9 m"},
    {"t_b", 16.0, 19.5, "the hand walks back in +x with the elbow on that side"},
    {"t_b'", 19.0, 21.5, "the hand turns and reaches on in +x"},
    {"t_c", 24.3, 26.2, "the handle is pitched down"},
    {"t_d", 27.5, 30.0, "the handle is rolled"},
    {"t_e", 32.2, 35.4, "the handle is raised"},
    {"t_f", 37.6, 45.6, "the hand walks in +y"},
    {"t_g", 37.6, 46.0, "the hand walks on in +y"},
};
constexpr EventWindow kExcavator[] = {
    {"boom", 1.0, 2.7, "the bucket is pushed out and down"},
    {"t_a", 2.5, 4.8, "the bucket is pulled in, down and curled"},
    {"t_b", 5.6, 9.2, "the arm reaches out"},
    {"t_c", 11.6, 15.0, "the arm is swung to the right"},
    {"t_d", 15.0, 20.8, "the arm is swung to the left"},
    {"t_e", 24.0, 27.7, "the bucket digs"},
    {"unload", 29.8, 31.6, "the bucket is emptied"},
};
constexpr EventWindow kDoor[] = {
    {"locked", 1.0, 4.0, "the hand pushes and pulls without pressing the lever"},
    {"handle pressed", 4.5, 5.3, "the hand presses the lever"},
    {"pulled", 5.0, 6.6, "the hand presses the lever and pulls"},
    {"locked again", 6.6, 7.5, "the hand lets go of the lever"},
    {"unlocked", 8.0, 8.9, "the hand leans against the door and presses the lever"},
    {"open stop", 8.6, 11.2, "the hand walks through"},
    {"velocity limit", 11.2, 12.5, "the hand has let go"},
    {"closed and locked", 11.2, 14.0, "the door falls shut"},
};

constexpr std::array<PaperExperiment, 4> kExperiments = {{
    {"cartesian", "free_space", "Cartesian admittance", "Fig. 6, section VII-A",
     "A rigid body of 6 kg floats freely in six degrees of freedom. A scripted hand walks it "
     "through "
     "the workspace until, one after the other, the limits of the device are felt.",
     kCartesian,
     "The paper's run is one expert's, on the machine; ours is a scripted hand on a simulated one, "
     "so "
     "times and forces of the two cannot be compared, events and their order can. The paper sees "
     "raised forces wherever the gantry moves far, because its drives do not compensate its "
     "dynamics; our simulated gantry (40 ms lag, 2.5 m/s^2) does not push back at the handle, so "
     "this does not show here."},
    {"excavator", "excavator", "Excavator", "Fig. 8, section VII-B",
     "The hand holds the bucket of an excavator with four joints (swing, boom, stick, bucket), "
     "whose "
     "limits are met one after the other.",
     kExcavator,
     "Geometry and masses of the paper's excavator are not published: ours are assumed, and so are "
     "its limits. What can be compared is what happens: at t_a the bucket ends while the boom is "
     "at "
     "its end, and the stick has to take over at once."},
    {"door", "door", "Door", "Fig. 9, section VII-C",
     "A door with a lever, a bolt and a closer. It resists while it is locked, opens once the "
     "lever "
     "is pressed while it is pushed, and falls shut.",
     kDoor,
     "Inertias, springs and the closer of the paper's door are not published: ours are assumed. "
     "The "
     "paper lets it slam; ours closes at the speed of its closer as well."},
    {"path",
     "path",
     "Path following",
     "Section VII-D (the path task)",
     "A person walks a free body of 6 kg along six checkpoints that are spread over the workspace "
     "and "
     "force turns.",
     {},
     "The paper asks 20 people how they liked it (NASA TLX, Fig. 10); a simulated person cannot be "
     "asked. Its checkpoints are not published: ours are spread over our workspace. What is left "
     "is "
     "whether they can be reached, how fast, and what the limits do meanwhile."},
}};

}  // namespace

std::span<const PaperExperiment> paper_experiments() { return kExperiments; }

const PaperExperiment& paper_experiment(std::string_view name) {
  std::vector<std::string> names;
  for (const PaperExperiment& experiment : kExperiments) {
    if (experiment.name == name) return experiment;
    names.emplace_back(experiment.name);
  }
  const std::string wanted(name);
  throw SetupError(wanted + ": no such experiment, did you mean '" + nearest_name(wanted, names) +
                   "'?");
}

}  // namespace hg::apps
