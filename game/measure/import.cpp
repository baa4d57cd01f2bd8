#include "game/measure/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

#include "engine/base/file.hpp"
#include "engine/base/math.hpp"
#include "game/measure/butterworth.hpp"
#include "game/measure/import_checks.hpp"
#include "game/measure/table.hpp"

namespace bolt::measure {

namespace {

constexpr double gap_factor = 5.0;       // a longer step than this multiple of the median is a gap
constexpr std::size_t clipped_run = 20;  // equal extreme values in a row

// Rows of one run in a table.
using Rows = std::vector<std::size_t>;

struct Sampling {
    std::vector<double> time;  // s
    double rate = 0.0;         // Hz, mean
};

Status check_times(const Table& table, const Rows& rows, std::size_t column, const TimeSource& source,
                   const std::vector<double>& time) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < time.size(); ++i) {
        if (time[i] <= time[i - 1])
            return fail(table.error(rows[i], column,
                                    fmt::format("the time {} is not after {}", quantity(time[i], "s"),
                                                quantity(time[i - 1], "s")),
                                    "ascending times; give each run its own file or a \"cycle\" column, or "
                                    "use \"rate_Hz\" if the clock is too coarse"));
        steps.push_back(time[i] - time[i - 1]);
    }
    if (steps.empty()) return {};
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double longest = source.longest_gap > 0.0 ? source.longest_gap : gap_factor * *middle;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i] > longest)
            return fail(table.error(rows[i + 1], column,
                                    fmt::format("there is a gap of {} before this row; the usual step is {}",
                                                quantity(steps[i], "s"), quantity(*middle, "s")),
                                    "samples without gaps; cut the run there, or set \"longest_gap_s\""));
    return {};
}

// `column`: of the times in the table; ignored if the source has a rate.
Result<Sampling> sample_times(const Table& table, const Rows& rows, std::size_t column,
                              const TimeSource& source) {
    Sampling s;
    for (std::size_t i = 0; i < rows.size(); ++i)
        s.time.push_back(source.rate > 0.0 ? static_cast<double>(i) / source.rate
                                           : table.columns[column][rows[i]] * source.unit);
    s.rate = source.rate;
    if (source.rate > 0.0) return s;
    BOLT_TRY(check_times(table, rows, column, source, s.time));
    if (s.time.size() > 1) s.rate = static_cast<double>(s.time.size() - 1) / (s.time.back() - s.time.front());
    return s;
}

// The filter needs even sampling; times that a logger has rounded are even.
Status check_even(const Table& table, const Rows& rows, const Sampling& s) {
    for (std::size_t i = 0; i < s.time.size(); ++i) {
        const double even = s.time.front() + static_cast<double>(i) / s.rate;
        if (std::abs(s.time[i] - even) * s.rate > 2.0)
            return fail(
                table.error(rows[i], "the samples are not evenly spaced in time up to here",
                            "even sampling for \"low_pass_Hz\"; remove the filter, or resample the file"));
    }
    return {};
}

// The values of a channel before its low pass.
Result<std::vector<double>> raw_values(const Rig& rig, const Table& table, const Rows& rows,
                                       std::size_t column, const Channel& channel) {
    const std::string unit = unit_in_name(channel.column);
    if (!unit.empty() && unit != channel.unit_name)
        return fail(rig.error(
            channel.unit_position,
            fmt::format("the unit is {}, but the column is named '{}'", channel.unit_name, channel.column),
            fmt::format("\"{}\", or a column without a unit in its name", unit)));
    std::vector<double> values;
    values.reserve(rows.size());
    for (const std::size_t row : rows) values.push_back(channel.value(table.columns[column][row]));
    return values;
}

Result<std::vector<double>> filtered(const Rig& rig, const Table& table, const Rows& rows,
                                     const Channel& channel, const Sampling& s, std::vector<double> values) {
    if (channel.low_pass == 0.0) return values;
    if (channel.low_pass > max_cut_off_share * s.rate)
        return fail(rig.error(channel.position,
                              fmt::format("the low pass of {} is too high for {} samples per second",
                                          quantity(channel.low_pass, "Hz"), fmt::format("{:.4g}", s.rate)),
                              fmt::format("at most {}", quantity(max_cut_off_share * s.rate, "Hz"))));
    BOLT_TRY(check_even(table, rows, s));
    return zero_phase_low_pass(values, channel.low_pass, s.rate);
}

