// A small cave for tests: front, left, right, floor and ceiling, unfolded on the test screen.
#pragma once

#include "content/displays/display_file.hpp"

namespace bolt::test {

inline constexpr int cave_pixels = 80;        // per m
inline constexpr double cave_half = 1.5;      // m, of its width and depth
inline constexpr double cave_height = 2.4;    // m
inline constexpr std::size_t cave_walls = 5;  // in the order of the enumerators
enum class CaveWall : std::uint8_t { left, front, right, floor, ceiling };

inline content::DisplayFile small_cave() {
    constexpr double half = cave_half, top = cave_height;
    constexpr int edge = 240, upwards = 192;  // px
    const auto wall = [](const char* name, const Vec3& lower_left, const Vec3& lower_right,
                         const Vec3& upper_right, content::PixelPosition at, content::PixelSize size) {
        content::Wall made;
        made.name = name;
        made.lower_left = lower_left;
        made.lower_right = lower_right;
        made.upper_right = upper_right;
        made.output.position = at;
        made.output.resolution = size;
        return made;
    };
    content::DisplayFile file;
    file.head.fixed_head.position = {0.0, 1.65, 0.3};
    file.walls = {
        wall("left", {-half, 0, half}, {-half, 0, -half}, {-half, top, -half}, {0, edge}, {edge, upwards}),
        wall("front", {-half, 0, -half}, {half, 0, -half}, {half, top, -half}, {edge, edge}, {edge, upwards}),
        wall("right", {half, 0, -half}, {half, 0, half}, {half, top, half}, {2 * edge, edge},
             {edge, upwards}),
        wall("floor", {-half, 0, half}, {half, 0, half}, {half, 0, -half}, {edge, edge + upwards},
             {edge, edge}),
        wall("ceiling", {-half, top, -half}, {half, top, -half}, {half, top, half}, {edge, 0}, {edge, edge}),
    };
    return file;
}

}  // namespace bolt::test
