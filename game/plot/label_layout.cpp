#include "game/plot/label_layout.hpp"

#include <algorithm>

namespace bolt::plot {

namespace {

double shared(double a, double a_size, double b, double b_size) {
    return std::max(0.0, std::min(a + a_size, b + b_size) - std::max(a, b));
}

double shared_area(const Box& a, const Box& b) {
    return shared(a.x, a.width, b.x, b.width) * shared(a.y, a.height, b.y, b.height);
}

}  // namespace

double text_width(std::string_view words, double size) {
    const auto starts = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    return 0.58 * size * static_cast<double>(std::count_if(words.begin(), words.end(), starts));
}

Box words_box(const Spot& spot, std::string_view words, double size) {
    const double width = text_width(words, size);
    const double share = spot.anchor == Anchor::start ? 0.0 : spot.anchor == Anchor::middle ? 0.5 : 1.0;
    return {spot.at.x - share * width, spot.at.y - 0.8 * size, width, size};
}

std::string_view anchor_style(Anchor anchor) {
    return anchor == Anchor::start ? "" : anchor == Anchor::middle ? " mid" : " end";
}

double Placer::in_the_way(const Box& box) const {
    double area = box.width * box.height - shared_area(box, page_);
    for (const Box& other : taken_) area += shared_area(box, other);
    return area;
}

std::size_t Placer::choose(std::span<const Box> boxes) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < boxes.size(); ++i)
        if (in_the_way(boxes[i]) < in_the_way(boxes[best]) - 1e-6) best = i;
    if (!boxes.empty()) take(boxes[best]);
    return best;
}

Spot Placer::choose(std::span<const Spot> spots, std::string_view words, double size) {
    std::vector<Box> boxes;
    for (const Spot& spot : spots) boxes.push_back(words_box(spot, words, size));
    return spots.empty() ? Spot{} : spots[choose(boxes)];
}

}  // namespace bolt::plot
