// Every struct inside a sample, found by its list of fields: a new member needs its line in that
// list and nothing else to be recorded, read back and explained.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hg/core/aggregate.h"
#include "hg/core/fields.h"
#include "hg/core/test/unit_words.h"
#include "hg/messages/cdr_reader.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/schema.h"
#include "hg/messages/test/random_message.h"
#include "hg/signals/state.h"

namespace hg::messages {
namespace {

// The fields of one struct.
struct List {
  int members = 0;
  std::vector<std::string> names, notes, units;
  std::vector<std::string>
      undeclared;  // floating-point numbers without a unit, unit::kNone neither

  template <typename T>
  void operator()(const char* name, const T& value, const char* note = "") {
    constexpr bool kIsNumber = std::is_floating_point_v<T> || requires { value.rows(); };
    if (kIsNumber) undeclared.emplace_back(name);
    (*this)(name, value, note, unit::kNone);
  }
  template <typename T>
  void operator()(const char* name, const T&, const char* note, const Unit& unit) {
    ++members;
    names.emplace_back(name);
    notes.emplace_back(note);
    units.push_back(unit.text());
  }
  template <typename T, std::size_t kCapacity>
  void sequence(const char* name, const std::array<T, kCapacity>&, int, const char* note) {
    members += 2;  // items and their number
    names.emplace_back(name);
    notes.emplace_back(note);
    units.emplace_back();
  }
};

template <typename Struct>
List list_of() {
  List list;
  fields(list, static_cast<const Struct&>(Struct{}));
  return list;
}

// Calls visit<Struct>() for a struct and all structs inside it, each once.
template <typename Visit>
class Walk {
 public:
  explicit Walk(Visit visit) : visit_(visit) {}

  template <typename Struct>
  void walk() {
    if (!seen_.insert(struct_name<Struct>()).second) return;
    visit_(static_cast<const Struct*>(nullptr));
    fields(*this, static_cast<const Struct&>(Struct{}));
  }

  template <typename T>
  void operator()(const char*, const T&, const char* = "", const Unit& = unit::kNone) {
    if constexpr (HasFields<T>) walk<T>();
  }
  template <typename T, std::size_t kCapacity>
  void sequence(const char*, const std::array<T, kCapacity>&, int, const char*) {
    walk<T>();
  }

 private:
  Visit visit_;
  std::set<std::string_view> seen_;
};

// Calls visit(null pointer to the struct) for every struct inside a sample.
template <typename Visit>
void for_every_struct(Visit visit) {
  Walk walk(visit);
  walk.template walk<Sample>();
}

TEST(Fields, AllStructsOfASampleHaveThem) {
  std::set<std::string_view> names;
  for_every_struct([&]<typename Struct>(const Struct*) { names.insert(struct_name<Struct>()); });
  EXPECT_EQ(names, (std::set<std::string_view>{"Sample",
                                               "SensorFrame",
                                               "SafetyInputs",
                                               "OperatorFrame",
                                               "HandTarget",
                                               "SafetyPanel",
                                               "ParameterChange",
                                               "CommandFrame",
                                               "CycleRecord",
                                               "Fault",
                                               "RobotState",
                                               "ReferenceState",
                                               "TwinState",
                                               "Pose",
                                               "Budget",
                                               "LimitReport",
                                               "TrackingReport",
                                               "CollisionReport",
                                               "PassivityReport",
                                               "ContactReport",
                                               "TouchReport",
                                               "InertialReport",
                                               "Truth",
                                               "BystanderReport",
                                               "RestReport",
                                               "WalkerReport",
                                               "TwinForce",
                                               "TwinBase",
                                               "TeleoperationReport"}));
}

TEST(Fields, NameEveryMemberOfEveryStruct) {
  for_every_struct([]<typename Struct>(const Struct*) {
    int members = member_count<Struct>();
    // the base counts as one member
    if (std::is_base_of_v<LawReport, Struct>) members += member_count<LawReport>() - 1;
    EXPECT_EQ(list_of<Struct>().members, members) << struct_name<Struct>();
  });
}

TEST(Fields, SurviveARecordingInEveryStruct) {
  for_every_struct([]<typename Struct>(const Struct*) {
    Struct message{}, decoded{};
    RandomFiller filler(1);
    fields(filler, message);
    CdrWriter writer, again;
    const auto bytes = writer.encode(message);
    ASSERT_TRUE(CdrReader(bytes).decode(decoded)) << struct_name<Struct>();
    EXPECT_TRUE(std::ranges::equal(again.encode(decoded), bytes)) << struct_name<Struct>();
  });
}

TEST(Fields, AreTheLinesOfTheSchemaInTheSameOrder) {
  for_every_struct([]<typename Struct>(const Struct*) {
    const List list = list_of<Struct>();
    std::istringstream lines(schema_text<Struct>());
    for (std::size_t i = 0; i < list.names.size(); ++i) {
      std::string line;
      std::getline(lines, line);
      EXPECT_NE(line.find(" " + list.names[i]), std::string::npos) << line;
      const std::string& unit = list.units[i];
      const std::string note = (unit.empty() ? "" : "# [" + unit + "] ") + list.notes[i];
      EXPECT_NE(line.find(note), std::string::npos) << line;
    }
  });
}

TEST(Fields, HaveNotesThatCanBeReadAlone) {
  for_every_struct([]<typename Struct>(const Struct*) {
    const List list = list_of<Struct>();
    for (std::size_t i = 0; i < list.notes.size(); ++i) {
      const std::string& note = list.notes[i];
      for (const std::string_view beginning : {"of ", "that ", "by ", "in ", "what ", "which "}) {
        EXPECT_FALSE(note.starts_with(beginning)) << struct_name<Struct>() << ": " << note;
      }
      for (const std::string_view word : {"nobody", "somebody", "told"}) {
        EXPECT_EQ(note.find(word), std::string::npos) << struct_name<Struct>() << ": " << note;
      }
    }
  });
}

TEST(Fields, DeclareTheUnitOfEveryNumber) {
  for_every_struct([]<typename Struct>(const Struct*) {
    EXPECT_EQ(list_of<Struct>().undeclared, std::vector<std::string>{}) << struct_name<Struct>();
  });
}

TEST(Fields, HaveNoUnitInTheirNotes) {
  for_every_struct([]<typename Struct>(const Struct*) {
    for (const std::string& note : list_of<Struct>().notes) {
      EXPECT_EQ(unit_word_in(note), "") << struct_name<Struct>() << ": " << note;
    }
  });
}

}  // namespace
}  // namespace hg::messages