Result<std::vector<double>> torque_values(const Rig& rig, const Table& table, const Rows& rows,
                                          const Sampling& s) {
    const Channel& channel = rig.torque.channel;
    BOLT_TRY_ASSIGN(auto values, raw_values(rig, table, rows, 0, channel));
    return filtered(rig, table, rows, channel, s, std::move(values));
}

// The angles of a column, as a multi-turn encoder would count them. Adds what was done to `notes`.
Result<std::vector<double>> angle_values(const Rig& rig, const Table& table, const Rows& rows,
                                         std::size_t column, const Sampling& s,
                                         std::vector<std::string>& notes) {
    const Channel& channel = rig.angle.channel;
    BOLT_TRY_ASSIGN(auto values, raw_values(rig, table, rows, column, channel));
    if (const std::size_t wraps = unwrap_turns(values); wraps > 0)
        notes.push_back(
            fmt::format("the angle jumps by nearly a whole turn {} times, as an encoder that starts again at "
                        "0 does; the turns were added",
                        wraps));
    if (const auto jump = find_jump(values, rig.angle.largest_step))
        return fail(table.error(
            rows[jump->sample], column,
            fmt::format("the angle jumps by {} from the sample before; the usual step is at most {}",
                        quantity(to_degrees(jump->step), "degrees"),
                        quantity(to_degrees(jump->usual), "degrees")),
            "samples without gaps; cut the run there, or set \"largest_step_deg\" of the angle"));
    return filtered(rig, table, rows, channel, s, std::move(values));
}

// Subtracts the mean torque of the time at rest.
Status subtract_tare(const Rig& rig, const Table& table, const Rows& rows, const Sampling& s, RigRun& run) {
    if (rig.torque.tare == 0.0) return {};
    std::size_t count = 0;
    double low = 0.0, high = 0.0, sum = 0.0, peak = 0.0;
    for (std::size_t i = 0; i < run.torque.size(); ++i) {
        peak = std::max(peak, std::abs(run.torque[i]));
        if (s.time[i] - s.time.front() > rig.torque.tare) continue;
        low = count == 0 ? run.torque[i] : std::min(low, run.torque[i]);
        high = count == 0 ? run.torque[i] : std::max(high, run.torque[i]);
        sum += run.torque[i];
        ++count;
    }
    if (count < 3)
        return fail(rig.error(
            rig.torque.channel.position,
            fmt::format("the tare of {} has only {} samples", quantity(rig.torque.tare, "s"), count),
            "a longer time at rest"));
    if (high - low > 0.2 * peak)
        return fail(table.error(
            rows[0], fmt::format("the torque changes by {} during the tare", quantity(high - low, "N·m")),
            "a rig at rest at the beginning of the run, or a shorter \"tare_s\""));
    run.zero = sum / static_cast<double>(count);
    for (double& torque : run.torque) torque -= run.zero;
    return {};
}

// Angles over time from another source than the run's own table.
struct AngleTrack {
    std::vector<double> time, angle;
};

// Interpolates; drops samples outside the track.
Status join_angles(const Table& table, const AngleTrack& track, RigRun& run) {
    RigRun joined = run;
    joined.time.clear();
    joined.torque.clear();
    for (std::size_t i = 0; i < run.time.size(); ++i) {
        if (run.time[i] < track.time.front() || run.time[i] > track.time.back()) continue;
        joined.time.push_back(run.time[i]);
        joined.torque.push_back(run.torque[i]);
        joined.angle.push_back(interpolate(track.time, track.angle, run.time[i]));
    }
    joined.unjoined = run.time.size() - joined.time.size();
    if (2 * joined.time.size() < run.time.size())
        return fail(table.error(
            0,
            fmt::format(
                "the angles are known from {:.6g} s to {:.6g} s, but the run lasts from {:.6g} s to {:.6g} s",
                track.time.front(), track.time.back(), run.time.front(), run.time.back()),
            "times of one clock; \"delay_s\" shifts those of a second file"));
    if (joined.unjoined > 0)
        joined.notes.push_back(
            fmt::format("{} samples without an angle at their time were dropped", joined.unjoined));
    run = std::move(joined);
    return {};
}

