#include "game/trainees/train.hpp"

#include <cmath>

#include "game/trainees/trainee.hpp"

namespace bolt::trainees {

Result<session::Played> train(const content::Assembly& given, const TrainOptions& options,
                              const std::filesystem::path& file,
                              const std::function<bool(const Progress&)>& watch) {
    session::CourseOptions options_of_course = options.course;
    options_of_course.operator_name = options.trainee.name;
    options_of_course.view_help = options.view_help ? "on" : "off";
    Result<std::unique_ptr<session::Course>> begun = session::Course::begin(given, options_of_course, file);
    if (!begun) return fail(begun.error());
    session::Course& course = **begun;
    const double dt = options.course.dt;
    trainees::Operator trainee(options.trainee, options.course.seed, course.setup(), options.view_help);
    const auto second = static_cast<std::uint64_t>(std::lround(1.0 / dt));
    const auto last = static_cast<std::uint64_t>(options.longest / dt);
    const auto patience = static_cast<std::uint64_t>(options.patience / dt);
    const servo::State& state = course.state();
    const lesson::Lesson& lesson = course.lesson();
    std::size_t step = lesson.current;
    std::uint64_t since = 0;
    bool go_on = true;
    while (go_on && state.tick - since < patience && !course.over() && state.tick < last) {
        const servo::Input input = trainee.act(course.setup(), state, lesson);
        const Result<servo::Output> output = course.step(input, trainee.take_noticed());
        if (!output) return fail(output.error());
        Progress progress{course.time(), lesson.current, lesson.steps.size(), nullptr};
        for (const lesson::Event& event : course.events()) {
            progress.event = &event;
            go_on = watch(progress) && go_on;
            progress.event = nullptr;
        }
        if (lesson.current != step) {
            step = lesson.current;
            since = state.tick;
        }
        if (state.tick % second == 0) go_on = watch(progress) && go_on;
    }
    return course.finish();
}

}  // namespace bolt::trainees
