#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "game/lesson/law.hpp"
#include "game/session/database.hpp"
#include "game/session/session_file.hpp"
#include "game/session/tables.hpp"

namespace bolt::session {

namespace {

constexpr const char* a_session = "a session that boltwright train has recorded";
constexpr std::uint64_t max_rows = 4'000'000;  // in any table; a day has 86,400 seconds

Result<std::int64_t> pragma(Database& database, const char* which) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare(fmt::format("PRAGMA {}", which)));
    BOLT_TRY_ASSIGN(auto row, statement.step());
    return row ? statement.integer(0) : 0;
}

Result<TableChecksum> read_checksum(Database& database, const std::string& file, std::string_view table) {
    BOLT_TRY_ASSIGN(auto statement, database.prepare("SELECT rows, sum FROM seal WHERE name = ?"));
    BOLT_TRY_ASSIGN(auto row, statement.bind(1, table).step());
    if (!row)
        return file_error(file, fmt::format("is damaged: table {} has no checksum", table),
                          "an unmodified session file");
    return TableChecksum{static_cast<std::uint64_t>(statement.integer(0)),
                         static_cast<std::uint64_t>(statement.integer(1))};
}

// Visits each row that `sql` selects and verifies the table's checksum. `visit` returns the row's hash, or
// none if the row's values are out of range.
template <class Visit>
Status for_each_row(Database& database, const std::string& file, std::string_view table, std::string_view sql,
                    Visit visit) {
    const auto damaged = [&](std::string_view why) {
        return file_error(file, fmt::format("is damaged: table {} {}", table, why),
                          "an unmodified session file");
    };
    BOLT_TRY_ASSIGN(const auto expected, read_checksum(database, file, table));
    BOLT_TRY_ASSIGN(auto statement, database.prepare(sql));
    TableChecksum found;
    for (;;) {
        BOLT_TRY_ASSIGN(auto row, statement.step());
        if (!row) break;
        const std::optional<std::uint64_t> sum = visit(statement);
        if (!sum) return damaged("has a value out of range");
        found.add(*sum);
        if (found.rows > std::min(expected.rows, max_rows)) return damaged("has too many rows");
    }
    if (found.rows < expected.rows) return damaged("has lost rows");
    if (found != expected) return damaged("has altered values");
    return {};
}

Result<HeaderTexts> read_meta(Database& database, const std::string& file) {
    HeaderTexts meta;
    BOLT_TRY(for_each_row(database, file, "meta", "SELECT key, value FROM meta", [&](const Statement& row) {
        const auto [entry, isnew] = meta.emplace(row.text(0), row.text(1));
        return std::optional(meta_row_hash(entry->first, row.text(1)));
    }));
    return meta;
}

Status read_obstacles(Database& database, const std::string& file, std::vector<ObstacleName>& names) {
    return for_each_row(database, file, "obstacle", "SELECT id, name FROM obstacle ORDER BY id",
                        [&](const Statement& row) -> std::optional<std::uint64_t> {
                            const auto number = static_cast<std::int16_t>(row.integer(0));
                            const collision::ObstacleId id = obstacle_of_number(number);
                            if (number != row.integer(0) || id.is_none() || !file_number(id))
                                return std::nullopt;
                            names.push_back({id, std::string(row.text(1))});
                            return row_hash(names.back());
                        });
}

// The number of ticks; fails if there is a gap between chunks.
Result<std::uint64_t> count_ticks(Database& database, const std::string& file) {
    std::uint64_t ticks = 0;
    BOLT_TRY(for_each_row(database, file, "tick_chunk",
                          "SELECT first_tick, count FROM tick_chunk ORDER BY first_tick",
                          [&](const Statement& row) -> std::optional<std::uint64_t> {
                              const auto first = static_cast<std::uint64_t>(row.integer(0));
                              const auto count = static_cast<std::uint64_t>(row.integer(1));
                              if (first != ticks || count == 0 || count > max_chunk_ticks)
                                  return std::nullopt;
                              ticks += count;
                              return chunk_row_hash(first, count);
                          }));
    return ticks;
}

