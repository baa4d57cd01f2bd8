#include "game/trainer/systems.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "game/scene/labels.hpp"
#include "game/view/label_places.hpp"

namespace bolt::trainer {

namespace {

// After the lesson with the sign of what became of the joint, as its outline has the colour.
render::Label clamp_of(const ActiveLesson& p, const words::Words& words, std::size_t joint) {
    const session::Course& course = *p.course;
    render::Label label = scene::clamp_label(words, course.assembly(), course.setup(), p.place.world, joint);
    if (p.pace.finished && p.verdicts[joint] != lesson::Verdict::none)
        label.text = fmt::format("{} {}", view::sign_of(p.verdicts[joint]), label.text);
    return label;
}

// A plate over another joint's nut would name the wrong one.
void keep_off_nuts(const ActiveLesson& p, const Screen& screen, std::vector<render::Rectangle>& taken) {
    const servo::Setup& setup = p.course->setup();
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const servo::NutGeometry& nut = setup.nuts[i];
        const Vec3 middle = world::nut_centre(p.place.world, setup, i);
        const auto at = project(screen, middle), edge = project(screen, middle + nut.across_flats * nut.e1),
                   other = project(screen, middle + nut.across_flats * nut.e2);
        if (!at || !edge || !other) continue;
        const auto radius =
            static_cast<float>(0.6 * std::max(glm::distance(*at, *edge), glm::distance(*at, *other)));
        taken.push_back({glm::vec2(*at) - radius, glm::vec2(*at) + radius});
    }
}

}  // namespace

void label_system(scene::World& world, Frame& frame) {
    ActiveLesson& p = frame.playing;
    const session::Course& course = *p.course;
    const servo::Setup& setup = course.setup();
    const lesson::Step* due = trainer::due(p.undo, course.lesson());
    p.scene.labels.clear();
    // What a trainee at a real machine would not see is no part of an assessment.
    const bool helps = course.lesson().mode != lesson::Mode::assessment;
    if (frame.wanted.wants(Action::flange_map)) p.view.clamp_map = !p.view.clamp_map && helps;
    if (!p.pace.finished)
        if (auto figure = scene::work_label(frame.words, course.lesson(), setup, world, p.palette))
            p.scene.labels.push_back(*figure);
    const auto named = [&](std::size_t joint, bool is_due) {
        const std::string& id = course.assembly().joints[joint].design.id;
        render::Label label = scene::plate(is_due ? fmt::format("{} {}", view::due_sign, id) : id,
                                           scene::above_nut(setup, world, joint), 16.0F);
        label.color = is_due ? p.palette.due : scene::label_color;
        label.moved_px = {0.0F, 8.0F};
        p.scene.labels.push_back(label);
    };
    const bool guided = course.lesson().mode == lesson::Mode::guided;
    const std::size_t marked = due != nullptr && guided ? due->joint : SIZE_MAX;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        if (p.view.clamp_map || p.pace.finished)
            p.scene.labels.push_back(clamp_of(p, frame.words, i));
        else if (i == marked || p.pointing.nut == i)
            named(i, i == marked);
    }
    if (frame.fonts == nullptr) return;
    const Screen screen = screen_of(p, frame.size);
    std::vector<render::Rectangle> taken = p.view.occupied;
    if (!p.view.clamp_map && !p.pace.finished) keep_off_nuts(p, screen, taken);
    view::move_apart(*frame.fonts, p.scene.labels, screen.eye, glm::vec2(frame.size), taken);
}

void present_system(scene::World& world, Frame& frame) { scene::present(world, frame.playing.scene); }

}  // namespace bolt::trainer
