// A wrench on a bolt or near it pivots about the bolt.
#pragma once

#include "haptics/station/station_tick.hpp"

namespace bolt::station {

// On a bolt and near it the wrench follows the end of its handle, and its jaw points to the bolt. The wrist
// may turn freely: a device without torque cannot hold it, and a hand cannot place a jaw with it to a degree.
// `last`: the tool's pose before this tick.
void pivot_about_bolt(const Layout& layout, const servo::Setup& setup, StationState& state, const Pose& last,
                      double dt);

}  // namespace bolt::station
