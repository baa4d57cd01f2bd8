#include <algorithm>

#include "game/lesson/law.hpp"
#include "haptics/joint/published.hpp"

namespace bolt::lesson {

namespace {

using joint::PublishedParameters;

constexpr double tool_accuracy = 0.04;  // ISO 6789-1, hand torque tools above 10 N·m
constexpr double click_margin = 0.99;

// Torque at `share` of the yield stage before its end, N·m.
double torque_before_end(const PublishedParameters& law, double share) {
    return joint::published_yield_torque(law, law.theta_max_deg - share * law.yield_width_deg);
}

// Nut angle from the snug torque to `torque`, rad.
double angle_from_snug(const PublishedParameters& law, double snug_torque, double torque) {
    return to_radians(joint::published_angle(law, torque) - joint::published_angle(law, snug_torque));
}

// Targets that follow from the law. Inertia adds to the torque of a pull, so the same pull reaches a smaller
// angle. Therefore the torque decides about LOW, and the lower limit of the angle is wider.
content::Specification derived_targets(const PublishedParameters& law) {
    content::Specification s;
    s.strategy = content::Strategy::torque_angle;
    s.torque = {torque_before_end(law, 0.1), torque_before_end(law, 1.0 / 3.0),
                (1.0 + tool_accuracy) * law.T_max_Nm};
    // Keeps the snug torque in the elastic stage, even if the yield stage begins at a low torque.
    s.snug_torque = std::min(0.25 * s.torque.target, 0.5 * torque_before_end(law, 1.0));
    s.has_angle = true;
    const double end = angle_from_snug(law, s.snug_torque, law.T_max_Nm);
    const double stage = to_radians(law.yield_width_deg);
    s.angle = {end - 0.1 * stage, end - 0.5 * stage, end + stage / 3.0};
    return s;
}

// Lowers the targets so that a click-type torque wrench within `accuracy` of them clicks before the end of
// the yield stage. The torque may grow between the last recorded tick and the click; click_margin allows for
// it.
void fit_to_clicks(const PublishedParameters& law, double accuracy, content::Specification& s) {
    const double highest = torque_before_end(law, 0.1) / (1.0 + accuracy);
    if (s.torque.target <= highest) return;
    s.torque.target = highest;
    s.torque.low = std::min(s.torque.low, click_margin * (1.0 - accuracy) * highest);
    s.snug_torque = std::min(s.snug_torque, 0.9 * s.torque.low);
    if (!s.has_angle) return;
    s.angle.target = angle_from_snug(law, s.snug_torque, highest);
    const double least = std::min(s.torque.low, torque_before_end(law, 1.0));
    s.angle.low = std::min(s.angle.low, angle_from_snug(law, s.snug_torque, least));
}

void start_on_thread(content::AssemblyJoint& joint) {
    content::PublishedJoint& published = joint.published;
    if (published.has_theta_max) return;
    PublishedParameters& law = published.law;
    const double seat = 360.0 * joint.design.start_gap / joint.design.thread.thread.pitch;
    const double behind_seat = law.theta_max_deg - joint::published_boundaries(law).linearity;
    // The nut is started before the transition.
    law.theta_max_deg = std::max(seat, law.transition_width_deg + 90.0) + behind_seat;
    published.has_theta_max = true;
}

void adapt(const content::WrenchDesign& wrench, content::AssemblyJoint& joint) {
    start_on_thread(joint);
    const PublishedParameters& law = joint.published.law;
    const content::RiskClass risk = joint.spec.risk;
    joint.spec = joint.published.targets ? *joint.published.targets : derived_targets(law);
    joint.spec.risk = risk;
    if (wrench.click_swing > 0.0) fit_to_clicks(law, wrench.click_accuracy, joint.spec);
}

void adapt_before_format_6(content::AssemblyJoint& joint) {
    content::Specification& spec = joint.spec;
    const double highest = 0.98 * joint.published.law.T_max_Nm;
    spec.strategy = content::Strategy::torque;
    spec.has_angle = false;
    spec.target_clamp = 0.0;
    if (const auto& own = joint.published.targets) {
        spec.torque = own->torque;
        spec.snug_torque = own->snug_torque;
        return;
    }
    spec.torque.target = std::min(spec.torque.target, highest);
    spec.torque.low = std::min(spec.torque.low, 0.95 * spec.torque.target);
}

}  // namespace

content::Assembly apply_law(content::Assembly assembly, joint::Law law, LawAdaptation adaptation) {
    assembly.law = law;
    if (law == joint::Law::mechanistic) return assembly;
    for (content::AssemblyJoint& joint : assembly.joints)
        if (adaptation == LawAdaptation::yield_end)
            adapt(content::tool_of(assembly, joint), joint);
        else
            adapt_before_format_6(joint);
    return assembly;
}

}  // namespace bolt::lesson
