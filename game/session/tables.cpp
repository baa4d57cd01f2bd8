#include "game/session/tables.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/hash.hpp"

namespace bolt::session {

namespace {

constexpr std::size_t entry_bytes = 4 + 8;

void put(std::vector<std::byte>& out, std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
}

std::uint64_t get(std::span<const std::byte> in) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < in.size(); ++i) value |= static_cast<std::uint64_t>(in[i]) << (8 * i);
    return value;
}

TimingRow row_of(const char* name, const servo::Histogram& h) {
    TimingRow row{name, h.count, h.min, h.max, h.sum, {}};
    for (std::size_t i = 0; i < h.bins; ++i) {
        if (h.counts[i] == 0) continue;
        put(row.bins, i, 4);
        put(row.bins, h.counts[i], 8);
    }
    return row;
}

bool read_bins(std::span<const std::byte> in, servo::Histogram& h) {
    if (in.size() % entry_bytes != 0) return false;
    std::uint64_t sum = 0;
    for (; !in.empty(); in = in.subspan(entry_bytes)) {
        const std::uint64_t bin = get(in.first(4)), count = get(in.subspan(4, 8));
        if (bin >= h.bins || count > h.count) return false;
        h.counts[bin] = count;
        sum += count;
    }
    return sum == h.count;
}

}  // namespace

std::array<TimingRow, timing_rows> rows_of(const servo::Timing& timing) {
    return {row_of("wake_up", timing.wake_up), row_of("compute", timing.compute),
            row_of("period", timing.period), TimingRow{"missed", timing.missed, 0, 0, 0.0, {}}};
}

bool read_row(servo::Timing& timing, const TimingRow& row) {
    if (row.name == "missed") {
        timing.missed = row.count;
        return row.bins.empty();
    }
    servo::Histogram* const h = row.name == "wake_up"   ? &timing.wake_up
                                : row.name == "compute" ? &timing.compute
                                : row.name == "period"  ? &timing.period
                                                        : nullptr;
    if (h == nullptr) return false;
    *h = {};
    h->count = row.count;
    h->min = row.min;
    h->max = row.max;
    h->sum = row.sum;
    if (row.name == "wake_up") timing.ticks = row.count;
    return read_bins(row.bins, *h);
}

namespace {

// The hash of one table row: typed values in a fixed byte order.
class RowHash {
  public:
    explicit RowHash(std::string_view table) { add(table); }

    RowHash& add(std::uint64_t value) {
        for (unsigned i = 0; i < 8; ++i) hash_.add(static_cast<std::uint8_t>(value >> (8 * i)));
        return *this;
    }
    RowHash& add(int value) { return add(static_cast<std::uint64_t>(value)); }
    RowHash& add(double value) {
        if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
        return add(std::bit_cast<std::uint64_t>(value + 0.0));
    }
    RowHash& add(std::string_view text) {
        add(std::uint64_t{text.size()});
        hash_.add(text);
        return *this;
    }

    [[nodiscard]] std::uint64_t value() const { return hash_.value(); }

  private:
    Fnv1a hash_;
};

}  // namespace

std::uint64_t meta_row_hash(std::string_view key, std::string_view value) {
    return RowHash("meta").add(key).add(value).value();
}

std::uint64_t chunk_row_hash(std::uint64_t first_tick, std::uint64_t count) {
    return RowHash("tick_chunk").add(first_tick).add(count).value();
}

std::uint64_t row_hash(const ObstacleName& obstacle) {
    return RowHash("obstacle")
        .add(std::int32_t{file_number(obstacle.id).value_or(-1)})
        .add(std::string_view(obstacle.name))
        .value();
}

std::uint64_t row_hash(const TimingRow& row) {
    const std::string_view bins(reinterpret_cast<const char*>(row.bins.data()), row.bins.size());
    RowHash hash("servo_time");
    hash.add(std::string_view(row.name)).add(row.count).add(row.min).add(row.max).add(row.sum);
    return hash.add(bins).value();
}

std::uint64_t row_hash(std::uint64_t ordinal, const lesson::LessonEvent& event) {
    RowHash hash("event");
    hash.add(ordinal).add(event.tick).add(lesson::name(event.kind)).add(event.joint);
    return hash.add(event.value).add(std::string_view(event.text)).value();
}

