#include "game/record/tables.hpp"

#include <fmt/format.h>

#include <utility>

#include "game/record/format.hpp"
#include "game/record/timing_rows.hpp"

namespace bolt::record {

namespace {

Status put_meta(Database& database, std::string_view key, std::string_view value, Seal& seal) {
    auto statement = database.prepare("INSERT INTO meta VALUES(?, ?)");
    if (!statement) return fail(statement.error());
    seal.add(sum_of_meta(key, value));
    return statement->run_with(key, value);
}

}  // namespace

Status put_header(Database& database, const Header& header, Seals& seals) {
    const std::string seed = fmt::format("{}", header.seed);
    const std::string dt = fmt::format("{}", header.dt);
    const std::pair<const char*, std::string_view> values[] = {
        {key::assembly, header.assembly},
        {key::assembly_file, header.assembly_file},
        {key::assembly_text, header.assembly_text},
        {key::variant, header.variant},
        {key::law, header.law},
        {key::mode, header.mode},
        {key::task, header.task},
        {key::operator_name, header.operator_name},
        {key::seed, seed},
        {key::dt, dt},
        {key::program, header.program},
        {key::guide, header.guide},
        {key::obstacles, header.obstacles},
        {key::device, header.device},
        {key::servo, header.servo},
        {key::view_help, header.view_help},
        {key::tool, header.tool},
        {key::hand, header.hand},

        {key::state, state_recording},
    };
    for (const auto& [name, value] : values)
        if (auto put = put_meta(database, name, value, seals.meta); !put) return put;
    auto obstacle = database.prepare("INSERT INTO obstacle VALUES(?, ?)");
    if (!obstacle) return fail(obstacle.error());
    for (const ObstacleName& named : header.obstacle_names) {
        if (auto put = obstacle->run_with(named.id, std::string_view(named.name)); !put) return put;
        seals.obstacle.add(sum_of(named));
    }
    return {};
}

Status put_chunk(Database& database, std::uint64_t first_tick, std::size_t count,
                 std::span<const std::byte> data, Seals& seals) {
    auto statement = database.prepare("INSERT INTO tick_chunk VALUES(?, ?, ?)");
    if (!statement) return fail(statement.error());
    seals.chunk.add(sum_of_chunk(first_tick, count));
    return statement->run_with(first_tick, count, data);
}

Status put_events(Database& database, std::uint64_t first_ordinal, std::span<const lesson::Event> events,
                  Seals& seals) {
    if (events.empty()) return {};
    auto statement = database.prepare("INSERT INTO event VALUES(?, ?, ?, ?, ?, ?)");
    if (!statement) return fail(statement.error());
    std::uint64_t ordinal = first_ordinal;
    for (const lesson::Event& event : events) {
        auto put = statement->run_with(ordinal, event.tick, event.kind, event.joint, event.value, event.text);
        if (!put) return put;
        seals.event.add(sum_of(ordinal++, event));
    }
    return {};
}

Status put_timing(Database& database, const servo::Timing& timing, Seals& seals) {
    auto statement = database.prepare("INSERT OR REPLACE INTO servo_time VALUES(?, ?, ?, ?, ?, ?)");
    if (!statement) return fail(statement.error());
    seals.servo_time = {};  // all rows are put anew
    for (const TimingRow& row : rows_of(timing)) {
        auto put = statement->run_with(std::string_view(row.name), row.count, row.least, row.greatest,
                                       row.sum, std::span<const std::byte>(row.bins));
        if (!put) return put;
        seals.servo_time.add(sum_of(row));
    }
    return {};
}

Status put_changed(Database& database, std::span<JointRow> joints, Seals& seals) {
    auto statement =
        database.prepare("INSERT OR REPLACE INTO joint_result VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    if (!statement) return fail(statement.error());
    for (std::size_t i = 0; i < joints.size(); ++i) {
        JointRow& joint = joints[i];
        if (!joint.changed) continue;
        const lesson::JointResult& result = joint.result;
        auto put = statement->run_with(
            i, result.id, result.torque, result.angle, result.clamp, result.clamp_at_release,
            name(result.torque_verdict), name(result.angle_verdict), name(result.overall),
            name(result.condition), result.strokes, result.rehits, result.order_errors);
        if (!put) return put;
        const std::uint64_t row = sum_of(i, result);
        if (joint.sealed)
            seals.joint.change(*joint.sealed, row);
        else
            seals.joint.add(row);
        joint.sealed = row;
        joint.changed = false;
    }
    return {};
}

Status put_result(Database& database, const lesson::LessonResult& result, Seals& seals) {
    auto statement = database.prepare("INSERT INTO score_reason VALUES(?, ?, ?)");
    if (!statement) return fail(statement.error());
    for (std::size_t i = 0; i < result.reasons.size(); ++i) {
        const lesson::ScoreReason& reason = result.reasons[i];
        if (auto put = statement->run_with(i, reason.points, reason.text); !put) return put;
        seals.reason.add(sum_of(i, reason));
    }
    const std::string duration = fmt::format("{}", result.duration);
    const std::string score = fmt::format("{}", result.score);
    const std::pair<const char*, std::string_view> values[] = {
        {key::duration, duration}, {key::score, score}, {key::finished, result.finished ? "1" : "0"}};
    for (const auto& [name, value] : values)
        if (auto put = put_meta(database, name, value, seals.meta); !put) return put;
    auto complete = database.prepare("UPDATE meta SET value = ? WHERE key = ?");
    if (!complete) return fail(complete.error());
    seals.meta.change(sum_of_meta(key::state, state_recording), sum_of_meta(key::state, state_complete));
    return complete->run_with(state_complete, key::state);
}

Status put_seals(Database& database, const Seals& seals) {
    auto statement = database.prepare("INSERT OR REPLACE INTO seal VALUES(?, ?, ?)");
    if (!statement) return fail(statement.error());
    const std::pair<const char*, const Seal*> all[] = {{"meta", &seals.meta},
                                                       {"tick_chunk", &seals.chunk},
                                                       {"event", &seals.event},
                                                       {"joint_result", &seals.joint},
                                                       {"score_reason", &seals.reason},
                                                       {"obstacle", &seals.obstacle},
                                                       {"servo_time", &seals.servo_time}};
    for (const auto& [table, seal] : all)
        if (auto put = statement->run_with(table, seal->rows, seal->sum); !put) return put;
    return {};
}

}  // namespace bolt::record
