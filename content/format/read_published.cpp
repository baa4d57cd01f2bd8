#include <fmt/format.h>

#include "content/format/read_assembly.hpp"
#include "content/format/read_joint_type.hpp"

namespace bolt::content {

joint::PublishedParameters read_published(Reader& reader) {
    joint::PublishedParameters p;
    const Layers file(reader, {reader.member(reader.root(), "published")});
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
    // Only where they are given: the printed values must come through to the last bit.
    if (const auto alpha = file.number("alpha_deg")) p.alpha = to_radians(*alpha);
    if (const auto beta = file.number("beta_deg")) p.beta = to_radians(*beta);
    if (const auto turns = file.number("theta_max_turns")) p.theta_max_deg = *turns * 360.0;
    const std::vector<Node> rates = reader.items(file.find("spring_rates_MN_per_mm"));
    for (std::size_t i = 0; i < rates.size() && i < std::size(p.spring_rates_1e6); ++i)
        p.spring_rates_1e6[i] = reader.number(rates[i]).value_or(p.spring_rates_1e6[i]);

    if (file.objects().empty() || !file.sound()) return p;
    if (p.D1_mm <= p.D2_mm)
        reader.report(file.objects()[0].pointer, fmt::format("D1 of {:g} mm is no larger than D2", p.D1_mm),
                      fmt::format("expected more than {:g} mm", p.D2_mm));
    const double yield_start = joint::published_yield_torque(p, p.theta_max_deg - p.yield_width_deg);
    if (yield_start <= 0.0)
        reader.report(file.objects()[0].pointer,
                      fmt::format("the torque would be {:.1f} N·m where yield begins", yield_start),
                      "expected a smaller kappa1_Nm_per_deg2 or yield_width_deg, or a larger T_max_Nm");
    else if (const double start = joint::published_boundaries(p).transition; start <= 0.0)
        reader.report(file.objects()[0].pointer,
                      fmt::format("the nut would be on its seat {:.0f} degrees before it is started", -start),
                      "expected a larger theta_max_turns or narrower stages");
    return p;
}

std::optional<PublishedTargets> read_published_targets(Reader& reader,
                                                       const joint::PublishedParameters& law) {
    const Layers file(reader, {reader.member(reader.root(), "published")});
    PublishedTargets targets;
    targets.torque = read_torque(file);
    targets.snug_torque = read_snug_torque(file, targets.torque);
    const Node target = file.find("target_torque_Nm");
    if (!target) {
        for (const char* key :
             {"snug_torque_Nm", "min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"})
            if (const Node alone = file.find(key); alone && file.known({"target_torque_Nm"}))
                reader.report(alone.pointer, fmt::format("\"{}\" without \"target_torque_Nm\"", key),
                              "expected the target too, or neither", Part::key);
        return std::nullopt;
    }
    check_limits(file);
    if (!file.known({"T_max_Nm", "min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"}))
        return targets;
    if (targets.torque.target > law.T_max_Nm)
        reader.report(target.pointer,
                      fmt::format("{:g} N·m is never reached: the published law ends at a T_max of {:g} N·m",
                                  targets.torque.target, law.T_max_Nm),
                      fmt::format("expected at most {:g} N·m", law.T_max_Nm));
    check_torques(file, targets.torque, targets.snug_torque);
    return targets;
}

}  // namespace bolt::content
