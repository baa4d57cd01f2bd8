#include "game/view/labels.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <vector>

#include "engine/text/layout.hpp"

namespace bolt::view {

using lesson::Verdict;

Palette palette_of(content::PaletteKind kind) {
    Palette palette;
    if (kind == content::PaletteKind::usual) return palette;
    palette.due = {0.94F, 0.89F, 0.26F, 1.0F};
    palette.low = {0.92F, 0.92F, 0.95F, 1.0F};
    palette.ok = palette.ok_text = {0.2F, 0.6F, 1.0F, 1.0F};
    palette.high = palette.high_text = {0.9F, 0.35F, 0.0F, 1.0F};
    return palette;
}

Verdict verdict_of(const lesson::JointResult& joint) {
    return joint.condition != joint::JointCondition::intact ? Verdict::high : joint.overall;
}

glm::vec4 color_of(const Palette& palette, Verdict verdict) {
    switch (verdict) {
        case Verdict::low:
            return palette.low;
        case Verdict::ok:
            return palette.ok;
        case Verdict::high:
            return palette.high;
        default:
            return glm::vec4(0.0F);
    }
}

std::string_view symbol_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::low:
            return "▼";
        case Verdict::ok:
            return "●";
        case Verdict::high:
            return "▲";
        default:
            return "";
    }
}

namespace {

constexpr glm::vec2 margin(0.35F, 0.15F);   // em, of a plate (as in engine/render/passes/annotations.cpp)
constexpr float gap = 2.0F;                 // px between two plates
constexpr int sideways = 12, upwards = 24;  // steps tried in each direction
constexpr float step_em = 0.25F;

bool overlap(const LabelBox& a, const LabelBox& b, const glm::vec2& moved) {
    const glm::vec2 low = a.low + moved - gap, high = a.high + moved + gap;
    return low.x < b.high.x && b.low.x < high.x && low.y < b.high.y && b.low.y < high.y;
}

// The length in px by which the moved box extends beyond the picture.
float overhang(const LabelBox& box, const glm::vec2& moved, const glm::vec2& picture) {
    const glm::vec2 low = box.low + moved, high = box.high + moved;
    return std::max(0.0F, -low.x) + std::max(0.0F, -low.y) + std::max(0.0F, high.x - picture.x) +
           std::max(0.0F, high.y - picture.y);
}

// Adds the moves that place the box just beside each box that it overlaps. The grid of steps is too small to
// move it clear of a large one.
void add_escapes(const LabelBox& box, std::span<const LabelBox> placed, std::vector<glm::vec2>& moves) {
    constexpr float clear = gap + 0.01F;
    const auto overlaps = [&](const LabelBox& other) { return overlap(box, other, glm::vec2(0.0F)); };
    for (const LabelBox& other : placed) {
        if (!overlaps(other)) continue;
        moves.emplace_back(other.low.x - box.high.x - clear, 0.0F);
        moves.emplace_back(other.high.x - box.low.x + clear, 0.0F);
        moves.emplace_back(0.0F, other.low.y - box.high.y - clear);
        moves.emplace_back(0.0F, other.high.y - box.low.y + clear);
    }
}

// The shortest move that brings the whole box into the picture.
glm::vec2 move_inside(const LabelBox& box, const glm::vec2& picture) {
    return glm::max(-box.low, glm::vec2(0.0F)) + glm::min(picture - box.high, glm::vec2(0.0F));
}

// The move of least cost at which the box overlaps no placed box; zero if there is none.
glm::vec2 nearest_free(const LabelBox& box, std::span<const LabelBox> placed, float step,
                       const glm::vec2& picture) {
    std::vector<glm::vec2> starts{glm::vec2(0.0F)};
    if (box.anchor_in_picture) starts.push_back(move_inside(box, picture));
    add_escapes(box, placed, starts);
    const float overhang_cost = box.anchor_in_picture ? 1000.0F : 4.0F;
    glm::vec2 best(0.0F);
    float least = 1e9F;
    for (const glm::vec2& start : starts)
        for (int right = -sideways; right <= sideways; ++right)
            for (int up = -upwards; up <= upwards; ++up) {
                const glm::vec2 moved = start + step * glm::vec2(right, -up);
                // Prefers up to down, and above the joint to beside it.
                const float cost = glm::length(moved) + (moved.y > 0.0F ? 0.5F * step : 0.0F) +
                                   0.1F * std::abs(moved.x) + overhang_cost * overhang(box, moved, picture);
                if (cost >= least) continue;
                const auto collides = [&](const LabelBox& other) { return overlap(box, other, moved); };
                if (std::any_of(placed.begin(), placed.end(), collides)) continue;
                least = cost;
                best = moved;
            }
    return best;
}

}  // namespace

LabelBox box_of(const text::Fonts& fonts, const render::Label& label, const render::Eye& eye,
                const glm::vec2& picture) {
    const glm::vec4 clip = eye.clip_from_world * glm::vec4(label.position, 1.0F);
    if (clip.w <= 0.0F) return {};
    const glm::vec2 anchor = (0.5F * glm::vec2(clip) / clip.w + 0.5F) * picture;
    const bool in_picture =
        anchor.x >= 0.0F && anchor.y >= 0.0F && anchor.x <= picture.x && anchor.y <= picture.y;
    const glm::vec2 at = anchor + glm::vec2(label.offset_px.x, -label.offset_px.y);
    const glm::vec2 size = text::lay_out(fonts, label.text, label.anchor.x).size;
    const glm::vec2 left_below = -label.anchor * size - margin,
                    right_above = left_below + size + 2.0F * margin;
    return {at + label.height * glm::vec2(left_below.x, -right_above.y),
            at + label.height * glm::vec2(right_above.x, -left_below.y), true, in_picture};
}

void separate_labels(const text::Fonts& fonts, std::span<render::Label> labels, const render::Eye& eye,
                     const glm::vec2& picture, std::span<const render::Rectangle> occupied) {
    std::vector<LabelBox> boxes;
    for (const render::Label& label : labels) boxes.push_back(box_of(fonts, label, eye, picture));
    std::vector<std::size_t> order(labels.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return boxes[a].high.y > boxes[b].high.y; });
    std::vector<LabelBox> placed;
    for (const render::Rectangle& plate : occupied) placed.push_back({plate.low, plate.high, true});
    for (const std::size_t i : order) {
        LabelBox& box = boxes[i];
        if (!box.visible || labels[i].placement != render::LabelPlacement::on_screen) continue;
        const glm::vec2 best = nearest_free(box, placed, step_em * labels[i].height, picture);
        labels[i].offset_px += glm::vec2(best.x, -best.y);
        box.low += best;
        box.high += best;
        placed.push_back(box);
    }
}

}  // namespace bolt::view
