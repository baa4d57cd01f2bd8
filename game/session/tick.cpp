#include "game/session/tick.hpp"

#include <algorithm>
#include <cstring>

namespace bolt::session {

namespace {

// The first number of a nut, and how many fixed obstacles have numbers below it. Files hold it: it cannot
// change.
constexpr std::int32_t first_nut = 1000;

}  // namespace

std::optional<std::int16_t> file_number(collision::ObstacleId obstacle) {
    const auto index = static_cast<std::int32_t>(obstacle.index());
    if (obstacle.is_none()) return std::int16_t{-1};
    if (obstacle.index() >= (obstacle.is_nut() ? most_nuts : most_fixed)) return std::nullopt;
    if (obstacle.is_nut()) return static_cast<std::int16_t>(first_nut + index);
    return static_cast<std::int16_t>(index < first_nut ? index : first_nut - 2 - index);
}

collision::ObstacleId obstacle_of_number(std::int16_t number) {
    if (number == -1) return {};
    if (number >= first_nut) return collision::ObstacleId::nut(static_cast<std::size_t>(number - first_nut));
    return collision::ObstacleId::fixed(
        static_cast<std::size_t>(number >= 0 ? number : first_nut - 2 - number));
}

TickRecord make_record(const servo::Input& input, const servo::Output& output) {
    TickRecord record;
    record.device = input.device;
    record.grip = static_cast<std::uint8_t>(input.grip);
    record.flags = static_cast<std::uint8_t>(
        (input.enabled ? flag_enabled : 0) | (input.fresh ? 0 : flag_silent) | (input.stop ? flag_stop : 0) |
        (input.reset ? flag_reset : 0) | std::min<int>(input.missed, 15) << 4);
    record.guide = input.guide;
    for (int i = 0; i < 3; ++i) {
        record.force[i] = static_cast<float>(output.force[i]);
        record.torque[i] = static_cast<float>(output.torque[i]);
    }
    record.joint = output.joint;
    record.stage = static_cast<std::uint8_t>(output.stage);
    record.wrench_torque = static_cast<float>(output.wrench_torque);
    record.nut_angle = static_cast<float>(output.nut_angle);
    record.clamp = static_cast<float>(output.clamp);
    record.contacts = output.contacts;
    record.touched = output.touched;
    record.fault = static_cast<std::uint8_t>(output.fault);
    record.undo = input.undo;
    record.setting = input.setting;
    return record;
}

servo::Input input_of(const TickRecord& record) {
    servo::Input input;
    input.device = record.device;
    input.grip = static_cast<servo::Grip>(record.grip);
    input.enabled = (record.flags & flag_enabled) != 0;
    input.fresh = (record.flags & flag_silent) == 0;
    input.stop = (record.flags & flag_stop) != 0;
    input.reset = (record.flags & flag_reset) != 0;
    input.missed = static_cast<std::uint8_t>(record.flags >> 4);
    input.guide = record.guide;
    input.undo = record.undo;
    input.setting = record.setting;
    return input;
}

bool same_output(const TickRecord& a, const TickRecord& b) {
    const auto equal = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
    return equal(a.force, b.force) && equal(a.torque, b.torque) && a.joint == b.joint && a.stage == b.stage &&
           equal(a.wrench_torque, b.wrench_torque) && equal(a.nut_angle, b.nut_angle) &&
           equal(a.clamp, b.clamp) && a.contacts == b.contacts && a.touched == b.touched &&
           a.fault == b.fault;
}

bool is_valid(const TickRecord& record) {
    constexpr auto last_grip = static_cast<std::uint8_t>(servo::Grip::wrench);
    return record.grip <= last_grip && record.stage < joint::stage_count && record.guide >= -1 &&
           record.joint >= -1 && file_number(record.touched) && record.fault < force::fault_kinds &&
           (record.undo <= servo::max_checkpoints || record.undo == servo::save_checkpoint);
}

}  // namespace bolt::session
