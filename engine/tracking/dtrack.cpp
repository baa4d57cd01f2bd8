#include "engine/tracking/dtrack.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <glm/mat3x3.hpp>

namespace bolt::tracking {

namespace {

constexpr double max_tracked_distance = 1000.0;  // m

// Reads tokens from the front of a line.
class LineReader {
  public:
    explicit LineReader(std::string_view line) : rest_(line) {}

    bool word(std::string_view expected) {
        skip_blanks();
        const std::size_t end = std::min(rest_.find_first_of(" \t["), rest_.size());
        if (rest_.substr(0, end) != expected) return false;
        rest_.remove_prefix(end);
        return true;
    }
    bool sign(char expected) {
        skip_blanks();
        if (rest_.empty() || rest_.front() != expected) return false;
        rest_.remove_prefix(1);
        return true;
    }
    template <class Number>
    bool number(Number& value) {
        skip_blanks();
        if (rest_.starts_with('+')) rest_.remove_prefix(1);
        const auto [end, problem] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (problem != std::errc()) return false;
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return rest_.empty() || rest_.front() == ' ' || rest_.front() == '\t' || rest_.front() == ']';
    }
    // "[1 2 3]"
    template <std::size_t N>
    bool numbers(std::array<double, N>& values) {
        return sign('[') && std::all_of(values.begin(), values.end(), [&](double& v) { return number(v); }) &&
               sign(']');
    }
    bool at_end() {
        skip_blanks();
        return rest_.empty();
    }

  private:
    void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }
    std::string_view rest_;
};

bool is_rotation(const glm::dmat3& m) {
    for (int i = 0; i < 3; ++i) {
        if (!finite(m[i])) return false;
        for (int j = 0; j <= i; ++j)
            if (!(std::abs(glm::dot(m[i], m[j]) - (i == j ? 1.0 : 0.0)) <= rotation_tolerance)) return false;
    }
    return glm::determinant(m) > 0.0;
}

// The pose of a position, mm, and the columns of a matrix; none if they are no pose.
std::optional<Pose> pose_of(const double* position, const std::array<double, 9>& b) {
    const glm::dmat3 matrix(b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7], b[8]);
    const Vec3 at = Vec3(position[0], position[1], position[2]) * mm;
    const bool is_near = glm::length(at) <= max_tracked_distance;  // false for NaN
    if (!is_near || !is_rotation(matrix)) return std::nullopt;
    return Pose{at, glm::normalize(glm::quat_cast(matrix))};
}

// Returns false if the text of the body is damaged.
bool read_body(LineReader& line, DtrackFrame& frame) {
    DtrackBody body;
    std::array<double, 6> position{};  // mm, then three angles that are not used
    std::array<double, 9> b{};
    if (!line.sign('[') || !line.number(body.id) || !line.number(body.quality) || !line.sign(']') ||
        !line.numbers(position) || !line.numbers(b))
        return false;
    if (body.quality < 0.0) return true;  // not seen
    const auto pose = pose_of(position.data(), b);
    if (!pose || !std::isfinite(body.quality)) {
        ++frame.invalid_bodies;
        return true;
    }
    body.pose = *pose;
    frame.bodies.push_back(body);
    return true;
}

bool read_bodies(LineReader& line, DtrackFrame& frame) {
    std::size_t count = 0;
    if (!line.number(count) || count > max_dtrack_bodies) return false;
    for (std::size_t i = 0; i < count; ++i)
        if (!read_body(line, frame)) return false;
    return line.at_end();
}

// Adds a flystick, with the pose if the cameras see it and the pose is valid.
void add_flystick(DtrackFrame& frame, DtrackFlystick& flystick, double quality, const double* position,
                  const std::array<double, 9>& matrix) {
    if (quality >= 0.0) flystick.pose = pose_of(position, matrix);
    if (quality >= 0.0 && !flystick.pose) ++frame.invalid_bodies;
    frame.flysticks.push_back(flystick);
}

