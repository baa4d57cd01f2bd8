#include "tools/assets/models/glyphs.hpp"

#include <cmath>
#include <gp_Ax2.hxx>
#include <utility>

#include "tools/assets/models/solids.hpp"

namespace bolt::models {

namespace {

using Stroke = std::vector<std::pair<double, double>>;

constexpr double glyph_width = 0.6, advance = 0.85;  // as fractions of the height

// The strokes of a character, as points in a box of width 0.6 and height 1.
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
        case '*':
            return {{{0.28, 0.4}, {0.32, 0.4}}};
        case '-':
            return {{{0.08, 0.5}, {0.52, 0.5}}};
        default:
            return {};
    }
}

}  // namespace

double text_width(std::string_view text, double height) {
    return height * (advance * static_cast<double>(text.size()) - (advance - glyph_width));
}

std::vector<TopoDS_Shape> text_strokes(std::string_view text, double height, double stroke, double z0,
                                       double z1) {
    std::vector<TopoDS_Shape> result;
    double left = -0.5 * text_width(text, height);
    for (const char letter : text) {
        for (const Stroke& line : strokes_of(letter)) {
            std::vector<TopoDS_Shape> pieces;
            for (std::size_t i = 0; i < line.size(); ++i) {
                const auto at = [&](std::size_t k) {
                    return gp_Pnt(left + height * line[k].first, height * (line[k].second - 0.5), z0);
                };
                pieces.push_back(cylinder(gp_Ax2(at(i), gp::DZ()), 0.5 * stroke, z1 - z0));
                if (i + 1 == line.size()) continue;
                const gp_Pnt a = at(i), b = at(i + 1);
                const TopoDS_Shape bar =
                    box(gp_Pnt(0.0, -0.5 * stroke, 0.0), gp_Pnt(a.Distance(b), 0.5 * stroke, z1 - z0));
                gp_Trsf placement = shift(a.X(), a.Y(), a.Z());
                placement.Multiply(turn(gp::OZ(), std::atan2(b.Y() - a.Y(), b.X() - a.X())));
                pieces.push_back(moved(bar, placement));
            }
            result.push_back(fused(pieces));
        }
        left += advance * height;
    }
    return result;
}

}  // namespace bolt::models
