// A trainee's settings at the window: changed by pointing and pressing alone, kept, and what they do.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "engine/base/file.hpp"
#include "game/scene/workplace.hpp"
#include "tests/trainer_app/desk.hpp"

using namespace bolt;
using namespace bolt::trainer;

namespace {

namespace fs = std::filesystem;
using platform::Key;

const fs::path settings_folder = fs::path(BOLT_TRAINER_OUT) / "settings";

AppOptions options(bool menu, const std::string& trainee = "Ada") {
    AppOptions o;
    o.choice.assembly = "cover-m8";
    o.choice.trainee = trainee;
    o.choice.language = "en";
    o.menu = menu;
    o.settings_folder = settings_folder;
    o.out = fs::path(BOLT_TRAINER_OUT) / "people";
    return o;
}

class Desk : public test::Desk {
  public:
    explicit Desk(AppOptions options) : test::Desk(std::move(options), {{480, 300}, 0.4F, 0.05}) {
        wait(0.1);
    }
    [[nodiscard]] const content::Settings& settings() const { return app().preferences().settings; }
    [[nodiscard]] const KeyMap& keys() const { return app().preferences().keys; }
};

struct Fresh {
    Fresh() { fs::remove_all(settings_folder); }
};

}  // namespace

TEST_CASE("all settings are changed by pointing, kept under the trainee's name, and there the next time") {
    const Fresh fresh;
    {
        Desk desk(options(true));
        desk.push("menu.settings");
        REQUIRE(desk.app().shows_settings());
        desk.push("menu.captions");
        desk.push("menu.left_handed");
        desk.push("menu.seated");
        desk.push("menu.palette.distinct", -0.8F);
        desk.push("menu.sound", -0.8F);
        desk.push("menu.force_scale", -0.8F);
        desk.push("action.tool");
        desk.key(Key::g);
        desk.push("menu.back");
        CHECK_FALSE(desk.app().shows_settings());
        CHECK(desk.app().shows() == Shows::menu);
        CHECK(desk.told().empty());
    }
    const Desk later(options(true));
    const content::Settings& s = later.settings();
    CHECK(s.trainee == "Ada");
    CHECK(s.captions);
    CHECK(s.left_handed);
    CHECK(s.seated_height == 1.2);
    CHECK(s.palette == content::PaletteKind::distinct);
    CHECK(s.volume < 0.4);
    CHECK(s.force_scale < 0.4);
    CHECK(s.force_scale >= content::least_force_scale);
    CHECK(later.keys().of(Action::tool) == Key::g);
    const Desk another(options(true, "Bea"));
    CHECK_FALSE(another.settings().left_handed);
}

TEST_CASE("Menu: the joint law that is chosen is kept for the trainee and is in force in the lesson") {
    const Fresh fresh;
    {
        Desk desk(options(true));
        CHECK(desk.settings().law.empty());
        desk.push("menu.law.published");
        CHECK(desk.settings().law == "published");
        desk.push("menu.start");
        desk.frame();
        REQUIRE(desk.app().shows() == Shows::lesson);
        CHECK(desk.playing().course->assembly().law == joint::Law::published);
        const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
        REQUIRE(reader);
        CHECK(reader->header().law == "published");
    }
    Desk later(options(true));
    CHECK(later.settings().law == "published");
    later.push("menu.law.mechanistic");
    CHECK(later.settings().law == "mechanistic");
    AppOptions by_command_line = options(false);
    by_command_line.law = joint::Law::published;
    Desk asked(std::move(by_command_line));
    asked.frame();
    REQUIRE(asked.app().shows() == Shows::lesson);
    CHECK(asked.playing().course->assembly().law == joint::Law::published);
}

