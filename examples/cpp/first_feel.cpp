// The door, opened by its scripted hand. Argument: the file of its scenario.
#include <cstdio>

#include "hg/scenario/session.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  hg::scenario::Session door(arguments[1]);
  while (door.record().time_s < 10.6) door.advance();
  std::printf("hinge at %.2f rad after %.1f s\n", door.record().twin.q_a[0], door.record().time_s);
}
