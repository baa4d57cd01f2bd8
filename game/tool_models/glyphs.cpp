#include "game/tool_models/glyphs.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::tool_models {

namespace {

constexpr double glyph_width = 0.6, advance = 0.85;  // as fractions of the height
constexpr double sharpest_turn = 0.65;               // cos 49°; at a sharper turn a new stroke begins
constexpr double slope_share = 0.4;                  // of half the stroke's width: the slope of its sides

// A stroke of constant width and round ends, from z0 to z1; its sides slope inwards.
Shell stroke_shell(const std::vector<Vec2>& line, double half, double z0, double z1) {
    std::vector<Loop> loops;
    const auto add = [&](const Vec2& at, const Vec2& along, double wide) {
        const Vec2 left(-along.y, along.x);
        const double top = wide * (1.0 - slope_share);
        const auto point = [&](double out, double z) {
            const Vec2 p = at + out * left;
            return Vec3(p.x, p.y, z);
        };
        loops.push_back({point(-wide, z0), point(wide, z0), point(top, z1), point(-top, z1)});
    };
    const Vec2 first = glm::normalize(line[1] - line[0]);
    const Vec2 last = glm::normalize(line.back() - line[line.size() - 2]);
    add(line.front() - 0.95 * half * first, first, 0.3 * half);
    add(line.front() - 0.7 * half * first, first, 0.72 * half);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Vec2 in = i == 0 ? first : glm::normalize(line[i] - line[i - 1]);
        const Vec2 out = i + 1 == line.size() ? last : glm::normalize(line[i + 1] - line[i]);
        const Vec2 along = glm::normalize(in + out);
        add(line[i], along, half / std::max(0.6, glm::dot(along, in)));
    }
    add(line.back() + 0.7 * half * last, last, 0.72 * half);
    add(line.back() + 0.95 * half * last, last, 0.3 * half);
    return loft(loops);
}

}  // namespace

