#include "hg/recording/column_facts.h"

#include <gtest/gtest.h>

#include <memory>

namespace hg::recording {
namespace {

using Texts = std::vector<std::string>;

ColumnFacts facts(const RunParts& parts, const std::string& name) {
  const Columns columns;
  return parts.facts_of(*std::ranges::find(columns.all(), name, &Column::name));
}

RunParts door_parts() {
  return RunParts({{"gantry_joints", "turn,rail"},
                   {"gantry_units", "rad,m"},
                   {"manipulator_joints", "m1,m2"},
                   {"manipulator_units", "rad,rad"},
                   {"twin_joints", "body,slide"},
                   {"twin_units", "floating,m"}},
                  {{"00.name", "m1"}, {"00.unit", "rad"}, {"01.name", "slide"}, {"01.unit", "m"}});
}

TEST(ColumnFacts, EntriesHaveNamesAndUnitsOfTheirJoints) {
  const RunParts parts = door_parts();
  EXPECT_EQ(facts(parts, "robot.q_p").labels, (Texts{"turn", "rail"}));
  EXPECT_EQ(facts(parts, "robot.q_p").units, (Texts{"rad", "m"}));
  EXPECT_EQ(facts(parts, "robot.dq_p").units, (Texts{"rad/s", "m/s"}));
  EXPECT_EQ(facts(parts, "robot.tau_m").unit, "Nm");
  EXPECT_EQ(facts(parts, "tracking.error").unit, "rad");
  EXPECT_EQ(facts(parts, "limits.slack").units, (Texts{"rad/s^2", "m/s^2"}));
  EXPECT_EQ(facts(parts, "limits.reaction").units, (Texts{"Nm", "N"}));
  EXPECT_EQ(facts(parts, "limits.reaction").axis, "limit");
  EXPECT_EQ(facts(parts, "robot.w_h").units, (Texts{"N", "N", "N", "Nm", "Nm", "Nm"}));
  EXPECT_EQ(facts(parts, "mode").unit, "");
  EXPECT_TRUE(facts(parts, "mode").labels.empty());
}

TEST(ColumnFacts, AFloatingJointHasSevenCoordinatesAndSixVelocities) {
  const ColumnFacts q = facts(door_parts(), "twin.q_a");
  EXPECT_EQ(q.labels, (Texts{"body.x", "body.y", "body.z", "body.qx", "body.qy", "body.qz",
                             "body.qw", "slide"}));
  EXPECT_EQ(q.units, (Texts{"m", "m", "m", "", "", "", "", "m"}));
  const ColumnFacts dq = facts(door_parts(), "twin.dq_a");
  EXPECT_EQ(dq.units, (Texts{"m/s", "m/s", "m/s", "rad/s", "rad/s", "rad/s", "m/s"}));
}

TEST(ColumnFacts, WithoutMetadataUnitsAreThoseOfTheFields) {
  const ColumnFacts q = facts(RunParts(), "twin.q_a");
  EXPECT_EQ(q.unit, "rad or m");
  EXPECT_TRUE(q.labels.empty());
  EXPECT_EQ(facts(RunParts(), "time_s").unit, "s");
  EXPECT_EQ(facts(RunParts(), "sensors.inertial").unit, "m/s^2, rad/s");
  EXPECT_EQ(facts(RunParts(), "tracking.torque_share").unit, "");
}

TEST(ColumnFacts, EveryWideColumnSaysWhatItsEntriesBelongTo) {
  const Columns columns;
  for (const Column& column : columns.all()) {
    EXPECT_EQ(column.is_wide, column.axis != Axis::kNone) << column.name;
    EXPECT_EQ(RunParts().facts_of(column).axis.empty(), !column.is_wide) << column.name;
  }
}

TEST(Columns, KeepTheirWidthWhenTheyAreWrittenInParts) {
  const auto sample = std::make_unique<Sample>();
  Columns columns({"reference.q_m"});
  sample->record.reference.q_m = VectorM::Constant(3, 1.0);
  columns.append(*sample);
  columns.clear();
  EXPECT_EQ(columns.rows(), 0U);
  sample->record.reference.q_m = VectorM::Constant(1, 2.0);
  columns.append(*sample);
  const Column& column = *std::ranges::find(columns.all(), "reference.q_m", &Column::name);
  EXPECT_EQ(column.width(), 3U);
  EXPECT_EQ(padded(column, columns.rows()).size(), 3 * sizeof(double));
  Columns others({"reference.q_m"});
  others.widen(columns.all());
  EXPECT_EQ(std::ranges::find(others.all(), "reference.q_m", &Column::name)->width(), 3U);
}

}  // namespace
}  // namespace hg::recording
