// The settings screen: changes by mouse and keyboard, saving, and the effect on a lesson.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/file.hpp"
#include "game/scene/workplace.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

namespace trainer_app_settings_test {

using namespace bolt;
using namespace bolt::trainer;

namespace {

namespace fs = std::filesystem;
using platform::Key;

const fs::path settings_folder = fs::path(BOLT_TRAINER_OUT) / "settings";
const fs::path people_folder = fs::path(BOLT_TRAINER_OUT) / "names";

AppOptions options(bool menu, const std::string& trainee = "Ada") {
    AppOptions o;
    o.choice.assembly = "cover-m8";
    o.choice.trainee = trainee;
    o.choice.language = "en";
    o.menu = menu;
    o.settings_folder = settings_folder;
    o.people_folder = people_folder;
    o.out = fs::path(BOLT_TRAINER_OUT) / "people";
    return o;
}

class SettingsTrainer : public test::HeadlessTrainer {
  public:
    explicit SettingsTrainer(AppOptions options)
        : test::HeadlessTrainer(std::move(options), {{480, 300}, 0.4F, 0.05}) {
        wait(0.1);
    }
    [[nodiscard]] const content::TraineeSettings& settings() const { return app().preferences().settings; }
    [[nodiscard]] const KeyMap& keys() const { return app().preferences().keys; }
};

struct EmptySettingsFolder {
    EmptySettingsFolder() {
        fs::remove_all(settings_folder);
        fs::remove_all(people_folder);
    }
};

std::string code_of(const std::string& name) {
    return content::find_or_add_person(people_folder, name).value().code;
}

void type(SettingsTrainer& driver, const std::string& text) {
    driver.press_button("menu.trainee");
    driver.frame();
    for (const char c : text)
        driver.frame({platform::TextEvent{static_cast<char32_t>(static_cast<unsigned char>(c))}});
    driver.frame();
    driver.key(Key::enter);
    driver.frame();
}

bool shows(const SettingsTrainer& driver, const words::TextKey& key) {
    const auto widgets = driver.app().drawn_widgets();
    return std::any_of(widgets.begin(), widgets.end(), [&](const DrawnWidget& w) { return w.label == key; });
}

std::string text_of(const fs::path& path) { return read_file(path, 64U << 20U, ErrorCode::failed).value(); }

}  // namespace

TEST_CASE(
    "Settings: all of them can be changed by mouse, are saved by trainee, and are loaded the next time") {
    const EmptySettingsFolder empty_folder;
    {
        SettingsTrainer driver(options(true));
        driver.press_button("menu.settings");
        REQUIRE(driver.app().shows_settings());
        driver.press_button("menu.captions");
        driver.press_button("menu.left_handed");
        driver.press_button("menu.seated");
        driver.press_button("menu.palette.distinct", -0.8F);
        driver.press_button("menu.sound", -0.8F);
        driver.press_button("menu.vibration", -0.8F);
        driver.press_button("menu.force_scale", -0.8F);
        driver.press_button("action.tool");
        driver.key(Key::k);
        driver.press_button("menu.back");
        CHECK_FALSE(driver.app().shows_settings());
        CHECK(driver.app().screen() == ShownScreen::menu);
        CHECK(driver.log().empty());
    }
    const SettingsTrainer later(options(true));
    const content::TraineeSettings& s = later.settings();
    CHECK(s.trainee == code_of("Ada"));
    CHECK(s.captions);
    CHECK(s.left_handed);
    CHECK(s.seated_eye_height == 1.2);
    CHECK(s.palette == content::PaletteKind::distinct);
    CHECK(s.volume < 0.4);
    CHECK(s.vibration < 0.4);
    CHECK(s.force_scale < 0.4);
    CHECK(s.force_scale >= content::min_force_scale);
    CHECK(later.keys().of(Action::tool) == Key::k);
    const SettingsTrainer another(options(true, "Bea"));
    CHECK_FALSE(another.settings().left_handed);
}

TEST_CASE("Menu: the chosen joint law is saved for the trainee and is in force in the lesson") {
    const EmptySettingsFolder empty_folder;
    {
        SettingsTrainer driver(options(true));
        CHECK(driver.settings().law.empty());
        driver.press_button("menu.law.published");
        CHECK(driver.settings().law == "published");
        driver.press_button("menu.start");
        driver.frame();
        REQUIRE(driver.app().screen() == ShownScreen::lesson);
        CHECK(driver.lesson().session->assembly().law == joint::Law::published);
        const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
        REQUIRE(reader);
        CHECK(reader->header().law == joint::Law::published);
    }
    SettingsTrainer later(options(true));
    CHECK(later.settings().law == "published");
    later.press_button("menu.law.mechanistic");
    CHECK(later.settings().law == "mechanistic");
    AppOptions by_command_line = options(false);
    by_command_line.choice.law = joint::Law::published;
    SettingsTrainer overridden(std::move(by_command_line));
    overridden.frame();
    REQUIRE(overridden.app().screen() == ShownScreen::lesson);
    CHECK(overridden.lesson().session->assembly().law == joint::Law::published);
}

TEST_CASE(
    "Settings: binding a used key swaps the two, and Escape leaves key prompt, screen and pause one by one") {
    const EmptySettingsFolder empty_folder;
    SettingsTrainer driver(options(false));
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    driver.key(Key::escape);
    REQUIRE(driver.lesson().clock.paused);
    driver.press_button("menu.settings");
    driver.press_button("action.tool");
    driver.key(Key::h);
    CHECK(driver.keys().of(Action::tool) == Key::h);
    CHECK(driver.keys().of(Action::hint) == Key::t);
    driver.press_button("action.tool");
    driver.key(Key::escape);  // leaves the key prompt
    CHECK(driver.app().shows_settings());
    CHECK(driver.keys().of(Action::tool) == Key::h);
    driver.press_button("action.pause");
    driver.key(Key::shift);  // refused: the prompt stays
    driver.key(Key::p);
    CHECK(driver.keys().of(Action::pause) == Key::p);
    driver.key(Key::escape);  // leaves the screen
    CHECK_FALSE(driver.app().shows_settings());
    CHECK(driver.lesson().clock.paused);
    driver.key(Key::escape);  // leaves the pause
    CHECK_FALSE(driver.lesson().clock.paused);
    driver.key(Key::p);
    CHECK(driver.lesson().clock.paused);
    driver.key(Key::escape);
    CHECK_FALSE(driver.lesson().clock.paused);
    // The new key takes the wrench, the old one does not.
    driver.key(Key::t);
    CHECK(hand_of(driver.lesson()).action == HandAction::resting);
    driver.key(Key::h);
    CHECK(hand_of(driver.lesson()).action == HandAction::reaching);
}

TEST_CASE("Settings: during a key prompt keys trigger nothing else, and the window can still be closed") {
    const EmptySettingsFolder empty_folder;
    SettingsTrainer driver(options(true));
    driver.press_button("menu.settings");
    driver.key(Key::enter);  // starts no lesson behind the screen
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK(driver.app().shows_settings());
    driver.press_button("action.hint");
    driver.key(Key::enter);
    CHECK(driver.keys().of(Action::hint) == Key::enter);
    CHECK(driver.app().screen() == ShownScreen::menu);
    driver.key(Key::z);  // Enter has not pressed the button again: no prompt is open
    CHECK(driver.keys().of(Action::hint) == Key::enter);
    driver.press_button("settings.usual_keys");
    CHECK(driver.keys().keys == KeyMap{}.keys);
    driver.press_button("action.hint");
    driver.frame({platform::CloseEvent{}});
    CHECK(driver.app().closed());
}

TEST_CASE("Settings: left hand, driver height, captions and force scale apply to the next lesson") {
    const EmptySettingsFolder empty_folder;
    const auto lesson = [](bool left, double scale) {
        content::TraineeSettings s;
        s.trainee = code_of("Ada");
        s.left_handed = left;
        s.force_scale = scale;
        s.captions = left;
        if (left) s.seated_eye_height = 0.9;
        REQUIRE(content::save_settings(content::settings_path(settings_folder, s.trainee), s,
                                       settings_vocabulary({"en"})));
        AppOptions o = options(false);
        o.out /= left ? "left" : "right";
        return std::make_unique<SettingsTrainer>(std::move(o));
    };
    const auto right = lesson(false, 1.0), left = lesson(true, 0.25);
    const ActiveLesson &r = *right->app().lesson(), &l = *left->app().lesson();
    const double middle =
        0.5 * static_cast<double>(r.workplace.workpiece.low.x + r.workplace.workpiece.high.x);
    const Vec3 grip(r.session->setup().wrench.handle_length, 0.0, 0.0);
    const double to_right = (hand_of(r).rest * grip).x - middle,
                 to_left = (hand_of(l).rest * grip).x - middle;
    CHECK(to_right > 0.1);
    CHECK(to_left == doctest::Approx(-to_right));
    CHECK(l.shoulder.x - middle == doctest::Approx(middle - r.shoulder.x));
    CHECK(l.shoulder.y < r.shoulder.y);
    CHECK(l.view.camera.goal.pitch <= r.view.camera.goal.pitch);
    CHECK(l.session->setup().limits.force == 0.25 * r.session->setup().limits.force);
    CHECK(l.sound.captions.has_value());
    CHECK_FALSE(r.sound.captions.has_value());
}

TEST_CASE("Settings: an unreadable file is reported with its position, and lessons remain possible") {
    const EmptySettingsFolder empty_folder;
    fs::create_directories(settings_folder);
    const fs::path path = content::settings_path(settings_folder, code_of("Ada"));
    REQUIRE(write_file(path, "{\n  \"format\": 7\n}\n"));
    SettingsTrainer driver(options(true));
    CHECK(driver.app().preferences().file_error == Preferences::FileError::read_failed);
    REQUIRE(driver.log().size() == 1);
    CHECK(driver.log().front().find(path.string() + ":2:13: ") == 0);
    driver.press_button("menu.start");
    CHECK(driver.app().screen() == ShownScreen::lesson);
    CHECK(read_file(path, 100, ErrorCode::failed).value() == "{\n  \"format\": 7\n}\n");
}

TEST_CASE("Menu: a typed name gets a code, which is shown beside it and stands in every file") {
    const EmptySettingsFolder empty_folder;
    AppOptions chosen = options(true, "");
    chosen.out /= "codes";
    fs::remove_all(chosen.out);
    SettingsTrainer driver(std::move(chosen));
    CHECK_FALSE(shows(driver, "menu.trainee.code"));
    CHECK_FALSE(fs::exists(people_folder));
    type(driver, "Adalbert");
    CHECK(driver.app().choice().trainee == "Adalbert");
    CHECK(shows(driver, "menu.trainee.code"));
    const auto person = content::find_person(people_folder, "Adalbert").value();
    REQUIRE(person);
    CHECK(driver.app().preferences().trainee == person->code);
    CHECK(driver.app().preferences().display_name == "Adalbert");
    driver.press_button("menu.law.published");
    driver.press_button("menu.start");
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->header().trainee == person->code);
    for (const fs::path& folder : {driver.folder(), settings_folder, people_folder})
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (!entry.is_regular_file() || entry.path() == content::names_path(people_folder)) continue;
            CAPTURE(entry.path());
            CHECK(entry.path().string().find("dalbert") == std::string::npos);
            CHECK(text_of(entry.path()).find("dalbert") == std::string::npos);
        }
}

