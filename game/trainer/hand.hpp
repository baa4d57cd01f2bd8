// The hand at work as pictures and words need it, whether a mouse moves it or somebody at a station.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "engine/base/pose.hpp"

namespace bolt::trainer {

enum class Doing : std::uint8_t {
    resting,   // the hand waits where it is
    reaching,  // on its way: to a nut, to the wrench, to where that is laid down
    lowering,  // onto a nut
    holding,   // of a nut, by the wrench or the fingers: it is pulled
    easing,    // the wrench springs back before it comes off
    lifting,
    returning,  // fingers go back for the next twist
};

struct Hand {
    Doing doing = Doing::resting;
    bool wrench = false;             // is in the hand
    std::optional<std::size_t> nut;  // that it goes to, is at or has
    Pose pose;                       // of the tool or the empty hand, in the assembly's frame
    Pose to;                         // where a reach ends
    Pose rest;                       // where the wrench lies
    double twisted = 0.0;            // rad, by the fingers since they took the nut
    double room = std::numeric_limits<double>::infinity();  // rad, how far it can still turn what it holds
};

}  // namespace bolt::trainer
