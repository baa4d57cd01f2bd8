// The tour: a lesson with one nut, with a list of the controls that the trainee ticks off by using them.
#pragma once

#include <array>
#include <string>

#include "content/words/words.hpp"
#include "game/lesson/hints.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/lesson_choice.hpp"

namespace bolt::trainer {

// The assembly of the tour, under content/assemblies. The menu does not list it.
inline constexpr const char* tour_assembly = "first-nut";

// The lesson of the tour, guided, with the trainee and the devices of `choice`.
LessonChoice tour_choice(LessonChoice choice);

// The tasks in the order of the list. The trainee may do them in any order.
enum class TourTask : std::uint8_t {
    look,  // turn the view
    zoom,
    find,      // let the program show the due nut
    run_down,  // with the fingers
    help,
    pause,
    take,  // the wrench
    tighten,
};
inline constexpr std::size_t tour_task_count = 8;

struct Tour {
    std::array<bool, tour_task_count> done{};
    double turned = 0.0;  // rad, by which the trainee has turned the view
    bool paused = false;  // the lesson is paused; resuming it completes TourTask::pause

    // The first task that is not done; `tour_task_count` if all are.
    [[nodiscard]] std::size_t due_task() const;
};

// Call once a frame, after the systems: ticks off the tasks that the trainee has done in this frame.
void update(Tour& tour, const LessonFrame& frame);

// The text of a task, with the controls of the trainee's hand.
std::string tour_text(const words::Words& words, TourTask task, const ActiveLesson& active,
                      const lesson::ControlNames& controls);

// Draws the list at the left edge, between ui::Ui::begin and end. `scale`: px per point.
void draw_tour(const Tour& tour, const ActiveLesson& active, const HudText& texts, const glm::dvec2& size,
               float scale);

}  // namespace bolt::trainer
