// Overlay of a lesson: captions of the sounds, the torque plot, and the boxes with instructions.
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

// Captions describe the sounds in words, from the same cues that the synthesizer uses. Each stays long enough
// to be read, and a lasting sound has one caption. In order of importance, the most important first.
enum class Caption : std::uint8_t {
    slip,
    mistake,
    click,
    done,
    strike_casing,
    strike_nut,
    creep,   // stick-slip of a loaded nut
    scrape,  // the wrench slides on a part
    tooth,   // a ratchet clicks over its teeth
    run      // a free nut runs down
};
inline constexpr std::size_t caption_count = 10;
inline constexpr std::size_t max_captions = 3;   // at once
inline constexpr double caption_duration = 2.0;  // s

struct Captions {
    std::array<double, caption_count> remaining{};  // s for which each is still shown
    // Progress of a lasting sound towards its caption, 0 … 1: how long it has sounded, or for `creep` how far
    // the nut has crept. At 1 the caption appears.
    std::array<double, caption_count> progress{};
};

// Call once a tick of `dt` seconds.
void observe(Captions& captions, const sound::SoundCues& cues, double dt);
// Call once a frame.
void update(Captions& captions, double seconds);
std::vector<Caption> visible_captions(const Captions& captions);

words::TextKey text_key(Caption caption);

struct PlotPoint {
    float angle = 0.0F;   // deg
    float torque = 0.0F;  // N·m
};

// Torque over nut angle of the joint that the wrench engaged last, and the tolerance of the torque.
struct TorquePlot {
    std::vector<PlotPoint> points;  // since the wrench engaged this joint after another one
    float coarseness = 1.0F;  // factor on the least difference between two points; grows with their number
    int joint = -1;           // −1: the wrench has not engaged a nut yet
    // N·m: the due step's tolerance, else the joint's final one; none when loosening.
    std::optional<content::ToleranceWindow> target;
};

// Call after each tick with the wrench in the hand, after the lesson has observed the tick.
void observe(TorquePlot& plot, const lesson::Lesson& lesson,
             const ecs::Access<const world::Joint, const world::ToolState>& world);

// Areas in px that the interface covers; labels in the scene avoid them. Call between ui::Ui::begin and end,
// after the last box.
std::vector<render::Rectangle> occupied_areas();

// Texts of the overlay.
struct HudText {
    const words::Words* words = nullptr;
    const lesson::ControlNames* controls = nullptr;
};

// Draws instructions, plot, effort, device messages and captions. Values at a position in the scene are
// labels (label_system). Call between ui::Ui::begin and end. `scale`: pixels per point.
void draw_hud(const ActiveLesson& active, const HudText& texts, const glm::dvec2& size, float scale);

}  // namespace bolt::trainer
