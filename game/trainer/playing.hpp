// A lesson being played: what the servo does, what is seen of it and from where. The systems of a frame
// (systems.hpp) work on this, and a window or a file only shows it.
#pragma once

#include <memory>
#include <string>

#include "engine/render/overlay.hpp"
#include "engine/text/fonts.hpp"
#include "game/hints/hints.hpp"
#include "game/hints/mistakes.hpp"
#include "game/operators/sight.hpp"
#include "game/play/course.hpp"
#include "game/scene/strain.hpp"
#include "game/scene/systems.hpp"
#include "game/sound/live.hpp"
#include "game/trainer/at_station.hpp"
#include "game/trainer/captions.hpp"
#include "game/trainer/close_up.hpp"
#include "game/trainer/controls.hpp"
#include "game/trainer/going_back.hpp"
#include "game/trainer/mouse_hand.hpp"
#include "game/trainer/plot.hpp"
#include "game/trainer/pointing.hpp"
#include "game/view/orbit.hpp"
#include "game/view/palette.hpp"

namespace bolt::trainer {

struct Playing {
    std::unique_ptr<play::Course> course;
    std::optional<AtStation> station;  // none: the hand is at the mouse
    MouseHand mouse;                   // that moves the hand, unless there is a station
    Hand hand;

    scene::Workplace place;
    scene::Postures postures;
    view::Glide camera;
    render::Scene scene;

    Controls controls;
    bool hand_drag = false;            // the left button holds the hand, not the view
    glm::dvec2 press{0.0};             // px, where it went down
    std::optional<std::size_t> under;  // nut under the pointer
    bool over_wrench = false;

    double owed = 0.0;     // s of ticks that are due
    servo::Output output;  // of the last tick

    std::size_t grip = 0;  // how the handle is held (scene::Postures)
    Vec3 shoulder{0.0};    // m, of whoever works
    Plot plot;
    std::vector<lesson::Verdict> verdicts;  // of the joints, once the lesson has ended
    hints::Hints hints;
    std::optional<std::pair<std::size_t, Pose>> ghost;  // of the wrench: for which step, and where
    hints::Mistakes mistakes;
    GoingBack back;  // as soon as the hand is out of the way
    std::unique_ptr<sound::Live> sound;
    bool quiet = false;
    double volume = 1.0;               // 0 … 1, as the trainee has it
    sound::Ear ear;                    // of the captions
    std::optional<Captions> captions;  // none: they are not wished for
    view::Palette palette;
    std::vector<lesson::Event> said;  // by the lesson, since it was last taken
    operators::Sight sight;
    double unseen = 0.0;  // s that what is due has been out of sight
    bool paused = false, finished = false;
    bool clamp_map = false;  // the clamp force of every joint is shown
    scene::Strain strain;    // of the hand
    CloseUp close_up;
    std::vector<render::Rectangle> plates;  // px, over the picture before
    double lagged = 0.0;  // s that the lesson's time fell behind the clock's: a slow machine
};

}  // namespace bolt::trainer
