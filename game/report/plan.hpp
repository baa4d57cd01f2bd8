// The joints seen along their bolts: in which order they were taken, and what clamp force each holds.
#pragma once

#include <string>
#include <vector>

#include "game/report/order.hpp"
#include "game/report/session_data.hpp"
#include "game/report/svg.hpp"

namespace bolt::report {

// Joints seen from the nuts, scaled into the width; the height follows.
struct PlanLayout {
    std::vector<Point> at;
    double width = 480.0, height = 200.0;
    double radius = 12.0;  // of a joint's disc, so that neighbours do not touch
};
PlanLayout plan_layout(const content::Assembly& assembly, double width, double margin);

std::string order_plan(const SessionData& session, const PassOrder& order);
std::string clamp_plan(const SessionData& session);

// One row a joint: force when released and in the end, against the target and the mean.
std::string clamp_rows(const SessionData& session);
bool released_apart(const SessionData& session);  // some row shows that the two differ

}  // namespace bolt::report