std::optional<lesson::JointResult> joint_of(const Statement& row) {
    const auto torque_verdict = lesson::verdict_names.find(row.text(6));
    const auto angle_verdict = lesson::verdict_names.find(row.text(7));
    const auto overall = lesson::verdict_names.find(row.text(8));
    const auto condition = joint::joint_condition_names.find(row.text(9));
    if (!torque_verdict || !angle_verdict || !overall || !condition) return std::nullopt;
    lesson::JointResult joint;
    joint.id = row.text(1);
    joint.torque = row.real(2);
    joint.angle = row.real(3);
    joint.clamp = row.real(4);
    joint.clamp_at_release = row.real(5);
    joint.torque_verdict = *torque_verdict;
    joint.angle_verdict = *angle_verdict;
    joint.overall = *overall;
    joint.condition = *condition;
    joint.strokes = static_cast<int>(row.integer(10));
    joint.done_already = static_cast<int>(row.integer(11));
    joint.out_of_turn = static_cast<int>(row.integer(12));
    return joint;
}

struct OpenedFile {
    Database database;
    std::int64_t format = 0;
};

Result<OpenedFile> open_session(const std::filesystem::path& path, const std::string& file) {
    std::error_code status;
    const std::filesystem::path real = std::filesystem::canonical(path, status);
    if (status) return file_error(file, "cannot be opened: " + status.message(), a_session);
    if (!std::filesystem::is_regular_file(real, status))
        return file_error(file, "is not a session file", a_session);
    if (std::filesystem::file_size(real, status) == 0 && !status)
        return file_error(file, "is empty, not a session file", a_session);

    auto database = Database::open_read_only(real, file);
    if (!database)
        return file_error(file, "cannot be read as a session: " + database.error().what, a_session);
    // One snapshot of the file for the reader's lifetime, also while a lesson is still being recorded.
    BOLT_TRY(database->execute("BEGIN"));
    BOLT_TRY_ASSIGN(const auto application, pragma(*database, "application_id"));
    if (application != application_id)
        return file_error(file, "is a database of another program, not a session file", a_session);
    const auto version = pragma(*database, "user_version");
    if (!version) return fail(version.error());
    if (*version > format_version)
        return file_error(file, fmt::format("was written by a newer version: its format is {}", *version),
                          fmt::format("a format from {} to {}", oldest_format, format_version));
    if (*version < oldest_format)
        return file_error(file, fmt::format("has the unknown format {}", *version),
                          fmt::format("a format from {} to {}", oldest_format, format_version));
    return OpenedFile{std::move(*database), *version};
}

FormatRules rules_of(std::int64_t format) {
    FormatRules rules;
    if (format < 6) rules.law_adaptation = lesson::LawAdaptation::before_format_6;
    rules.tools_yield = format < 8    ? ToolYield::no_law
                        : format == 8 ? ToolYield::all_laws
                                      : ToolYield::mechanistic_law;
    rules.judges_tool_choice = format >= 9;
    rules.rounds_all_loaded_corners = format >= 10;
    rules.allows_narrow_gaps = rules.renders_tool_in_use = format >= 11;
    return rules;
}

}  // namespace

Result<Header> read_header(const std::filesystem::path& path) {
    const std::string file = path.string();
    BOLT_TRY_ASSIGN(auto session, open_session(path, file));
    BOLT_TRY_ASSIGN(const auto meta, read_meta(session.database, file));
    return header_of(meta, file);
}

struct SessionReader::State {
    Database database;
    std::int64_t format = 0;
    std::string file;
    Header header;
    bool complete = false;
    std::uint64_t ticks = 0;
    double duration = 0.0;
    double score = 0.0;
    bool finished = false;
};

SessionReader::SessionReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
SessionReader::SessionReader(SessionReader&& other) noexcept = default;
SessionReader& SessionReader::operator=(SessionReader&& other) noexcept = default;
SessionReader::~SessionReader() = default;

Result<SessionReader> SessionReader::open(const std::filesystem::path& path) {
    const std::string file = path.string();
    BOLT_TRY_ASSIGN(auto session, open_session(path, file));
    Database& database = session.database;
    BOLT_TRY_ASSIGN(auto meta, read_meta(database, file));
    BOLT_TRY_ASSIGN(auto ticks, count_ticks(database, file));
    const bool complete = meta[key::state] == state_complete;
    const auto duration = number<double>(meta[key::duration]);
    const auto score = number<double>(meta[key::score]);
    const bool finished = meta[key::finished] == "1";
    if (complete && (!duration || !score))
        return file_error(file, "is damaged: it is marked complete but has no result",
                          "an unmodified session file");
    BOLT_TRY_ASSIGN(auto header, header_of(meta, file));
    header.rules = rules_of(session.format);
    if (session.format >= 2) {
        BOLT_TRY(read_obstacles(database, file, header.obstacle_names));
    }
    const double recorded = static_cast<double>(ticks) * header.dt;
    return SessionReader(
        std::make_unique<State>(State{std::move(database), session.format, file, std::move(header), complete,
                                      ticks, duration.value_or(recorded), score.value_or(0.0), finished}));
}

