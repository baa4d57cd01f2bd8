#include "game/session/export.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::session {

namespace {

double rounded(double value, double steps_per_unit) {
    return std::round(value * steps_per_unit) / steps_per_unit;
}

}  // namespace

std::string summary_json(const content::Assembly& assembly, const LessonOptions& options,
                         const LessonOutcome& outcome) {
    const lesson::LessonResult& result = outcome.result;
    nlohmann::ordered_json json;
    json["assembly"] = assembly.name;
    json["variant"] = assembly.variant;
    json["tool"] = assembly.tool;
    json["law"] = joint::name(options.law);
    json["mode"] = lesson::name(options.mode);
    json["task"] = lesson::name(options.task);
    json["guide"] = options.guiding_force && options.mode == lesson::Mode::guided;
    json["obstacles"] = outcome.obstacles;
    json["operator"] = options.trainee_profile;  // the key of session files too
    json["trainee"] = options.trainee;
    json["seed"] = options.seed;
    json["duration_s"] = rounded(result.duration, 1e3);
    json["score"] = rounded(result.score, 1e2);
    json["finished"] = result.finished;
    json["joints"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < result.joints.size(); ++i) {
        const lesson::JointResult& joint = result.joints[i];
        json["joints"].push_back({{"id", joint.id},
                                  {"torque_Nm", rounded(joint.torque, 1e3)},
                                  {"target_torque_Nm", rounded(assembly.joints[i].spec.torque.target, 1e3)},
                                  {"angle_deg", rounded(to_degrees(joint.angle), 1e2)},
                                  {"clamp_N", rounded(joint.clamp, 1.0)},
                                  {"verdict", lesson::name(joint.overall)}});
    }
    return json.dump(2) + "\n";
}

std::string summary_table(const content::Assembly& assembly, const lesson::LessonResult& result) {
    std::string table = fmt::format("{:<8} {:<8} {:>9} {:>9} {:>8} {:>8}  {}\n", "joint", "size", "torque",
                                    "clamp", "target", "angle", "verdict");
    table += fmt::format("{:<8} {:<8} {:>9} {:>9} {:>8} {:>8}\n", "", "", "N·m", "kN", "N·m", "deg");
    for (std::size_t i = 0; i < result.joints.size(); ++i) {
        const lesson::JointResult& joint = result.joints[i];
        const content::AssemblyJoint& planned = assembly.joints[i];
        std::string verdict(lesson::name(joint.overall));
        if (joint.condition != joint::JointCondition::intact)
            verdict += fmt::format(" ({})", joint::name(joint.condition));
        if (joint.out_of_turn > 0) verdict += fmt::format(", {}× out of turn", joint.out_of_turn);
        if (joint.done_already > 0) verdict += fmt::format(", {}× again", joint.done_already);
        const std::string size = fmt::format("{}{}", joint::name(planned.design.thread),
                                             joint::size_suffix(planned.design.thread_direction));
        table +=
            fmt::format("{:<8} {:<8} {:>8.1f} {:>9.2f} {:>8.1f} {:>8.1f}  {}\n", joint.id, size, joint.torque,
                        joint.clamp / 1e3, planned.spec.torque.target, to_degrees(joint.angle), verdict);
    }
    table += fmt::format("{:.1f} s, score {:.1f} of 100\n", result.duration, result.score);
    for (const lesson::Deduction& reason : result.reasons)
        table += reason.points == 0.0 ? fmt::format("  {:>6}  {}\n", "", reason.text)
                                      : fmt::format("  {:>+6.1f}  {}\n", reason.points, reason.text);
    return table;
}

