// The joints seen along their bolts: in which order they were taken, and what clamp force each holds.
#pragma once

#include <string>
#include <vector>

#include "game/analysis/session_data.hpp"
#include "game/plot/svg.hpp"

namespace bolt::report {

// Joints seen from the nuts, scaled into the width; the height follows.
struct PlanLayout {
    std::vector<plot::Point> at;
    double width = 480.0, height = 200.0;
    double radius = 12.0;  // of a joint's disc, so that neighbours do not touch
};
PlanLayout plan_layout(const content::Assembly& assembly, double width, double margin);

std::string order_plan(const analysis::SessionData& session, const analysis::PassOrder& order);
std::string clamp_plan(const analysis::SessionData& session);

// One row a joint: force when released and in the end, against the target and the mean.
std::string clamp_rows(const analysis::SessionData& session);
bool released_apart(const analysis::SessionData& session);  // some row shows that the two differ

}  // namespace bolt::report
