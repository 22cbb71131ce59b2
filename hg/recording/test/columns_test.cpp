#include "hg/recording/columns.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

namespace hg::recording {
namespace {

const Column& column(const Columns& columns, const std::string& name) {
  return *std::ranges::find(columns.all(), name, &Column::name);
}

std::unique_ptr<Sample> sample_at(double time_s, int limits) {
  auto sample = std::make_unique<Sample>();
  sample->record.time_s = time_s;
  sample->record.reference.q_m = VectorM::Constant(2, time_s);
  sample->record.limit_count = limits;
  for (int i = 0; i < limits; ++i) {
    sample->record.limits[i].cause = LimitCause::kLock;
  }
  return sample;
}

TEST(Columns, AreNamedAsInARecordingAndKeepOnlyWhatIsWanted) {
  Columns columns({"time_s", "limits.cause"});
  columns.append(*sample_at(0.5, 3));
  columns.append(*sample_at(1.0, 0));
  EXPECT_EQ(columns.rows(), 2U);
  EXPECT_EQ(column(columns, "time_s").data.size(), 2 * sizeof(double));
  EXPECT_EQ(column(columns, "limits.cause").counts, (std::vector<std::size_t>{3, 0}));
  EXPECT_EQ(column(columns, "limits.cause").width(), 3U);
  EXPECT_FALSE(column(columns, "reference.q_m").is_kept);
  EXPECT_TRUE(column(columns, "reference.q_m").data.empty());
  EXPECT_FALSE(Columns().all().empty());
}

TEST(ToNpy, HasAHeaderAndRowsOfEqualLength) {
  Columns columns({"time_s", "reference.q_m", "limits.cause"});
  columns.append(*sample_at(0.5, 1));
  columns.append(*sample_at(1.0, 3));
  const std::string file = to_npy(columns);
  EXPECT_EQ(file.substr(1, 5), "NUMPY");
  const std::size_t head = 10 + static_cast<unsigned char>(file[8]);
  EXPECT_EQ(head % 64, 0U);
  EXPECT_NE(file.find("('time_s', '<f8'), ('reference.q_m', '<f8', (2,)), "
                      "('limits.cause', '|u1', (3,)), "),
            std::string::npos)
      << file.substr(0, head);
  EXPECT_NE(file.find("'shape': (2,)"), std::string::npos);
  const std::size_t row = 3 * sizeof(double) + 3;
  ASSERT_EQ(file.size(), head + 2 * row);
  double last = 0.0;
  std::memcpy(&last, file.data() + head + row + 2 * sizeof(double), sizeof last);
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(file[head + 3 * sizeof(double) + 1], '\0') << "padding of the first row";
  EXPECT_EQ(file.back(), static_cast<char>(LimitCause::kLock));
}

}  // namespace
}  // namespace hg::recording
