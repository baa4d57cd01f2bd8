#include "haptics/hand/glove_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::hand {

namespace {

constexpr double min_span = 5.0;  // counts; a smaller span is not a usable measurement
constexpr std::array<const char*, posture_count> posture_names = {"flat hand", "fist", "spread hand",
                                                                  "thumb across"};

bool is_mpj(Sensor s) {
    return s == Sensor::index_mpj || s == Sensor::middle_mpj || s == Sensor::ring_mpj ||
           s == Sensor::little_mpj;
}
bool is_pij(Sensor s) {
    return s == Sensor::index_pij || s == Sensor::middle_pij || s == Sensor::ring_pij ||
           s == Sensor::little_pij;
}

std::optional<double> degrees_in(Posture posture, Sensor s) {
    switch (posture) {
        case Posture::flat:
            return 0.0;  // fingers and thumb side by side, wrist straight
        case Posture::fist:
            if (is_mpj(s)) return 90.0;
            if (is_pij(s)) return 100.0;
            if (is_dij(s)) return 65.0;
            if (s == Sensor::palm_arch) return 25.0;
            return std::nullopt;
        case Posture::spread:
            if (s == Sensor::thumb_abduction) return 50.0;
            if (s == Sensor::middle_abduction) return 20.0;
            if (s == Sensor::ring_abduction) return 18.0;
            if (s == Sensor::little_abduction) return 25.0;
            return std::nullopt;
        case Posture::thumb_across:
            if (s == Sensor::thumb_roll) return 60.0;
            if (s == Sensor::thumb_mpj) return 50.0;
            if (s == Sensor::thumb_ij) return 60.0;
            return std::nullopt;
    }
    return std::nullopt;
}

struct PostureReading {
    double raw = 0.0, angle = 0.0, deviation = 0.0;
    Posture posture = Posture::flat;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// The reading of a sensor in a posture; nullopt if the posture does not define the sensor's angle or has no
// samples of the sensor.
std::optional<PostureReading> posture_reading(const PostureSamples& held, Sensor sensor) {
    const std::optional<double> at = posture_angle(held.posture, sensor);
    if (!at) return std::nullopt;
    std::vector<double> raw;
    for (const auto& sample : held.samples)
        if (sample[index(sensor)] != 0) raw.push_back(sample[index(sensor)]);
    if (raw.empty()) return std::nullopt;
    double mean = 0.0, squares = 0.0;
    for (const double r : raw) mean += r / static_cast<double>(raw.size());
    for (const double r : raw) squares += square(r - mean) / static_cast<double>(raw.size());
    return PostureReading{median(raw), *at, std::sqrt(squares), held.posture};
}

// Least-squares fit of angle over raw reading.
std::optional<LinearFit> fit_line(const std::vector<PostureReading>& at) {
    double raw = 0.0, angle = 0.0;
    const auto n = static_cast<double>(at.size());
    for (const PostureReading& s : at) {
        raw += s.raw / n;
        angle += s.angle / n;
    }
    double both = 0.0, raws = 0.0;
    for (const PostureReading& s : at) {
        both += (s.raw - raw) * (s.angle - angle);
        raws += square(s.raw - raw);
    }
    if (!(raws > 0.0) || both == 0.0) return std::nullopt;
    const double gain = both / raws;
    return LinearFit{gain, raw - angle / gain};
}

double score_of(const SensorQuality& q) {
    return 1.0 / ((1.0 + square(poor_span / q.span)) * (1.0 + square(q.noise / poor_noise)));
}

}  // namespace

std::optional<double> posture_angle(Posture posture, Sensor sensor) {
    const std::optional<double> degrees = degrees_in(posture, sensor);
    return degrees ? std::optional(to_radians(*degrees)) : std::nullopt;
}

Result<CalibrationResult> calibrate(std::span<const PostureSamples> held) {
    const auto has_posture = [&](Posture posture) {
        return std::any_of(held.begin(), held.end(),
                           [&](const PostureSamples& h) { return h.posture == posture; });
    };
    for (const Posture posture : {Posture::flat, Posture::fist})
        if (!has_posture(posture))
            return fail(ErrorCode::failed,
                        fmt::format("the posture \"{}\" is missing",
                                    posture_names[static_cast<std::size_t>(posture)]),
                        "at least a flat hand and a fist");
    for (const PostureSamples& h : held)
        if (h.samples.empty())
            return fail(ErrorCode::failed,
                        fmt::format("the glove sent no samples of the {}",
                                    posture_names[static_cast<std::size_t>(h.posture)]),
                        "samples of each posture");

    CalibrationResult result;
    result.score = 1.0;
    bool any = false, trembled = false;
    for (std::size_t i = 0; i < sensor_count; ++i) {
        const auto sensor = static_cast<Sensor>(i);
        std::vector<PostureReading> at;
        for (const PostureSamples& h : held)
            if (const auto s = posture_reading(h, sensor)) at.push_back(*s);
        if (at.size() < 2) continue;  // not a sensor of this glove, or the postures do not determine it
        const auto [low, high] = std::minmax_element(
            at.begin(), at.end(),
            [](const PostureReading& a, const PostureReading& b) { return a.raw < b.raw; });
        SensorQuality& q = result.quality[i];
        q.span = high->raw - low->raw;
        any = true;
        const std::optional<LinearFit> line = q.span >= min_span ? fit_line(at) : std::nullopt;
        if (!line) {
            result.score = 0.0;
            result.remarks.push_back(fmt::format(
                "{}: moved by {:.0f} counts; expected at least {:.0f}: check that the glove is worn "
                "properly, and repeat the posture",
                name_of(sensor), q.span, min_span));
            continue;
        }
        for (const PostureReading& s : at) q.noise = std::max(q.noise, std::abs(line->gain) * s.deviation);
        trembled = trembled || q.noise > poor_noise;
        result.calibration.fits[i] = line;
        result.score = std::min(result.score, score_of(q));
    }
    if (!any)
        return fail(ErrorCode::failed, "no sensor has readings in two postures",
                    "a glove whose finger sensors are connected");
    if (trembled)
        result.remarks.emplace_back("the hand moved while a posture was held; hold still for two seconds");
    return result;
}

namespace {

constexpr std::size_t blocks = 6, lines_of_block = 4;
constexpr std::size_t offset_word = 5, gain_word = 8;  // from 0
constexpr double max_gain = 0.2;                       // rad per count; 255 counts would be eight turns

// The sensor of each line; nullopt: none.
constexpr std::array<std::array<std::optional<Sensor>, lines_of_block>, blocks> sensor_order = {{
    {Sensor::thumb_roll, Sensor::thumb_mpj, Sensor::thumb_ij, Sensor::thumb_abduction},
    {Sensor::index_mpj, Sensor::index_pij, Sensor::index_dij, std::nullopt},
    {Sensor::middle_mpj, Sensor::middle_pij, Sensor::middle_dij, Sensor::middle_abduction},
    {Sensor::ring_mpj, Sensor::ring_pij, Sensor::ring_dij, Sensor::ring_abduction},
    {Sensor::little_mpj, Sensor::little_pij, Sensor::little_dij, Sensor::little_abduction},
    {Sensor::palm_arch, Sensor::wrist_pitch, Sensor::wrist_yaw, std::nullopt},
}};
constexpr std::size_t index_block = 1, gain_of_middle_abduction = 3;

struct Word {
    std::string_view text;
    int column = 1;
};

std::vector<Word> words_of(std::string_view line) {
    std::vector<Word> words;
    constexpr std::string_view blank = " \t\r";
    for (std::size_t at = line.find_first_not_of(blank); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
        words.push_back({line.substr(at, end - at), static_cast<int>(at) + 1});
        at = line.find_first_not_of(blank, end);
    }
    return words;
}

struct CalFileReader {
    std::string_view left;
    const std::string& file;
    int line = 0;

