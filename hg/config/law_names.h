/// Names of law, bounds, gantry guidance, braking before limits, and passivity reaction, in
/// device.yaml and on the command line.
#pragma once

#include <array>

#include "hg/config/schema.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/safety/passivity/passivity.h"

namespace hg::config {

inline constexpr std::array<Choice<rendering::Law>, 2> kLaws = {
    {{to_string(rendering::Law::kGauss), rendering::Law::kGauss},
     {to_string(rendering::Law::kPaper), rendering::Law::kPaper}}};

inline constexpr std::array<Choice<rendering::Bounds>, 2> kBounds = {
    {{to_string(rendering::Bounds::kRecoverable), rendering::Bounds::kRecoverable},
     {to_string(rendering::Bounds::kPaper), rendering::Bounds::kPaper}}};

inline constexpr std::array<Choice<rendering::Gantry>, 2> kGantries = {
    {{to_string(rendering::Gantry::kLaw), rendering::Gantry::kLaw},
     {to_string(rendering::Gantry::kRule), rendering::Gantry::kRule}}};

inline constexpr std::array<Choice<rendering::Braking>, 2> kBrakings = {
    {{to_string(rendering::Braking::kAlone), rendering::Braking::kAlone},
     {to_string(rendering::Braking::kTogether), rendering::Braking::kTogether}}};

inline constexpr std::array<Choice<passivity::Reaction>, 3> kPassivityReactions = {
    {{"off", passivity::Reaction::kOff},
     {"observe", passivity::Reaction::kObserve},
     {"act", passivity::Reaction::kAct}}};

}  // namespace hg::config