Result<AngleTrack> second_track(const Rig& rig, const RunText& text, std::vector<std::string>& notes) {
    const AngleSource& source = rig.angle;
    std::vector<std::string> wanted{source.channel.column};
    if (!source.second_time.column.empty()) wanted.push_back(source.second_time.column);
    BOLT_TRY_ASSIGN(const auto table, parse_table(text.second_text, text.second_file, rig.table, wanted));
    Rows rows(table.rows());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    BOLT_TRY_ASSIGN(auto s, sample_times(table, rows, 1, source.second_time));
    if (rows.size() < 2) return fail(table.error(0, "this file has only one row", "two or more"));
    AngleTrack track;
    BOLT_TRY_ASSIGN(auto angles, angle_values(rig, table, rows, 0, s, notes));
    track.angle = std::move(angles);
    for (double& time : s.time) time += source.delay;
    track.time = std::move(s.time);
    return track;
}

Status add_angles(const Rig& rig, const Table& table, const Rows& rows, const Sampling& s,
                  const AngleTrack& second, RigRun& run) {
    const AngleSource& source = rig.angle;
    const double turning = rig.direction == joint::Direction::tighten ? 1.0 : -1.0;
    switch (source.kind) {
        case AngleKind::column: {
            BOLT_TRY_ASSIGN(auto angles, angle_values(rig, table, rows, 1, s, run.notes));
            run.angle = std::move(angles);
            return {};
        }
        case AngleKind::speed:
            for (const double t : run.time)
                run.angle.push_back(turning * source.speed *
                                    std::max(0.0, t - run.time.front() - rig.torque.tare));
            return {};
        case AngleKind::points: {
            AngleTrack track;
            for (const AnglePoint& p : source.points) {
                track.time.push_back(p.time);
                track.angle.push_back(p.angle);
            }
            return join_angles(table, track, run);
        }
        case AngleKind::second_file:
            break;
    }
    return join_angles(table, second, run);
}

void add_uncertainty(const Rig& rig, RigRun& run) {
    const TorqueChannel& t = rig.torque;
    const Channel& c = t.channel;
    const double constant = square(c.resolution) / 12.0 + square(c.uncertainty);
    for (const double torque : run.torque) {
        const double value = torque / t.factor();
        const double u_value = constant + square(c.relative_uncertainty * value);
        run.u_torque.push_back(std::sqrt(square(t.factor()) * u_value + square(value * t.lever_uncertainty)));
    }
    const Channel& a = rig.angle.channel;
    run.u_angle = std::sqrt(square(a.resolution) / 12.0 + square(a.uncertainty));
}

// Many equal extreme values in a row: the amplifier was at its limit.
void note_clipping(const Table& table, const Rows& rows, RigRun& run) {
    std::vector<double> raw;
    for (const std::size_t row : rows) raw.push_back(table.columns[0][row]);
    const double extreme = raw[extreme_index(raw)];
    std::size_t equal = 0, longest = 0;
    for (const double value : raw) {
        equal = value == extreme ? equal + 1 : 0;
        longest = std::max(longest, equal);
    }
    if (longest >= clipped_run && longest < raw.size())
        run.notes.push_back(fmt::format(
            "the torque stays at its largest value for {} samples: the amplifier may have been at its limit",
            longest));
}

// Standard deviation of what the low pass removed, from the median of its magnitude: the steps where a hand
// lets go of the wrench are not noise.
double noise_of(const Rig& rig, const Table& table, const Rows& rows, const std::vector<double>& filtered) {
    std::vector<double> removed;
    for (std::size_t i = 0; i < rows.size(); ++i)
        removed.push_back(std::abs(rig.torque.channel.value(table.columns[0][rows[i]]) - filtered[i]));
    const auto middle = removed.begin() + static_cast<std::ptrdiff_t>(removed.size() / 2);
    std::nth_element(removed.begin(), middle, removed.end());
    return 1.4826 * *middle;  // of a normal distribution
}

