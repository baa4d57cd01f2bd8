#include "game/session/session_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>

namespace bolt::session {

namespace {

// Visits each limit with its name, in the order of the text.
template <class Limits, class Visit>
void for_each_limit(Limits& l, Visit visit) {
    visit("force_N", l.force), visit("torque_Nm", l.torque);
    visit("force_rate_N_s", l.force_rate), visit("torque_rate_Nm_s", l.torque_rate);
    visit("ramp_up_s", l.ramp_up), visit("release_s", l.release);
    visit("stiffness_N_m", l.stiffness), visit("torsion_Nm_rad", l.torsion);
    visit("damping_Ns_m", l.damping), visit("angular_damping_Nms_rad", l.angular_damping);
    visit("delay_ticks", l.delay);
    visit("speed_m_s", l.speed), visit("angular_speed_rad_s", l.angular_speed);
    visit("jump_m", l.jump), visit("angular_jump_rad", l.angular_jump);
    visit("silence_s", l.silence), visit("recovery_s", l.recovery);
}

// The list above names every member; a new member must be added to it.
static_assert(sizeof(force::OutputLimits) == 17 * sizeof(double));

}  // namespace

std::string limits_text(const force::OutputLimits& limits) {
    std::string text;
    for_each_limit(limits, [&](const char* name, auto value) {
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
    });
    return text;
}

std::optional<force::OutputLimits> parse_limits(std::string_view text) {
    force::OutputLimits limits;
    bool sound = true;
    for_each_limit(limits, [&](std::string_view name, auto& value) {
        if (!text.starts_with(name) || text.size() <= name.size() || text[name.size()] != '=') {
            sound = false;
            return;
        }
        text.remove_prefix(name.size() + 1);
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        sound = sound && problem == std::errc{};
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.starts_with(' ')) text.remove_prefix(1);
    });
    return sound && text.empty() ? std::optional(limits) : std::nullopt;
}

}  // namespace bolt::session