std::uint64_t row_hash(std::uint64_t ordinal, const lesson::JointResult& result) {
    RowHash hash("joint_result");
    hash.add(ordinal).add(std::string_view(result.id));
    hash.add(result.torque).add(result.angle).add(result.clamp).add(result.clamp_at_release);
    hash.add(static_cast<int>(result.torque_verdict)).add(static_cast<int>(result.angle_verdict));
    hash.add(static_cast<int>(result.overall)).add(static_cast<int>(result.condition));
    return hash.add(result.strokes).add(result.done_already).add(result.out_of_turn).value();
}

std::uint64_t row_hash(std::uint64_t ordinal, const lesson::Deduction& reason) {
    return RowHash("score_reason").add(ordinal).add(reason.points).add(std::string_view(reason.text)).value();
}

namespace {

Status put_meta(Database& database, std::string_view key, std::string_view value, TableChecksum& checksum) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO meta VALUES(?, ?)"));
    checksum.add(meta_row_hash(key, value));
    return statement.run_with(key, value);
}

}  // namespace

Status put_header(Database& database, const Header& header, TableChecksums& checksums) {
    for (const auto& [name, text] : texts_of(header))
        BOLT_TRY(put_meta(database, name, text, checksums.meta));
    BOLT_TRY(put_meta(database, key::state, state_recording, checksums.meta));
    auto obstacle = database.prepare("INSERT INTO obstacle VALUES(?, ?)");
    if (!obstacle) return fail(obstacle.error());
    for (const ObstacleName& named : header.obstacle_names) {
        const std::optional<std::int16_t> number = file_number(named.id);
        if (!number)
            return fail(ErrorCode::failed,
                        fmt::format("obstacle \"{}\" has index {}", named.name, named.id.index()),
                        "an index that a session can number");
        BOLT_TRY(obstacle->run_with(std::int32_t{*number}, std::string_view(named.name)));
        checksums.obstacle.add(row_hash(named));
    }
    return {};
}

Status put_chunk(Database& database, std::uint64_t first_tick, std::size_t count,
                 std::span<const std::byte> data, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO tick_chunk VALUES(?, ?, ?)"));
    checksums.chunk.add(chunk_row_hash(first_tick, count));
    return statement.run_with(first_tick, count, data);
}

Status put_events(Database& database, std::uint64_t first_ordinal,
                  std::span<const lesson::LessonEvent> events, TableChecksums& checksums) {
    if (events.empty()) return {};
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO event VALUES(?, ?, ?, ?, ?, ?)"));
    std::uint64_t ordinal = first_ordinal;
    for (const lesson::LessonEvent& event : events) {
        BOLT_TRY(statement.run_with(ordinal, event.tick, lesson::name(event.kind), event.joint, event.value,
                                    event.text));
        checksums.event.add(row_hash(ordinal++, event));
    }
    return {};
}

Status put_timing(Database& database, const servo::Timing& timing, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement,
                    database.prepare("INSERT OR REPLACE INTO servo_time VALUES(?, ?, ?, ?, ?, ?)"));
    checksums.servo_time = {};  // because all rows are written again
    for (const TimingRow& row : rows_of(timing)) {
        BOLT_TRY(statement.run_with(std::string_view(row.name), row.count, row.min, row.max, row.sum,
                                    std::span<const std::byte>(row.bins)));
        checksums.servo_time.add(row_hash(row));
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
                                    result.strokes, result.done_already, result.out_of_turn));
        const std::uint64_t row = row_hash(i, result);
        if (joint.written_hash)
            checksums.joint.change(*joint.written_hash, row);
        else
            checksums.joint.add(row);
        joint.written_hash = row;
        joint.changed = false;
    }
    return {};
}

Status put_result(Database& database, const lesson::LessonResult& result, TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("INSERT INTO score_reason VALUES(?, ?, ?)"));
    for (std::size_t i = 0; i < result.reasons.size(); ++i) {
        const lesson::Deduction& reason = result.reasons[i];
        BOLT_TRY(statement.run_with(i, reason.points, reason.text));
        checksums.reason.add(row_hash(i, reason));
    }
    const std::string duration = fmt::format("{}", result.duration);
    const std::string score = fmt::format("{}", result.score);
    const std::pair<const char*, std::string_view> values[] = {
        {key::duration, duration}, {key::score, score}, {key::finished, result.finished ? "1" : "0"}};
    for (const auto& [name, value] : values) {
        BOLT_TRY(put_meta(database, name, value, checksums.meta));
    }
    BOLT_TRY_ASSIGN(auto complete, database.prepare("UPDATE meta SET value = ? WHERE key = ?"));
    checksums.meta.change(meta_row_hash(key::state, state_recording),
                          meta_row_hash(key::state, state_complete));
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