TEST_CASE("Menu: the code selects the same person as the name, and the name is shown") {
    const EmptySettingsFolder empty_folder;
    const std::string code = code_of("Ada");
    content::TraineeSettings stored;
    stored.trainee = code;
    stored.captions = true;
    REQUIRE(content::save_settings(content::settings_path(settings_folder, code), stored,
                                   settings_vocabulary({"en"})));
    SettingsTrainer driver(options(true, ""));
    CHECK_FALSE(driver.settings().captions);
    std::string small = code;
    for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    type(driver, small);
    CHECK(driver.settings().captions);
    CHECK(driver.app().choice().trainee == "Ada");
    CHECK(shows(driver, "menu.trainee.code"));
    CHECK(driver.log().empty());
}

TEST_CASE("Menu: settings that an older program stored under the typed name are taken over") {
    const EmptySettingsFolder empty_folder;
    content::TraineeSettings stored;
    stored.trainee = "Ada";
    stored.left_handed = true;
    const fs::path old = content::settings_path(settings_folder, "Ada");
    REQUIRE(content::save_settings(old, stored, settings_vocabulary({"en"})));
    const SettingsTrainer driver(options(true));
    CHECK(driver.settings().left_handed);
    CHECK(driver.settings().trainee == code_of("Ada"));
    CHECK_FALSE(fs::exists(old));
}

TEST_CASE(
    "Menu: with a damaged file of names a lesson is possible under a new code, and the reason is shown") {
    const EmptySettingsFolder empty_folder;
    fs::create_directories(people_folder);
    const fs::path names = content::names_path(people_folder);
    const std::string broken = "{\n  \"format\": 7\n}\n";
    REQUIRE(write_file(names, broken));
    SettingsTrainer driver(options(true));
    REQUIRE(driver.log().size() == 1);
    CHECK(driver.log().front().find(names.string() + ":2:13: ") == 0);
    CHECK(driver.app().choice().trainee == "Ada");
    CHECK(shows(driver, "menu.trainee.code"));
    const std::string code = driver.app().preferences().trainee;
    CHECK(content::is_person_code(code));
    driver.press_button("menu.start");
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    CHECK(session::SessionReader::open(driver.folder() / "session.boltwright")->header().trainee == code);
    CHECK(text_of(names) == broken);
}

}  // namespace trainer_app_settings_test
