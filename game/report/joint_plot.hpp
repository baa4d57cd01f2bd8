// The plot of one joint: torque and clamp force over the nut angle, from shortly before the first contact.
#pragma once

#include <string>

#include "game/analysis/session_data.hpp"
#include "game/plot/plot.hpp"

namespace bolt::report {

// The range of angles that the plot shows.
struct JointPlotFrame {
    double origin = 0.0;      // rad, nut angle that is drawn as 0
    plot::AxisRange range;    // degrees from the origin
    std::string origin_name;  // "snug", "mark", "first contact" or "start"
    bool cut_before = false;  // the run-down is not drawn
    bool cut_after = false;   // the end of the free rotation while loosening is not drawn
};
JointPlotFrame joint_plot_frame(const analysis::SessionData& session, std::size_t joint);

plot::Plot joint_plot(const analysis::SessionData& session, std::size_t joint);

// The plot as SVG. If the run-down is cut, an inset shows the whole run.
std::string joint_figure(const analysis::SessionData& session, std::size_t joint);

// "Run-down of 3.2 turns in 12.0 s, wrench torque 0.10…0.15 N·m."; empty below 15°.
std::string run_down_text(const analysis::RunDown& run);

}  // namespace bolt::report
