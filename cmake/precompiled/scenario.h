// Our own headers that most of the files include which play or inspect scenarios.
#pragma once

#include "hg/assembly/assembly.h"
#include "hg/config/scenario.h"
#include "hg/cycle/cycle.h"
