// Recorded poses of a tracked body, from a CSV file, in place of a tracker.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/tracking/head_pose.hpp"

namespace bolt::tracking {

inline constexpr std::size_t max_recorded_poses = 1'000'000;

// The first line that is neither blank nor a comment (#) is exactly "t_s,x_m,y_m,z_m,qw,qx,qy,qz"; each
// further line has a time, s, a position in the tracker's frame, m, and a unit quaternion. Times increase. A
// dropout is a gap between times. Errors name `file`, line and column.
Result<std::vector<BodySample>> parse_recorded_poses(std::string_view text, const std::string& file);
Result<std::vector<BodySample>> load_recorded_poses(const std::filesystem::path& path);

// The poses with after < time <= until.
std::span<const BodySample> poses_between(std::span<const BodySample> poses, double after, double until);

}  // namespace bolt::tracking