TEST_CASE("a key that is taken is swapped, Escape leaves question, screen and pause one after the other") {
    const Fresh fresh;
    Desk desk(options(false));
    REQUIRE(desk.app().shows() == Shows::lesson);
    desk.key(Key::escape);
    REQUIRE(desk.playing().pace.paused);
    desk.push("menu.settings");
    desk.push("action.tool");
    desk.key(Key::h);
    CHECK(desk.keys().of(Action::tool) == Key::h);
    CHECK(desk.keys().of(Action::hint) == Key::t);
    desk.push("action.tool");
    desk.key(Key::escape);  // the question
    CHECK(desk.app().shows_settings());
    CHECK(desk.keys().of(Action::tool) == Key::h);
    desk.push("action.pause");
    desk.key(Key::shift);  // refused: it still waits
    desk.key(Key::p);
    CHECK(desk.keys().of(Action::pause) == Key::p);
    desk.key(Key::escape);  // the screen
    CHECK_FALSE(desk.app().shows_settings());
    CHECK(desk.playing().pace.paused);
    desk.key(Key::escape);  // the pause
    CHECK_FALSE(desk.playing().pace.paused);
    desk.key(Key::p);
    CHECK(desk.playing().pace.paused);
    desk.key(Key::escape);
    CHECK_FALSE(desk.playing().pace.paused);
    // The new key takes the wrench, the old one does not.
    desk.key(Key::t);
    CHECK(hand_of(desk.playing()).doing == Doing::resting);
    desk.key(Key::h);
    CHECK(hand_of(desk.playing()).doing == Doing::reaching);
}

TEST_CASE("while a key is waited for, closing the window closes it, and no key starts or presses anything") {
    const Fresh fresh;
    Desk desk(options(true));
    desk.push("menu.settings");
    desk.key(Key::enter);  // starts no lesson behind the screen
    CHECK(desk.app().shows() == Shows::menu);
    CHECK(desk.app().shows_settings());
    desk.push("action.hint");
    desk.key(Key::enter);
    CHECK(desk.keys().of(Action::hint) == Key::enter);
    CHECK(desk.app().shows() == Shows::menu);
    desk.key(Key::z);  // it has not pressed the button again: nothing is asked for any more
    CHECK(desk.keys().of(Action::hint) == Key::enter);
    desk.push("settings.usual_keys");
    CHECK(desk.keys().keys == KeyMap{}.keys);
    desk.push("action.hint");
    desk.frame({platform::CloseEvent{}});
    CHECK(desk.app().closed());
}

TEST_CASE("left-handed: the wrench lies on the other side, and the force is the share that was asked for") {
    const Fresh fresh;
    const auto lesson = [](bool left, double scale) {
        content::Settings s;
        s.trainee = "Ada";
        s.left_handed = left;
        s.force_scale = scale;
        s.captions = left;
        if (left) s.seated_height = 0.9;
        REQUIRE(content::save_settings(content::settings_path(settings_folder, "Ada"), s,
                                       settings_vocabulary({"en"})));
        AppOptions o = options(false);
        o.out /= left ? "left" : "right";
        return std::make_unique<Desk>(std::move(o));
    };
    const auto right = lesson(false, 1.0), left = lesson(true, 0.25);
    const ActiveLesson &r = *right->app().playing(), &l = *left->app().playing();
    const double middle = 0.5 * static_cast<double>(r.place.machine.low.x + r.place.machine.high.x);
    const Vec3 grip(r.course->setup().wrench.handle_length, 0.0, 0.0);
    const double to_right = (hand_of(r).rest * grip).x - middle,
                 to_left = (hand_of(l).rest * grip).x - middle;
    CHECK(to_right > 0.1);
    CHECK(to_left == doctest::Approx(-to_right));
    CHECK(l.shoulder.x - middle == doctest::Approx(middle - r.shoulder.x));
    CHECK(l.shoulder.y < r.shoulder.y);
    CHECK(l.view.camera.goal.pitch <= r.view.camera.goal.pitch);
    CHECK(l.course->setup().limits.force == 0.25 * r.course->setup().limits.force);
    CHECK(l.sound.captions.has_value());
    CHECK_FALSE(r.sound.captions.has_value());
}

TEST_CASE("what cannot be read is told with its place, and a lesson can be played all the same") {
    const Fresh fresh;
    fs::create_directories(settings_folder);
    const fs::path path = content::settings_path(settings_folder, "Ada");
    REQUIRE(write_file(path, "{\n  \"format\": 7\n}\n"));
    Desk desk(options(true));
    CHECK(desk.app().preferences().trouble == Preferences::Trouble::unread);
    REQUIRE(desk.told().size() == 1);
    CHECK(desk.told().front().find(path.string() + ":2:13: ") == 0);
    desk.push("menu.start");
    CHECK(desk.app().shows() == Shows::lesson);
    CHECK(read_file(path, 100, ErrorCode::failed).value() == "{\n  \"format\": 7\n}\n");
}
