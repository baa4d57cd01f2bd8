#include "game/session/tables.hpp"

#include <fmt/format.h>

#include <utility>

#include "game/session/format.hpp"
#include "game/session/timing_rows.hpp"

namespace bolt::session {

namespace {

Status put_meta(Database& database, std::string_view key, std::string_view value, TableChecksum& checksum) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO meta VALUES(?, ?)"));
    checksum.add(sum_of_meta(key, value));
    return statement.run_with(key, value);
}

}  // namespace

Status put_header(Database& database, const Header& header, TableChecksums& checksums) {
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
    for (const auto& [name, value] : values) {
        BOLT_TRY(put_meta(database, name, value, checksums.meta));
    }
    if (header.trainee) {
        BOLT_TRY(put_meta(database, key::trainee, *header.trainee, checksums.meta));
    }
    auto obstacle = database.prepare("INSERT INTO obstacle VALUES(?, ?)");
    if (!obstacle) return fail(obstacle.error());
    for (const ObstacleName& named : header.obstacle_names) {
        const std::optional<std::int16_t> number = file_number(named.id);
        if (!number)
            return fail(
                ErrorCode::failed,
                fmt::format("obstacle \"{}\" has index {}; expected an index that a session can number",
                            named.name, named.id.index()));
        BOLT_TRY(obstacle->run_with(std::int32_t{*number}, std::string_view(named.name)));
        checksums.obstacle.add(sum_of(named));
    }
    return {};
}

Status put_chunk(Database& database, std::uint64_t first_tick, std::size_t count,
                 std::span<const std::byte> data, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO tick_chunk VALUES(?, ?, ?)"));
    checksums.chunk.add(sum_of_chunk(first_tick, count));
    return statement.run_with(first_tick, count, data);
}

Status put_events(Database& database, std::uint64_t first_ordinal, std::span<const lesson::Event> events,
                  TableChecksums& checksums) {
    if (events.empty()) return {};
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO event VALUES(?, ?, ?, ?, ?, ?)"));
    std::uint64_t ordinal = first_ordinal;
    for (const lesson::Event& event : events) {
        BOLT_TRY(statement.run_with(ordinal, event.tick, event.kind, event.joint, event.value, event.text));
        checksums.event.add(sum_of(ordinal++, event));
    }
    return {};
}

Status put_timing(Database& database, const servo::Timing& timing, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement,
                    database.prepare("INSERT OR REPLACE INTO servo_time VALUES(?, ?, ?, ?, ?, ?)"));
    checksums.servo_time = {};  // all rows are written again
    for (const TimingRow& row : rows_of(timing)) {
        BOLT_TRY(statement.run_with(std::string_view(row.name), row.count, row.least, row.greatest, row.sum,
                                    std::span<const std::byte>(row.bins)));
        checksums.servo_time.add(sum_of(row));
    }
    return {};
}

Status put_changed(Database& database, std::span<JointRow> joints, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement,
                    database.prepare(
                        "INSERT OR REPLACE INTO joint_result VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"));
    for (std::size_t i = 0; i < joints.size(); ++i) {
        JointRow& joint = joints[i];
        if (!joint.changed) continue;
        const lesson::JointResult& result = joint.result;
        BOLT_TRY(statement.run_with(i, result.id, result.torque, result.angle, result.clamp,
                                    result.clamp_at_release, name(result.torque_verdict),
                                    name(result.angle_verdict), name(result.overall), name(result.condition),
                                    result.strokes, result.rehits, result.order_errors));
        const std::uint64_t row = sum_of(i, result);
        if (joint.sealed)
            checksums.joint.change(*joint.sealed, row);
        else
            checksums.joint.add(row);
        joint.sealed = row;
        joint.changed = false;
    }
    return {};
}

Status put_result(Database& database, const lesson::LessonResult& result, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO score_reason VALUES(?, ?, ?)"));
    for (std::size_t i = 0; i < result.reasons.size(); ++i) {
        const lesson::ScoreReason& reason = result.reasons[i];
        BOLT_TRY(statement.run_with(i, reason.points, reason.text));
        checksums.reason.add(sum_of(i, reason));
    }
    const std::string duration = fmt::format("{}", result.duration);
    const std::string score = fmt::format("{}", result.score);
    const std::pair<const char*, std::string_view> values[] = {
        {key::duration, duration}, {key::score, score}, {key::finished, result.finished ? "1" : "0"}};
    for (const auto& [name, value] : values) {
        BOLT_TRY(put_meta(database, name, value, checksums.meta));
    }
    BOLT_TRY_ASSIGN(auto complete, database.prepare("UPDATE meta SET value = ? WHERE key = ?"));
    checksums.meta.change(sum_of_meta(key::state, state_recording), sum_of_meta(key::state, state_complete));
    return complete.run_with(state_complete, key::state);
}

Status put_checksums(Database& database, const TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT OR REPLACE INTO seal VALUES(?, ?, ?)"));
    const std::pair<const char*, const TableChecksum*> all[] = {{"meta", &checksums.meta},
                                                                {"tick_chunk", &checksums.chunk},
                                                                {"event", &checksums.event},
                                                                {"joint_result", &checksums.joint},
                                                                {"score_reason", &checksums.reason},
                                                                {"obstacle", &checksums.obstacle},
                                                                {"servo_time", &checksums.servo_time}};
    for (const auto& [table, checksum] : all) {
        BOLT_TRY(statement.run_with(table, checksum->rows, checksum->sum));
    }
    return {};
}

}  // namespace bolt::session
