#include "hg/messages/schema.h"

#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "hg/messages/event.h"
#include "hg/messages/ros_messages.h"
#include "hg/signals/state.h"

namespace hg::messages {
namespace {

const std::string kLine = std::string(80, '=') + "\n";

TEST(SchemaText, IsTheDefinitionOfRosWithItsParts) {
  EXPECT_EQ(schema_text<JointState>(),
            "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
            "float64[] effort\n" +
                kLine + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
                kLine + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

TEST(SchemaText, DefinesAPartOnce) {
  const std::string text = schema_text<WrenchStamped>();
  const std::string definition = "MSG: geometry_msgs/Vector3\n";
  ASSERT_NE(text.find(definition), std::string::npos);
  EXPECT_EQ(text.find(definition), text.rfind(definition));
}

TEST(SchemaText, SpellsTypesAsRosDoes) {
  const std::string text = schema_text<Sample>();
  for (const char* line :
       {"\nuint64 sequence  #", "\nfloat64[] q_m  #", "\nfloat64[6] w_s  #", "\nfloat64[9] r  #",
        "\nbool dead_man  #", "\nuint8 mode  #", "\nuint16 code  #", "\nint16 index  #",
        "\nint32 felt_limit  #", "\nhapticgiant_msgs/LimitReport[] limits  #"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

TEST(SchemaText, ExplainsEveryNumberOfAnEnum) {
  const std::string text = schema_text<Sample>();
  for (const char* line :
       {"\nuint8 cause  # 0 none, 1 position, 2 velocity, 3 acceleration, 4 "
        "lock, 5 latch, 6 friction, "
        "7 contradiction, 8 torque, 9 torque rate, 10 weight, 11 braking\n",
        "\nuint8 change  # outcome of this cycle's parameter change: 0 none, 1 taken, 2 refused\n",
        "14 still moving, 15 twin apart, 16 posture implausible\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

TEST(SchemaText, HasOnlyNamesThatRosAllows) {
  const std::regex allowed(
      R"(=+|MSG: [a-z_]+/[A-Z]\w*|[a-z0-9_]+(/[A-Z]\w*)?(\[\d*\])? [a-z](_?[a-z0-9]+)*(  # .*)?)");
  std::istringstream lines(schema_text<Sample>() + schema_text<Event>());
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(std::regex_match(line, allowed)) << line;
  }
}

TEST(SchemaName, HasThreeParts) {
  EXPECT_EQ(schema_name<TransformMessage>(), "tf2_msgs/msg/TFMessage");
  EXPECT_EQ(schema_name<Sample>(), "hapticgiant_msgs/msg/Sample");
}

}  // namespace
}  // namespace hg::messages
