#include "game/trainees/profile.hpp"

#include <fmt/format.h>

#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"

namespace bolt::trainees {

namespace {

constexpr Profile profiles[] = {
    {.name = "expert",
     .reach_time = 0.9,
     .placing_time = 0.4,
     .position_noise = 0.3e-3,
     .angle_noise = to_radians(0.25),
     .tremor = 0.10e-3,
     .tremor_torsion = to_radians(0.02),
     .pull_speed = to_radians(45),
     .load_rate = 1.6,
     .final_rate = 0.12,
     .spin_speed = to_radians(520),
     .stroke = to_radians(50),
     .reaction = 0.14,
     .torque_bias = 0.03,
     .torque_noise = 0.015,
     .anticipation = 1.0,
     .feels_yield = 1.0,
     .content = 0.8,
     .pause = 0.15,
     .wrong_joint = 0.0,
     .stops_early = 0.0,
     .overdoes = 0.0},
    {.name = "novice",
     .reach_time = 1.5,
     .placing_time = 0.8,
     .position_noise = 0.7e-3,
     .angle_noise = to_radians(0.7),
     .tremor = 0.20e-3,
     .tremor_torsion = to_radians(0.05),
     .pull_speed = to_radians(35),
     .load_rate = 2.0,
     .final_rate = 0.25,
     .spin_speed = to_radians(360),
     .stroke = to_radians(38),
     .reaction = 0.20,
     .torque_bias = 0.04,
     .torque_noise = 0.06,
     .anticipation = 0.5,
     .feels_yield = 0.8,
     .content = 0.6,
     .pause = 0.8,
     .wrong_joint = 0.03,
     .stops_early = 0.05,
     .overdoes = 0.0},
    {.name = "clumsy",
     .reach_time = 1.3,
     .placing_time = 0.7,
     .position_noise = 1.2e-3,
     .angle_noise = to_radians(1.2),
     .tremor = 0.40e-3,
     .tremor_torsion = to_radians(0.12),
     .pull_speed = to_radians(70),
     .load_rate = 2.2,
     .final_rate = 0.35,
     .spin_speed = to_radians(400),
     .stroke = to_radians(45),
     .reaction = 0.26,
     .torque_bias = 0.06,
     .torque_noise = 0.10,
     .anticipation = 0.4,
     .feels_yield = 0.3,
     .content = 0.4,
     .pause = 0.5,
     .wrong_joint = 0.10,
     .stops_early = 0.08,
     .overdoes = 0.08},
};

}  // namespace

std::vector<std::string> profile_names() {
    std::vector<std::string> names;
    for (const Profile& profile : profiles) names.emplace_back(profile.name);
    return names;
}

Result<Profile> find_profile(std::string_view name) {
    for (const Profile& profile : profiles)
        if (profile.name == name) return profile;
    const std::vector<std::string> names = profile_names();
    const std::string best = nearest(name, names);
    return fail(ErrorCode::usage, fmt::format("there is no simulated trainee \"{}\"", name),
                best.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                             : fmt::format("did you mean {}?", best));
}

}  // namespace bolt::trainees
