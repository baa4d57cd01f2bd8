// A whole lesson in a real window, from the menu to the result, with input through the X server.
//
// film.sh records this test. Its environment variables: BOLT_FILM (assembly), BOLT_FILM_MODE, BOLT_FILM_TOOL,
// BOLT_FILM_SIZE (WIDTHxHEIGHT), and BOLT_FILM_OVERDO (overtightens one nut).
#include <cstdlib>
#include <exception>
#include <thread>

#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/view/pictures.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/simulated_user.hpp"
#include "tests/trainer_window/program.hpp"
#include "tests/trainer_window/window_driver.hpp"

using namespace bolt;

namespace {

std::string environment(const char* variable, const char* usual = "") {
    const char* text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    return text != nullptr ? text : usual;
}

lesson::Mode mode_from_environment() {
    const std::string mode = environment("BOLT_FILM_MODE", "guided");
    for (const auto named : {lesson::Mode::guided, lesson::Mode::practice, lesson::Mode::assessment})
        if (mode == lesson::name(named)) return named;
    FAIL("BOLT_FILM_MODE: unknown mode " << mode);
    return lesson::Mode::guided;
}

// Overtightens the first nut and waits until the step is undone.
void overdo(test::TrainerDriver& driver, test::SimulatedUser& user) {
    const trainer::ActiveLesson& p = driver.lesson();
    const lesson::Lesson& lesson = p.session->lesson();
    while (lesson.due() != nullptr && lesson.due()->kind == lesson::StepKind::run_down)
        user.play(p.session->time() + 1.0, lesson.current + 1);
    user.torque_share = 1.4;
    while (!p.guidance.mistakes.shown && driver.app().screen() == trainer::ShownScreen::lesson)
        user.play(p.session->time() + 1.0);
    user.torque_share = 1.0;
    user.wait(3.0);
}

void play_all(test::TrainerDriver& driver, bool overdoes) {
    while (!driver.app().pictures().complete()) driver.frame();
    driver.press_button("menu.start");
    while (driver.app().screen() != trainer::ShownScreen::lesson) driver.frame();
    test::SimulatedUser user(driver);
    user.wait(2.0);
    if (overdoes) overdo(driver, user);
    user.play(3600.0);
    for (int i = 0; i < 15; ++i) driver.frame();  // show the result
    MESSAGE(user.presses << " presses, searched the view " << user.view_searches << " times");
}

}  // namespace

TEST_CASE("Window: a whole lesson from the menu to the result") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const bool filmed = !environment("BOLT_FILM").empty();
    const auto one = filmed ? std::nullopt : std::make_optional<test::OneJoint>("cover-m8");
    trainer::AppOptions options;
    options.choice.assembly = one ? one->name() : environment("BOLT_FILM");
    options.choice.mode = mode_from_environment();
    options.choice.tool = environment("BOLT_FILM_TOOL");
    options.lesson.obstacles = session::ObstacleUse::if_any;
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / "lesson";
    const auto size = view::parse_size(environment("BOLT_FILM_SIZE", "320x200"));
    REQUIRE(size);
    test::Program program(std::move(options), {size->width, size->height});
    test::WindowDriver driver(*program.app, program.window);
    const Status run = test::run_with_user(
        program, driver, [&] { play_all(driver, !environment("BOLT_FILM_OVERDO").empty()); });
    const std::vector<std::string> log = program.log.lines();
    for (std::size_t i = 0; i < log.size(); ++i)
        if (filmed || i + 3 >= log.size()) MESSAGE(log[i]);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    REQUIRE(program.played);
    CHECK(program.played->result.finished);
    CHECK(program.played->result.score > 85.0);
    const auto reader = session::SessionReader::open(program.out / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    auto at = session::restore_setup(*reader);
    REQUIRE(at);
    const auto replayed =
        session::replay(*reader, std::move(*at), [](const session::ReplayTick&) { return true; });
    REQUIRE(replayed);
    CHECK(replayed->mismatches == 0);
}
