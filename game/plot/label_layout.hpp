// Words in a drawing, placed so that they touch neither each other nor what is drawn.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "game/plot/svg.hpp"

namespace bolt::plot {

// Roughly, in a wide typeface and letter by letter of UTF-8. On narrow screens the style sheet takes larger
// letters, so ask for those.
double text_width(std::string_view words, double size);

// Where words stand for an anchor: the style sheet's "mid" and "end", else they start at it.
enum class Anchor { start, middle, end };

struct Spot {
    Point at;  // of the words' base line
    Anchor anchor = Anchor::start;
};

Box words_box(const Spot& spot, std::string_view words, double size);
std::string_view anchor_style(Anchor anchor);  // " mid", " end" or nothing

class Placer {
  public:
    explicit Placer(Box page) : page_(page) {}

    void take(const Box& box) { taken_.push_back(box); }

    // The first of the boxes that lies on the page and touches nothing taken, else the one that is least in
    // the way. It is taken then.
    std::size_t choose(std::span<const Box> boxes);

    // The same for words.
    Spot choose(std::span<const Spot> spots, std::string_view words, double size);

  private:
    [[nodiscard]] double in_the_way(const Box& box) const;

    Box page_;
    std::vector<Box> taken_;
};

}  // namespace bolt::plot
