// The trainer in a real window, used by keyboard and mouse.
#include <thread>

#include "game/session/session_file.hpp"
#include "tests/platform/window_user.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/screen_picture.hpp"
#include "tests/trainer_window/program.hpp"

using namespace bolt;

namespace {

constexpr std::uint32_t width = 320, height = 200;

}  // namespace

TEST_CASE("Window: Enter starts a lesson, the tool key takes the wrench, closing keeps the session") {
    trainer::AppOptions options;
    options.choice.assembly = "cover-m8";
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / "window";
    test::Program program(std::move(options), {width, height});
    bool begun = false, taken = false, large = false;
    std::thread user_thread([&] {
        test::WindowUser hand("boltwright");
        begun = test::eventually([&] {
            hand.key("Return");
            return program.log.has("lesson begun");
        });
        // Press the key again if a slow frame has dropped it.
        taken = test::eventually([&] {
            if (!program.log.has("in the hand")) hand.key("t");
            std::this_thread::sleep_for(std::chrono::seconds(4));
            return program.log.has("in the hand");
        });
        hand.key("F11");
        large =
            test::eventually([&] { return test::WindowUser("boltwright").rectangle().width > int{width}; });
        hand.close();
    });
    const Status run = view::run_in_window(*program.app, program.window, *program.instance);
    user_thread.join();
    CHECK(begun);
    CHECK(taken);
    CHECK(large);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    const auto reader = session::SessionReader::open(program.out / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->tick_count() > 500);
    const auto result = reader->result();
    REQUIRE(result);
    CHECK_FALSE(result->finished);
}
