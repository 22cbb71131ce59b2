#include "hg/config/twin_form.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "hg/config/twin.h"
#include "hg/controller/rendering/twin_parameters.h"

namespace hg::config {
namespace {

const char* const kTwins[] = {"models/twins/door/twin.yaml", "models/twins/excavator/twin.yaml",
                              "models/twins/free_space/twin.yaml"};

const FormField& find(const std::vector<FormField>& form, std::string_view name) {
  for (const FormField& field : form) {
    if (field.name == name) return field;
  }
  throw std::runtime_error("no field " + std::string(name));
}

std::vector<double> values_of(const std::vector<FormField>& form) {
  std::vector<double> values;
  for (const FormField& field : form) values.push_back(field.value);
  return values;
}

TEST(TwinForm, HasTheValuesOfTheFileAndTheWordsOfTheReferencePage) {
  const Twin door = load_twin(kTwins[0]);
  const std::vector<FormField> form = twin_form(door.model);
  const FormField& damping = find(form, "hinge.damping_Nms_per_rad");
  EXPECT_EQ(damping.group, "hinge");
  EXPECT_EQ(damping.label, "damping");
  EXPECT_EQ(damping.unit, "Nms/rad");
  EXPECT_EQ(damping.help, "viscous");
  EXPECT_EQ(damping.value, door.model.dofs[0].damping);
  EXPECT_EQ(damping.min, 0.0);
  EXPECT_EQ(find(form, "hinge.q_max_rad").label, "highest position");
  EXPECT_EQ(find(form, "hinge.q_max_rad").value, door.model.dofs[0].limits.q_max);
  EXPECT_EQ(find(form, "reference_wrench.force_N.y").label, "force y");
  EXPECT_EQ(find(form, "mass_scale").max, 10.0);
  EXPECT_EQ(find(form, "felt_scale.torque.z").label, "felt scale, torque z");
  EXPECT_EQ(find(form, "felt_scale.torque.z").value, 1.0);
  EXPECT_EQ(find(form, "felt_scale.force.x").min, 0.1);
  EXPECT_EQ(find(form, "gravity").step, 1.0);
}

TEST(TwinForm, EveryFieldOfEveryTwinIsTakenByTheRendering) {
  for (const char* file : kTwins) {
    const Twin twin = load_twin(file);
    const std::vector<FormField> form = twin_form(twin.model);
    std::set<std::string> names;
    for (const FormField& field : form) {
      SCOPED_TRACE(std::string(file) + " " + field.name);
      EXPECT_TRUE(names.insert(field.name).second);
      EXPECT_LT(field.min, field.max);
      EXPECT_GT(field.step, 0.0);
      EXPECT_FALSE(field.help.empty());
      if (std::isfinite(field.value)) {
        EXPECT_GE(field.value, field.min);
        EXPECT_LE(field.value, field.max);
      }
      for (const double value : {field.min, field.max}) {
        if (!refusal(form, field_of(form, field.changes.front()), value, values_of(form)).empty()) {
          continue;
        }
        rendering::TwinParameters parameters = rendering::initial_parameters(twin.model);
        for (ParameterChange change : field.changes) {
          change.value = value;
          EXPECT_EQ(rendering::apply(twin.model, change, parameters), ChangeStatus::kTaken)
              << value;
        }
      }
    }
  }
}

TEST(TwinForm, AFloatingJointChangesThreeDirectionsAtOnce) {
  const Twin body = load_twin(kTwins[2]);
  const std::vector<FormField> form = twin_form(body.model);
  const FormField& field = find(form, "root.damping_Ns_per_m");
  ASSERT_EQ(field.changes.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(field.changes[i].index, i);
}

TEST(TwinForm, RefusesWhatIsOutOfRangeNotANumberOrCrosses) {
  const Twin door = load_twin(kTwins[0]);
  const std::vector<FormField> form = twin_form(door.model);
  const std::vector<double> values = values_of(form);
  const auto refusal_of = [&](std::string_view name, double value) {
    return refusal(form, field_of(form, find(form, name).changes.front()), value, values);
  };
  EXPECT_EQ(refusal_of("hinge.damping_Nms_per_rad", 1.0), "");
  EXPECT_NE(refusal_of("hinge.damping_Nms_per_rad", -1.0).find("must be 0 .. "), std::string::npos);
  EXPECT_NE(refusal_of("hinge.damping_Nms_per_rad", std::nan("")), "");
  EXPECT_NE(refusal_of("hinge.damping_Nms_per_rad", 1e6), "");
  EXPECT_NE(refusal_of("mass_scale", 11.0), "");
  EXPECT_NE(refusal_of("felt_scale.force.y", 0.05), "");
  EXPECT_NE(refusal_of("hinge.q_max_rad", -0.5).find("cross"), std::string::npos);
  EXPECT_NE(refusal_of("hinge.q_min_rad", 2.5).find("cross"), std::string::npos);
}

}  // namespace
}  // namespace hg::config
