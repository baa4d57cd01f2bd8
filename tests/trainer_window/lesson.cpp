// A whole lesson in a real window, from the menu to the result, by what the X server delivers.
//
// film.sh shows it, or another: BOLT_FILM is its assembly, BOLT_FILM_MODE its mode, BOLT_FILM_TOOL its tool,
// BOLT_FILM_SIZE the window's (WIDTHxHEIGHT); with BOLT_FILM_OVERDO one nut is pulled too far.
#include <cstdlib>
#include <exception>
#include <thread>

#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/view/pictures.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/person.hpp"
#include "tests/trainer_window/program.hpp"
#include "tests/trainer_window/window_seat.hpp"

using namespace bolt;

namespace {

std::string asked(const char* variable, const char* usual = "") {
    const char* text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    return text != nullptr ? text : usual;
}

lesson::Mode mode_asked() {
    const std::string mode = asked("BOLT_FILM_MODE", "guided");
    for (const auto named : {lesson::Mode::guided, lesson::Mode::practice, lesson::Mode::assessment})
        if (mode == lesson::name(named)) return named;
    FAIL("there is no mode " << mode);
    return lesson::Mode::guided;
}

// Pulls the first nut that is to be tightened too far, and looks on until it is as it was.
void overdo(test::Seat& seat, test::Person& person) {
    const trainer::ActiveLesson& p = seat.playing();
    const lesson::Lesson& lesson = p.course->lesson();
    while (lesson.due() != nullptr && lesson.due()->kind == lesson::StepKind::run_down)
        person.play(p.course->time() + 1.0, lesson.current + 1);
    person.sought = 1.4;
    while (!p.coaching.mistakes.shown && seat.app().shows() == trainer::Shows::lesson)
        person.play(p.course->time() + 1.0);
    person.sought = 1.0;
    person.wait(3.0);
}

void play_all(test::Seat& seat, bool overdoes) {
    while (seat.app().backdrop().reading()) seat.frame();
    seat.push("menu.start");
    while (seat.app().shows() != trainer::Shows::lesson) seat.frame();
    test::Person person(seat);
    person.wait(2.0);
    if (overdoes) overdo(seat, person);
    person.play(3600.0);
    for (int i = 0; i < 15; ++i) seat.frame();  // the result
    MESSAGE(person.presses << " presses, looked " << person.looks << " times for a nut");
}

}  // namespace

TEST_CASE("a whole lesson in a window, from the menu to the result") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const bool filmed = !asked("BOLT_FILM").empty();
    const auto one = filmed ? std::nullopt : std::make_optional<test::OneJoint>("cover-m8");
    trainer::AppOptions options;
    options.choice.assembly = one ? one->name() : asked("BOLT_FILM");
    options.choice.mode = mode_asked();
    options.choice.tool = asked("BOLT_FILM_TOOL");
    options.course.obstacles = session::Obstacles::if_any;
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / "lesson";
    const auto size = view::parse_size(asked("BOLT_FILM_SIZE", "320x200"));
    REQUIRE(size);
    test::Program program(std::move(options), {size->width, size->height});
    test::WindowSeat seat(*program.app, program.window);
    std::exception_ptr thrown;
    std::thread somebody([&] {
        try {
            seat.sit([&] { play_all(seat, !asked("BOLT_FILM_OVERDO").empty()); });
        } catch (...) {
            thrown = std::current_exception();
        }
    });
    const Status run = trainer::run_in_window(*program.app, program.window, *program.instance,
                                              {{}, [&] { return seat.turn(); }});
    seat.gone();
    somebody.join();
    const std::vector<std::string> told = program.log.lines();
    for (std::size_t i = 0; i < told.size(); ++i)
        if (filmed || i + 3 >= told.size()) MESSAGE(told[i]);
    if (thrown) std::rethrow_exception(thrown);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    REQUIRE(program.played);
    CHECK(program.played->result.finished);
    CHECK(program.played->result.score > 85.0);
    const auto reader = session::Reader::open(program.out / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    auto at = session::prepare_again(*reader);
    REQUIRE(at);
    const auto replayed =
        session::replay(*reader, std::move(*at), [](const session::Moment&) { return true; });
    REQUIRE(replayed);
    CHECK(replayed->wrong == 0);
}