std::vector<Stroke> strokes_of(char letter) {
    switch (letter) {
        case '0':
            return {{{0.3, 1.0},
                     {0.12, 0.92},
                     {0.02, 0.72},
                     {0.0, 0.5},
                     {0.02, 0.28},
                     {0.12, 0.08},
                     {0.3, 0.0},
                     {0.48, 0.08},
                     {0.58, 0.28},
                     {0.6, 0.5},
                     {0.58, 0.72},
                     {0.48, 0.92},
                     {0.3, 1.0}}};
        case '1':
            return {{{0.1, 0.78}, {0.34, 1.0}, {0.34, 0.0}}};
        case '2':
            return {{{0.02, 0.76},
                     {0.08, 0.92},
                     {0.22, 1.0},
                     {0.38, 1.0},
                     {0.53, 0.91},
                     {0.58, 0.75},
                     {0.52, 0.57},
                     {0.34, 0.35},
                     {0.0, 0.0},
                     {0.6, 0.0}}};
        case '3':
            return {{{0.03, 0.86},
                     {0.15, 0.98},
                     {0.3, 1.0},
                     {0.47, 0.94},
                     {0.55, 0.77},
                     {0.47, 0.6},
                     {0.27, 0.54},
                     {0.49, 0.47},
                     {0.59, 0.28},
                     {0.5, 0.08},
                     {0.3, 0.0},
                     {0.13, 0.02},
                     {0.0, 0.14}}};
        case '4':
            return {{{0.46, 0.0}, {0.46, 1.0}, {0.0, 0.3}, {0.62, 0.3}}};
        case '5':
            return {{{0.53, 1.0},
                     {0.1, 1.0},
                     {0.05, 0.54},
                     {0.2, 0.61},
                     {0.38, 0.61},
                     {0.54, 0.5},
                     {0.59, 0.31},
                     {0.52, 0.1},
                     {0.32, 0.0},
                     {0.14, 0.01},
                     {0.0, 0.12}}};
        case '6':
            return {{{0.5, 0.98},
                     {0.3, 0.9},
                     {0.1, 0.65},
                     {0.01, 0.35},
                     {0.07, 0.12},
                     {0.28, 0.0},
                     {0.48, 0.07},
                     {0.59, 0.28},
                     {0.52, 0.5},
                     {0.32, 0.58},
                     {0.12, 0.5},
                     {0.02, 0.33}}};
        case '7':
            return {{{0.0, 1.0}, {0.6, 1.0}, {0.2, 0.0}}};
        case '8':
            return {{{0.3, 0.55},
                     {0.12, 0.63},
                     {0.05, 0.79},
                     {0.13, 0.94},
                     {0.3, 1.0},
                     {0.47, 0.94},
                     {0.55, 0.79},
                     {0.48, 0.63},
                     {0.3, 0.55},
                     {0.08, 0.44},
                     {0.0, 0.26},
                     {0.1, 0.07},
                     {0.3, 0.0},
                     {0.5, 0.07},
                     {0.6, 0.26},
                     {0.52, 0.44},
                     {0.3, 0.55}}};
        case '9':
            return {{{0.1, 0.02},
                     {0.3, 0.1},
                     {0.5, 0.35},
                     {0.59, 0.65},
                     {0.53, 0.88},
                     {0.32, 1.0},
                     {0.12, 0.93},
                     {0.01, 0.72},
                     {0.08, 0.5},
                     {0.28, 0.42},
                     {0.48, 0.5},
                     {0.58, 0.67}}};
        case 'C':
            return {{{0.58, 0.84},
                     {0.46, 0.97},
                     {0.3, 1.0},
                     {0.12, 0.92},
                     {0.02, 0.72},
                     {0.0, 0.5},
                     {0.02, 0.28},
                     {0.12, 0.08},
                     {0.3, 0.0},
                     {0.46, 0.03},
                     {0.58, 0.16}}};
        case 'N':
            return {{{0.0, 0.0}, {0.0, 1.0}, {0.58, 0.0}, {0.58, 1.0}}};
        case 'R':
            return {{{0.0, 0.0},
                     {0.0, 1.0},
                     {0.36, 1.0},
                     {0.52, 0.92},
                     {0.57, 0.75},
                     {0.52, 0.58},
                     {0.36, 0.5},
                     {0.0, 0.5}},
                    {{0.3, 0.5}, {0.6, 0.0}}};
        case 'V':
            return {{{0.0, 1.0}, {0.3, 0.0}, {0.6, 1.0}}};
        case 'm':
            return {{{0.0, 0.0}, {0.0, 0.62}},
                    {{0.0, 0.5}, {0.14, 0.63}, {0.28, 0.55}, {0.3, 0.4}, {0.3, 0.0}},
                    {{0.3, 0.5}, {0.44, 0.63}, {0.58, 0.55}, {0.6, 0.4}, {0.6, 0.0}}};
        case '.':
            return {{{0.28, 0.02}, {0.32, 0.02}}};
        case '*':
            return {{{0.28, 0.4}, {0.32, 0.4}}};
        case '-':
            return {{{0.08, 0.5}, {0.52, 0.5}}};
        default:
            return {};
    }
}

double text_width(std::string_view text, double height) {
    return height * (advance * static_cast<double>(text.size()) - (advance - glyph_width));
}

std::vector<PlacedStroke> text_lines(std::string_view text, double height) {
    std::vector<PlacedStroke> lines;
    double left = -0.5 * text_width(text, height);
    for (const char letter : text) {
        for (const Stroke& stroke : strokes_of(letter)) {
            PlacedStroke line;
            for (const auto& [x, y] : stroke) line.emplace_back(left + height * x, height * (y - 0.5));
            lines.push_back(std::move(line));
        }
        left += advance * height;
    }
    return lines;
}

std::vector<Shell> text_shells(std::string_view text, double height, double stroke, double z0, double z1) {
    std::vector<Shell> shells;
    for (const PlacedStroke& line : text_lines(text, height)) {
        std::vector<Vec2> smooth{line.front()};
        for (std::size_t i = 1; i < line.size(); ++i) {
            smooth.push_back(line[i]);
            const bool sharp =
                i + 1 < line.size() && glm::dot(glm::normalize(line[i] - line[i - 1]),
                                                glm::normalize(line[i + 1] - line[i])) < sharpest_turn;
            if (!sharp && i + 1 < line.size()) continue;
            shells.push_back(stroke_shell(smooth, 0.5 * stroke, z0, z1));
            smooth = {line[i]};
        }
    }
    return shells;
}

}  // namespace bolt::tool_models
