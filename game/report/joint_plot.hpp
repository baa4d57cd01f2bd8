// Torque and clamp force over the nut angle for one joint, from a little before the first contact.
#pragma once

#include <string>

#include "game/analysis/session_data.hpp"
#include "game/plot/plot.hpp"

namespace bolt::report {

// What the plot leaves out and where it counts from, in words for its caption.
struct JointView {
    double zero = 0.0;       // rad, nut angle that is drawn as 0
    plot::Range shown;       // degrees from zero
    std::string zero_name;   // "snug", "first contact", "start"
    bool cut = false;        // the run-down is left out
    bool cut_after = false;  // what was turned of a loose nut is not all drawn
};
JointView joint_view(const analysis::SessionData& session, std::size_t joint);

plot::Plot joint_plot(const analysis::SessionData& session, std::size_t joint);

// The plot with the whole run, from the hand-started nut on, as a small inset.
std::string joint_figure(const analysis::SessionData& session, std::size_t joint);

std::string run_down_text(const analysis::RunDown& run);

}  // namespace bolt::report
