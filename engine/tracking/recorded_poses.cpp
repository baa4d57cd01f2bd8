#include "engine/tracking/recorded_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "engine/base/csv.hpp"
#include "engine/base/file.hpp"

namespace bolt::tracking {

namespace {

constexpr std::string_view title = "t_s,x_m,y_m,z_m,qw,qx,qy,qz";
constexpr std::size_t columns = 8;
constexpr std::size_t max_recording_size = 128U << 20U;  // bytes
constexpr double max_recorded_value = 1e6;               // s, m
constexpr double unit_tolerance = 1e-3;                  // of the length of a quaternion

Result<BodySample> parse_row(std::string_view line, const FileLine& position) {
    std::array<double, columns> row{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < columns; ++i) {
        at = std::min(line.find_first_not_of(" \t", at), line.size());
        const auto [end, problem] = std::from_chars(line.data() + at, line.data() + line.size(), row[i]);
        if (problem != std::errc() || !(std::abs(row[i]) <= max_recorded_value))
            return position.error(column_at(line, at), fmt::format("column {} is not a number", i + 1),
                                  fmt::format("{} numbers: {}", columns, title));
        at =
            std::min(line.find_first_not_of(" \t", static_cast<std::size_t>(end - line.data())), line.size());
        const bool is_last = i + 1 == columns;
        if (is_last ? at != line.size() : at == line.size() || line[at] != ',')
            return position.error(column_at(line, at), fmt::format("column {} does not end here", i + 1),
                                  is_last ? "the end of the line" : "a comma");
        ++at;
    }
    const auto [time, x, y, z, qw, qx, qy, qz] = row;
    const Quat read(qw, qx, qy, qz);
    const double length = glm::length(read);
    if (std::abs(length - 1.0) > unit_tolerance)
        return position.error(1, fmt::format("the quaternion has the length {:g}", length),
                              "a unit quaternion");
    return BodySample{time, {{x, y, z}, glm::normalize(read)}};
}

}  // namespace

Result<std::vector<BodySample>> parse_recorded_poses(std::string_view text, const std::string& file) {
    std::vector<BodySample> poses;
    FileLine position{file};
    bool titled = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++position.line;
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
        if (line.empty() || line.front() == '#') continue;
        if (!titled) {
            titled = line == title;
            if (!titled) return position.error(1, "the column titles are wrong", std::string(title));
            continue;
        }
        if (poses.size() == max_recorded_poses)
            return position.error(1, "the recording is too long",
                                  fmt::format("at most {} poses", max_recorded_poses));
        BOLT_TRY_ASSIGN(const BodySample pose, parse_row(line, position));
        if (!poses.empty() && pose.time <= poses.back().time)
            return position.error(
                1, fmt::format("the time {:g} s is not after that of the line before", pose.time),
                "times that increase");
        poses.push_back(pose);
    }
    position.line = std::max(position.line, 1);
    if (poses.empty()) return position.error(1, "the recording has no poses", std::string(title));
    return poses;
}

Result<std::vector<BodySample>> load_recorded_poses(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_recording_size, ErrorCode::bad_content));
    return parse_recorded_poses(text, path.string());
}

std::span<const BodySample> poses_between(std::span<const BodySample> poses, double after, double until) {
    const auto first_after = [&](double time) {
        return std::upper_bound(poses.begin(), poses.end(), time,
                                [](double t, const BodySample& pose) { return t < pose.time; });
    };
    const auto begin = first_after(after), end = first_after(std::max(after, until));
    return {begin, end};
}

}  // namespace bolt::tracking
