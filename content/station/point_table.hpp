// Tables of measured points, from CSV files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/base/rigid_alignment.hpp"

namespace bolt::content {

inline constexpr std::size_t max_table_points = 1000;

// The first line that is neither blank nor a comment (#) is exactly "ax,ay,az,bx,by,bz"; each further line
// has these numbers: a point in the first frame and the same point in the second, m. Errors name `file`, line
// and column.
Result<std::vector<PointPair>> parse_point_pairs(std::string_view text, const std::string& file);
Result<std::vector<PointPair>> load_point_pairs(const std::filesystem::path& path);

// The same with the columns "x,y,z": points in one frame, m.
Result<std::vector<Vec3>> parse_points(std::string_view text, const std::string& file);
Result<std::vector<Vec3>> load_points(const std::filesystem::path& path);

}  // namespace bolt::content