Result<RigRun> import_run(const Rig& rig, const Table& table, const Rows& rows, std::size_t time_column,
                          const std::string& name, const AngleTrack& second) {
    RigRun run;
    run.name = name;
    run.file = table.file;
    if (rows.size() < analysis::min_samples)
        return fail(table.error(rows[0], fmt::format("{} has only {} samples", name, rows.size()),
                                fmt::format("at least {}", analysis::min_samples)));
    BOLT_TRY_ASSIGN(auto s, sample_times(table, rows, time_column, rig.time));
    run.rate = s.rate;
    const double factor = rig.torque.factor();
    BOLT_TRY_ASSIGN(auto torque, torque_values(rig, table, rows, s));
    run.torque = std::move(torque);
    if (rig.torque.channel.low_pass > 0.0) run.noise = factor * noise_of(rig, table, rows, run.torque);
    for (double& value : run.torque) value *= factor;
    run.time = s.time;
    BOLT_TRY(subtract_tare(rig, table, rows, s, run));
    BOLT_TRY(add_angles(rig, table, rows, s, second, run));
    if (run.torque.size() < analysis::min_samples)
        return fail(table.error(rows[0],
                                fmt::format("{} has only {} samples with an angle", name, run.torque.size()),
                                fmt::format("at least {}", analysis::min_samples)));
    BOLT_TRY(check_torque(rig, run));
    BOLT_TRY(check_angle(rig, run));
    note_clipping(table, rows, run);
    add_uncertainty(rig, run);
    run.landmarks = find_landmarks(analysis::make_torque_curve(run.angle, run.torque, rig.direction));
    // The filter correlates neighbouring samples: about 2 f_c of them in a second are independent.
    if (run.landmarks.linear && rig.torque.channel.low_pass > 0.0)
        run.landmarks.linear->slope_error *=
            std::sqrt(std::max(1.0, s.rate / (2.0 * rig.torque.channel.low_pass)));
    BOLT_TRY(check_slope(rig, run));
    return run;
}

}  // namespace

Result<std::vector<RigRun>> import_runs(const Rig& rig, const RunText& text) {
    std::vector<std::string> wanted{rig.torque.channel.column};
    if (rig.angle.kind == AngleKind::column) wanted.push_back(rig.angle.channel.column);
    const std::size_t time_column = wanted.size();
    if (!rig.time.column.empty()) wanted.push_back(rig.time.column);
    BOLT_TRY_ASSIGN(const auto table, parse_table(text.text, text.file, rig.table, wanted, rig.cycle_column));
    AngleTrack second;
    std::vector<std::string> second_notes;
    if (rig.angle.kind == AngleKind::second_file) {
        BOLT_TRY_ASSIGN(auto track, second_track(rig, text, second_notes));
        second = std::move(track);
    }
    std::vector<std::string> names;
    std::map<std::string, Rows> cycles;
    const std::string stem = std::filesystem::path(text.file).stem().string();
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const std::string& name = table.labels.empty() ? stem : table.labels[row];
        const auto [entry, fresh] = cycles.try_emplace(name);
        if (fresh) names.push_back(name);
        entry->second.push_back(row);
    }
    std::vector<RigRun> runs;
    for (const std::string& name : names) {
        BOLT_TRY_ASSIGN(auto run, import_run(rig, table, cycles.at(name), time_column, name, second));
        run.notes.insert(run.notes.end(), second_notes.begin(), second_notes.end());
        runs.push_back(std::move(run));
    }
    return runs;
}

Result<std::vector<RigRun>> import_file(const Rig& rig, const std::filesystem::path& path) {
    RunText text;
    text.file = path.string();
    BOLT_TRY_ASSIGN(auto content, read_file(path, max_table_bytes, ErrorCode::bad_content));
    text.text = std::move(content);
    if (rig.angle.kind == AngleKind::second_file) {
        const std::filesystem::path second = path.parent_path() / (path.stem().string() + rig.angle.ending);
        text.second_file = second.string();
        BOLT_TRY_ASSIGN(auto angles, read_file(second, max_table_bytes, ErrorCode::bad_content));
        text.second_text = std::move(angles);
    }
    return import_runs(rig, text);
}

}  // namespace bolt::measure
