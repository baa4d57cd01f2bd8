#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "content/format/read_joints.hpp"
#include "haptics/joint/published.hpp"

namespace bolt::content {

namespace {

void read_spring_rates(const LayeredObject& file, joint::PublishedParameters& p) {
    const std::vector<JsonNode> rates = file.reader().items(file.find("spring_rates_MN_per_mm"));
    for (std::size_t i = 0; i < rates.size() && i < std::size(p.spring_rates_1e6); ++i)
        p.spring_rates_1e6[i] = file.reader().number(rates[i]).value_or(p.spring_rates_1e6[i]);
}

joint::PublishedParameters read_law(const LayeredObject& file) {
    joint::PublishedParameters p;
    const auto read = [&](std::string_view key, double& value) { value = file.number(key).value_or(value); };
    read("nut_mass_g", p.nut_mass_g);
    read("mu", p.mu);
    read("mu1", p.mu1);
    read("mu2", p.mu2);
    read("pitch_mm", p.pitch_mm);
    read("d2_mm", p.d2_mm);
    read("D1_mm", p.D1_mm);
    read("D2_mm", p.D2_mm);
    read("r_t_mm", p.r_t_mm);
    read("r_b_mm", p.r_b_mm);
    read("E1_GPa", p.E1_GPa);
    read("E2_GPa", p.E2_GPa);
    read("nu1", p.nu1);
    read("nu2", p.nu2);
    read("kappa", p.kappa);
    read("T_max_Nm", p.T_max_Nm);
    read("kappa1_Nm_per_deg2", p.kappa1);
    read("yield_width_deg", p.yield_width_deg);
    read("transition_width_deg", p.transition_width_deg);
    read("contact_end_mm2", p.contact_end_mm2);
    // Converted only if given, so that the paper's defaults are preserved to the last bit.
    if (const auto alpha = file.number("alpha_deg")) p.alpha = to_radians(*alpha);
    if (const auto beta = file.number("beta_deg")) p.beta = to_radians(*beta);
    if (const auto turns = file.number("theta_max_turns")) p.theta_max_deg = *turns * 360.0;
    read_spring_rates(file, p);
    return p;
}

void check_law(const LayeredObject& file, const joint::PublishedParameters& p) {
    if (file.objects().empty() || !file.is_valid()) return;
    JsonReader& reader = file.reader();
    const std::string& place = file.objects().front().pointer;
    if (p.D1_mm <= p.D2_mm)
        reader.report(place, fmt::format("D1 of {:g} mm is no larger than D2", p.D1_mm),
                      fmt::format("more than {:g} mm", p.D2_mm));
    const double yield_start = joint::published_yield_torque(p, p.theta_max_deg - p.yield_width_deg);
    if (yield_start <= 0.0)
        reader.report(place, fmt::format("the torque would be {:.1f} N·m where yield begins", yield_start),
                      "a smaller kappa1_Nm_per_deg2 or yield_width_deg, or a larger T_max_Nm");
    else if (const double start = joint::published_boundaries(p).transition; start <= 0.0)
        reader.report(place,
                      fmt::format("the nut would be on its seat {:.0f} degrees before it is started", -start),
                      "a larger theta_max_turns or narrower stages");
}

std::optional<Specification> read_targets(const LayeredObject& file, const joint::PublishedParameters& law) {
    JsonReader& reader = file.reader();
    const JsonNode target = file.find("target_torque_Nm");
    if (!target) {
        for (const char* key :
             {"snug_torque_Nm", "min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent",
              "target_angle_deg", "min_angle_deg", "max_angle_deg"})
            if (const JsonNode alone = file.find(key); alone && file.all_valid({"target_torque_Nm"}))
                reader.report(alone.pointer, fmt::format("\"{}\" without \"target_torque_Nm\"", key),
                              "the target too, or neither", JsonPart::key);
        return std::nullopt;
    }
    Specification targets = read_spec(file);
    if (targets.has_angle) targets.strategy = Strategy::torque_angle;
    check_limits(file);
    if (file.all_valid({"target_angle_deg", "min_angle_deg", "max_angle_deg"})) check_angles(file, targets);
    if (!file.all_valid({"T_max_Nm", "min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"}))
        return targets;
    if (targets.torque.target > law.T_max_Nm)
        reader.report(target.pointer,
                      fmt::format("{:g} N·m is never reached: the published law ends at a T_max of {:g} N·m",
                                  targets.torque.target, law.T_max_Nm),
                      fmt::format("at most {:g} N·m", law.T_max_Nm));
    check_torques(file, targets.torque, targets.snug_torque);
    return targets;
}

}  // namespace

PublishedJoint read_published(const LayeredObject& layers) {
    PublishedJoint joint;
    joint.law = read_law(layers);
    joint.has_theta_max = static_cast<bool>(layers.find("theta_max_turns"));
    check_law(layers, joint.law);
    joint.targets = read_targets(layers, joint.law);
    return joint;
}

}  // namespace bolt::content
