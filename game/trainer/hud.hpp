// What sounds say, for those who do not hear them: read off the same numbers that are made audible. Pure; a
// caption stands long enough to be read and no longer, and what goes on is one caption, not many.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "content/words/words.hpp"
#include "engine/render/overlay.hpp"
#include "game/lesson/hints.hpp"
#include "game/lesson/lesson.hpp"
#include "game/sound/synth.hpp"

namespace bolt::trainer {

struct ActiveLesson;

// What matters most first.
enum class Caption : std::uint8_t {
    slip,
    mistake,
    click,
    done,
    strike_casing,
    strike_nut,
    groan,
    scrape,
    run
};
inline constexpr std::size_t caption_count = 9;
inline constexpr std::size_t most_captions = 3;  // at once
inline constexpr double caption_stands = 2.0;    // s

struct Captions {
    std::array<double, caption_count> left{};   // s that each of them is still shown
    std::array<double, caption_count> heard{};  // 0 … 1, of what it takes until what goes on is said
};

// A tick of `dt` seconds.
void note(Captions& captions, const sound::Heard& heard, double dt);
// A frame has passed.
void update(Captions& captions, double seconds);
std::vector<Caption> shown(const Captions& captions);

words::Key term(Caption caption);

// The plot of a pull: torque over the nut's angle, and the window that it is to end in.

struct PlotPoint {
    float angle = 0.0F;   // deg
    float torque = 0.0F;  // N·m
};

struct Plot {
    std::vector<PlotPoint> points;  // of the joint that the wrench was on last
    int joint = -1;                 // none before the wrench was on a nut
    std::optional<content::Window>
        aim;  // N·m: the due step's, else what the joint is to have; loosening: none
};

// Adds a tick with the wrench, after the lesson has observed it.
void note(Plot& plot, const lesson::Lesson& lesson,
          const ecs::Access<const world::Joint, const world::ToolContact>& world);

// Where plates and panels lie over the picture: what stands in the scene keeps out of there.

// Those of the interface as it is being drawn, px; between ui::Ui::begin and end, after the last of them.
std::vector<render::Rectangle> occupied_areas();

// What lies over a lesson's picture: what to do, and the pull as a curve. Figures that belong to a place
// stand there, in the scene (label_system).

// In whose language, and by which keys.
struct Said {
    const words::Words* words = nullptr;
    const lesson::Controls* controls = nullptr;
};

// Between ui::Ui::begin and end. `scale`: pixels a point.
void draw_hud(const ActiveLesson& playing, const Said& said, const glm::dvec2& size, float scale);

}  // namespace bolt::trainer