namespace {

constexpr std::string_view header_row =
    "time_s,position_x_m,position_y_m,position_z_m,orientation_w,orientation_x,orientation_y,orientation_z,"
    "grip,enabled,guide,joint,stage,wrench_torque_Nm,nut_angle_deg,clamp_N,"
    "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,contacts,touched,fault\r\n";

constexpr std::string_view name(servo::Grip grip) {
    constexpr std::string_view names[] = {"none", "fingers", "wrench"};
    return names[static_cast<int>(grip)];
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string field = "\"";
    for (const char c : text) {
        if (c == '"') field += '"';
        field += c;
    }
    return field += '"';
}

// Maps the number of a joint or obstacle to its name as a CSV field. −1 gives an empty field; a number
// without a name gives "#NUMBER".
class NamedFields {
  public:
    void add(std::int32_t number, const std::string& name) { names_[number] = quoted(name); }

    [[nodiscard]] std::string_view operator[](std::int16_t number) {
        if (number == -1) return {};
        const auto found = names_.find(number);
        return found != names_.end() ? found->second : unknown_ = fmt::format("#{}", number);
    }

  private:
    std::map<std::int32_t, std::string> names_;
    std::string unknown_;
};

struct Names {
    NamedFields joints, obstacles;
};

void append_row(std::string& text, double time, const TickRecord& tick, Names& names) {
    const auto out = std::back_inserter(text);
    const auto& [p, q] = tick.commanded_tool;
    fmt::format_to(out, "{:.6f},{},{},{},{},{},{},{},{},{},", time, p[0], p[1], p[2], q[0], q[1], q[2], q[3],
                   name(static_cast<servo::Grip>(tick.grip)), tick.flags & flag_dead_man);
    text.append(names.joints[tick.guided_joint]).append(",").append(names.joints[tick.joint]);
    fmt::format_to(out, ",{},{},{},{},{},{},{},{},{},{},{},",
                   joint::name(static_cast<joint::Stage>(tick.stage)), tick.wrench_torque,
                   static_cast<float>(to_degrees(static_cast<double>(tick.nut_angle))), tick.clamp,
                   tick.force[0], tick.force[1], tick.force[2], tick.torque[0], tick.torque[1],
                   tick.torque[2], tick.contacts);
    text.append(names.obstacles[file_number(tick.touched).value_or(-1)]).append(",");
    text.append(force::message_for(static_cast<force::Fault>(tick.fault))).append("\r\n");
}

tl::unexpected<Error> write_error(const std::string& out_name, int reason) {
    Error error;
    error.file = out_name;
    error.what = std::string("cannot be written: ") + std::strerror(reason);
    error.expected = "a destination that accepts more data";
    return fail(std::move(error));
}

}  // namespace

Status export_csv(const SessionReader& session, std::FILE* out, const CsvOptions& options) {
    if (options.every_n == 0) return fail(ErrorCode::usage, "the export interval is 0 ticks", "1 or more");
    BOLT_TRY_ASSIGN(const auto result, session.result());
    Names names;
    for (std::size_t i = 0; i < result.joints.size(); ++i)
        names.joints.add(static_cast<std::int32_t>(i), result.joints[i].id);
    for (const ObstacleName& named : session.header().obstacle_names)
        names.obstacles.add(file_number(named.id).value_or(-1), named.name);
    const double dt = session.header().dt;

    std::string text(header_row);
    std::optional<int> failure;  // errno of the first write that failed; the rest is not formatted
    const auto write_out = [&] {
        if (!failure && std::fwrite(text.data(), 1, text.size(), out) != text.size()) failure = errno;
        text.clear();
    };
    Status read = session.for_each_chunk([&](std::uint64_t first, std::span<const TickRecord> ticks) {
        if (failure) return;
        const std::uint64_t remainder = first % options.every_n;
        for (std::uint64_t i = remainder == 0 ? 0 : options.every_n - remainder; i < ticks.size();
             i += options.every_n)
            append_row(text, static_cast<double>(first + i) * dt, ticks[i], names);
        write_out();
    });
    write_out();
    if (!failure && std::fflush(out) != 0) failure = errno;
    if (failure) return write_error(options.out_name, *failure);
    return read;
}

}  // namespace bolt::session