// Returns false if the text of the flystick is damaged.
bool read_flystick(LineReader& line, DtrackFrame& frame) {
    constexpr int max_controls = 256;
    DtrackFlystick flystick;
    double quality = 0.0;
    int buttons = 0, controllers = 0;
    std::array<double, 3> position{};
    std::array<double, 9> matrix{};
    if (!line.sign('[') || !line.number(flystick.id) || !line.number(quality) || !line.number(buttons) ||
        !line.number(controllers) || !line.sign(']') || !line.numbers(position) || !line.numbers(matrix) ||
        !line.sign('['))
        return false;
    if (buttons < 0 || buttons > max_controls || controllers < 0 || controllers > max_controls) return false;
    for (int first = 0; first < buttons; first += 32) {
        std::int64_t bits = 0;  // programs print them with or without a sign
        if (!line.number(bits)) return false;
        if (first == 0) flystick.buttons = static_cast<std::uint32_t>(bits);
    }
    for (int i = 0; i < controllers; ++i) {
        double value = 0.0;
        if (!line.number(value) || !std::isfinite(value)) return false;
        if (i == 0) flystick.stick_x = std::clamp(value, -1.0, 1.0);
        if (i == 1) flystick.stick_y = std::clamp(value, -1.0, 1.0);
    }
    if (!line.sign(']')) return false;
    add_flystick(frame, flystick, quality, position.data(), matrix);
    return true;
}

// Returns false if the text of the flystick, of a line 6df, is damaged.
bool read_old_flystick(LineReader& line, DtrackFrame& frame) {
    DtrackFlystick flystick;
    double quality = 0.0;
    std::int64_t buttons = 0;  // with or without a sign, as in line 6df2
    std::array<double, 6> position{};
    std::array<double, 9> matrix{};
    if (!line.sign('[') || !line.number(flystick.id) || !line.number(quality) || !line.number(buttons) ||
        !line.sign(']') || !line.numbers(position) || !line.numbers(matrix))
        return false;
    flystick.buttons = static_cast<std::uint32_t>(buttons);
    add_flystick(frame, flystick, quality, position.data(), matrix);
    return true;
}

template <class ReadOne>
bool read_flysticks(LineReader& line, DtrackFrame& frame, const ReadOne& read_one) {
    std::size_t count = 0;
    if (!line.number(count) || count > max_dtrack_bodies) return false;
    for (std::size_t i = 0; i < count; ++i)
        if (!read_one(line, frame)) return false;
    return line.at_end();
}

// Returns false if the line is damaged. Skips lines of kinds that it does not read.
bool read_line(std::string_view text, DtrackFrame& frame, bool& has_number) {
    LineReader line(text);
    if (line.word("fr")) {
        if (has_number || !line.number(frame.number)) return false;
        has_number = true;
        return line.at_end();
    }
    if (line.word("ts")) {
        double time = 0.0;
        if (!line.number(time) || !std::isfinite(time)) return false;
        frame.time = time;
        return line.at_end();
    }
    if (line.word("6dcal")) {
        int count = 0;
        if (!line.number(count)) return false;
        frame.calibrated_bodies = count;
        return true;
    }
    if (line.word("6df2")) {
        std::size_t calibrated = 0;
        return line.number(calibrated) && read_flysticks(line, frame, read_flystick);
    }
    if (line.word("6df")) return read_flysticks(line, frame, read_old_flystick);
    return !line.word("6d") || read_bodies(line, frame);
}

}  // namespace

std::optional<DtrackFrame> parse_dtrack(std::string_view packet) {
    DtrackFrame frame;
    bool has_number = false;
    while (!packet.empty()) {
        const std::size_t end = std::min(packet.find('\n'), packet.size());
        std::string_view line = packet.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (!read_line(line, frame, has_number)) return std::nullopt;
        packet.remove_prefix(std::min(end + 1, packet.size()));
    }
    if (!has_number || frame.bodies.size() > max_dtrack_bodies || frame.flysticks.size() > max_dtrack_bodies)
        return std::nullopt;
    return frame;
}

const DtrackBody* find_body(const DtrackFrame& frame, int id) {
    const auto it = std::find_if(frame.bodies.begin(), frame.bodies.end(),
                                 [id](const DtrackBody& body) { return body.id == id; });
    return it == frame.bodies.end() ? nullptr : &*it;
}

const DtrackFlystick* find_flystick(const DtrackFrame& frame, int id) {
    const auto it = std::find_if(frame.flysticks.begin(), frame.flysticks.end(),
                                 [id](const DtrackFlystick& flystick) { return flystick.id == id; });
    return it == frame.flysticks.end() ? nullptr : &*it;
}

}  // namespace bolt::tracking
