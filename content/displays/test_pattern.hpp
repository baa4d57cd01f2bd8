// The picture with which an installer checks a wall: its border, whether squares are square, the length of a
// scale, which eye sees which picture, and whether all walls show the same frame. Lines and texts are in the
// wall's plane: m to the right of and above its lower left corner.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "content/displays/display_file.hpp"

namespace bolt::content {

enum class PatternPart : std::uint8_t {
    border,
    diagonal,
    cross,
    scale,
    frame_marks,   // the row of marks, one for each of frame_mark_count frames
    present_mark,  // the mark that is lit in this frame
};

struct PatternLine {
    PatternPart part = PatternPart::border;
    glm::dvec2 from{0.0}, to{0.0};
};

struct PatternText {
    std::string text;
    glm::dvec2 center{0.0};
    double height = 0.0;  // m, height of the line
};

struct TestPattern {
    double scale_length =
        0.0;  // m, between the end marks of each scale; an installer measures it on the wall
    std::vector<PatternLine> lines;
    std::vector<PatternText> texts;
};

// For which eye the picture is shown; both: mono.
enum class PatternEye : std::uint8_t { both, left, right };

inline constexpr int frame_mark_count = 10;

// The pattern consists of
// - the border on the edges of the wall, both diagonals, upright crosses in the middle and near the corners;
// - a horizontal and a vertical scale of `scale_length`: the longest of 1, 0.5, 0.2, 0.1, 0.05 and 0.02 m
//   that is at most 0.4 of the shorter edge, or 0.4 of that edge if even 0.02 m is too long;
// - the name of the wall and the length of the scale;
// - the eye, in the left half of the picture for the left eye and in the right half for the right eye;
// - the number of the frame, and a row of marks. One is lit, the next one in each frame: on a photograph of
//   several walls, lit marks that differ show how many frames apart the walls are.
// It is empty for a wall without width or height.
TestPattern test_pattern(const Wall& wall, PatternEye eye, std::uint64_t frame = 0);

// Converts a point of the pattern to the room.
Vec3 pattern_point(const Wall& wall, const glm::dvec2& point);

}  // namespace bolt::content