const Header& SessionReader::header() const { return state_->header; }
bool SessionReader::complete() const { return state_->complete; }
std::uint64_t SessionReader::tick_count() const { return state_->ticks; }
std::string SessionReader::file() const { return state_->file; }

Result<lesson::LessonResult> SessionReader::result() const {
    lesson::LessonResult result;
    result.duration = state_->duration;
    result.score = state_->score;
    result.finished = state_->finished;
    BOLT_TRY(for_each_row(
        state_->database, state_->file, "joint_result",
        "SELECT ordinal, id, torque_Nm, angle_rad, clamp_N, clamp_at_release_N, torque_verdict, "
        "angle_verdict, overall, condition, strokes, rehits, order_errors FROM joint_result ORDER BY ordinal",
        [&](const Statement& row) -> std::optional<std::uint64_t> {
            auto joint = joint_of(row);
            if (!joint) return std::nullopt;
            result.joints.push_back(std::move(*joint));
            return row_hash(static_cast<std::uint64_t>(row.integer(0)), result.joints.back());
        }));
    BOLT_TRY(for_each_row(
        state_->database, state_->file, "score_reason",
        "SELECT ordinal, points, text FROM score_reason ORDER BY ordinal", [&](const Statement& row) {
            result.reasons.push_back({row.real(1), std::string(row.text(2))});
            return std::optional(row_hash(static_cast<std::uint64_t>(row.integer(0)), result.reasons.back()));
        }));
    return result;
}

Result<std::vector<lesson::LessonEvent>> SessionReader::events() const {
    std::vector<lesson::LessonEvent> events;
    BOLT_TRY(for_each_row(state_->database, state_->file, "event",
                          "SELECT ordinal, tick, kind, joint, value, text FROM event ORDER BY ordinal",
                          [&](const Statement& row) -> std::optional<std::uint64_t> {
                              const auto kind = lesson::event_kind(row.text(2));
                              if (!kind) return std::nullopt;
                              lesson::LessonEvent& event = events.emplace_back();
                              event.tick = static_cast<std::uint64_t>(row.integer(1));
                              event.kind = *kind;
                              event.joint = static_cast<int>(row.integer(3));
                              event.value = row.real(4);
                              event.text = row.text(5);
                              return row_hash(static_cast<std::uint64_t>(row.integer(0)), event);
                          }));
    return events;
}

Result<std::optional<servo::Timing>> SessionReader::timing() const {
    if (state_->format < 2) return std::nullopt;
    std::optional<servo::Timing> timing;
    BOLT_TRY(for_each_row(state_->database, state_->file, "servo_time",
                          "SELECT name, count, least_ns, greatest_ns, sum_ns, bins FROM servo_time",
                          [&](const Statement& row) -> std::optional<std::uint64_t> {
                              const auto bins = row.bytes(5);
                              const TimingRow found{std::string(row.text(0)),
                                                    static_cast<std::uint64_t>(row.integer(1)),
                                                    static_cast<std::uint64_t>(row.integer(2)),
                                                    static_cast<std::uint64_t>(row.integer(3)),
                                                    row.real(4),
                                                    {bins.begin(), bins.end()}};
                              if (!timing) timing.emplace();
                              if (!read_row(*timing, found)) return std::nullopt;
                              return row_hash(found);
                          }));
    return timing;
}

Status SessionReader::for_each_chunk(
    const std::function<void(std::uint64_t, std::span<const TickRecord>)>& visit) const {
    BOLT_TRY_ASSIGN(
        auto statement,
        state_->database.prepare("SELECT first_tick, count, data FROM tick_chunk ORDER BY first_tick"));
    ChunkDecoder decoder;
    std::uint64_t next = 0;
    while (next < state_->ticks) {
        BOLT_TRY_ASSIGN(auto row, statement.step());
        const auto first = row ? static_cast<std::uint64_t>(statement.integer(0)) : 0;
        if (!row || first != next)
            return file_error(state_->file, fmt::format("is damaged: there are no ticks from {} on", next),
                              "an unmodified session file");
        auto ticks =
            decoder.decode(first, static_cast<std::size_t>(statement.integer(1)), statement.bytes(2));
        if (!ticks) return file_error(state_->file, ticks.error().what, ticks.error().expected);
        visit(first, *ticks);
        next += ticks->size();
    }
    return {};
}

}  // namespace bolt::session
