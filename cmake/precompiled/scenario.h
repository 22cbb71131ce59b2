// Our own headers that most of the files include which play or inspect scenarios.
#pragma once

#include "hg/config/simulation/scenario.h"
#include "hg/controller/cycle.h"
#include "hg/scenario/assembly.h"