    [[nodiscard]] tl::unexpected<Error> error_at(int column, std::string what, std::string expected) const {
        Error error;
        error.code = ErrorCode::bad_content;
        error.what = std::move(what);
        error.expected = std::move(expected);
        error.file = file;
        error.line = line;
        error.column = column;
        return fail(std::move(error));
    }
    Result<std::string_view> next(const char* expected) {
        ++line;
        if (left.empty()) return error_at(1, "the calibration ends here", expected);
        const std::size_t end = std::min(left.find('\n'), left.size());
        const std::string_view text = left.substr(0, end);
        left.remove_prefix(std::min(end + 1, left.size()));
        return text;
    }
    [[nodiscard]] Result<double> number(const std::vector<Word>& words, std::size_t i,
                                        const char* what) const {
        if (i >= words.size())
            return error_at(words.empty() ? 1 : words.back().column,
                            fmt::format("the line has {} words", words.size()),
                            fmt::format("the {} as word {}", what, i + 1));
        double value = 0.0;
        const std::string_view text = words[i].text;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
            return error_at(words[i].column, fmt::format("\"{}\" is not a number", text.substr(0, 40)),
                            fmt::format("the {}", what));
        return value;
    }
};

}  // namespace

Result<Calibration> parse_cal(std::string_view text, const std::string& file) {
    CalFileReader reader{text, file};
    BOLT_TRY(reader.next("a title line"));
    Calibration calibration;
    std::optional<double> middle_abduction_gain;
    for (std::size_t block = 0; block < blocks; ++block) {
        BOLT_TRY(reader.next("the heading of a finger or of the palm"));
        for (std::size_t i = 0; i < lines_of_block; ++i) {
            BOLT_TRY_ASSIGN(const auto line, reader.next("a sensor's line"));
            const auto words = words_of(line);
            BOLT_TRY_ASSIGN(const auto offset, reader.number(words, offset_word, "offset in counts"));
            BOLT_TRY_ASSIGN(const auto gain, reader.number(words, gain_word, "gain in radians per count"));
            if (std::abs(gain) > max_gain)
                return reader.error_at(words[gain_word].column,
                                       fmt::format("a gain of {} rad per count", gain),
                                       fmt::format("at most {}", max_gain));
            if (block == index_block && i == gain_of_middle_abduction) middle_abduction_gain = gain;
            const auto& sensor = sensor_order[block][i];
            if (sensor && gain != 0.0) calibration.fits[index(*sensor)] = LinearFit{gain, offset};
        }
    }
    auto& abduction = calibration.fits[index(Sensor::middle_abduction)];
    if (abduction && middle_abduction_gain && *middle_abduction_gain != 0.0)
        abduction->gain = *middle_abduction_gain;
    return calibration;
}

namespace {

double max_difference(const PerSensor<std::uint8_t>& a, const PerSensor<std::uint8_t>& b) {
    int most = 0;
    for (std::size_t i = 0; i < sensor_count; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
}

void restart_posture(CalibrationSession& session, double now) {
    if (session.phase == CalibrationPhase::holding) session.taken.pop_back();
    session.phase = CalibrationPhase::moving;
    session.held_for = 0.0;
    session.still_since = now;
}

void finish(CalibrationSession& session) {
    Result<CalibrationResult> calibrated = calibrate(session.taken);
    session.phase = calibrated ? CalibrationPhase::done : CalibrationPhase::failed;
    if (calibrated)
        session.result = std::move(*calibrated);
    else
        session.failure = std::move(calibrated.error());
}

// Continues with the next posture, or finishes after the last.
void next(CalibrationSession& session, double now) {
    const auto number = static_cast<std::size_t>(session.requested) + 1;
    session.problem = CalibrationProblem::none;
    session.held_for = 0.0;
    if (number == posture_count) return finish(session);
    session.phase = CalibrationPhase::moving;
    session.requested = static_cast<Posture>(number);
    session.requested_since = session.still_since = now;
}

}  // namespace

const char* prompt(Posture posture) {
    switch (posture) {
        case Posture::flat:
            return "Hold the hand flat, fingers and thumb straight and side by side.";
        case Posture::fist:
            return "Make a fist, the thumb outside.";
        case Posture::spread:
            return "Hold the hand flat and spread fingers and thumb as wide as they go.";
        case Posture::thumb_across:
            return "Lay the bent thumb across the palm of the flat hand.";
    }
    return "";
}

const char* message_for(CalibrationProblem problem) {
    switch (problem) {
        case CalibrationProblem::none:
            return "";
        case CalibrationProblem::silent:
            return "The glove sends no data; is it switched on and plugged in?";
        case CalibrationProblem::restless:
            return "Take the posture and hold the hand still for two seconds.";
    }
    return "";
}

void update(CalibrationSession& session, const GloveFrame* frame, double now) {
    if (session.phase == CalibrationPhase::done || session.phase == CalibrationPhase::failed) return;
    if (!session.started) {
        session.started = true;
        session.requested_since = session.still_since = session.last_frame = now;
    }
    if (now - session.last_frame > session.options.silence) {
        restart_posture(session, now);
        session.problem = CalibrationProblem::silent;
    }
    if (frame == nullptr) return;
    if (session.problem == CalibrationProblem::silent) session.problem = CalibrationProblem::none;
    session.last_frame = now;
    if (max_difference(frame->raw, session.rest) > session.options.still) {
        restart_posture(session, now);
        session.rest = frame->raw;
    }
    if (session.phase == CalibrationPhase::moving) {
        if (now - session.requested_since > session.options.problem_delay)
            session.problem = CalibrationProblem::restless;
        const bool left =
            session.taken.empty() ||
            max_difference(session.rest, session.taken.back().samples.front()) >= session.options.moved;
        if (!left || now - session.still_since < session.options.settle) return;
        session.phase = CalibrationPhase::holding;
        session.taken.push_back({session.requested, {}});
        session.still_since = now;
    }
    session.taken.back().samples.push_back(frame->raw);
    session.held_for = now - session.still_since;
    if (session.held_for >= session.options.hold) next(session, now);
}

}  // namespace bolt::hand
