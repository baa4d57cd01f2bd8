// The menu: its cards and pictures, keys and controller, every size of the screen, its pages, and the tour.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <thread>

#include "content/format/folders.hpp"
#include "game/trainer/assembly_entry.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer_app/headless_trainer.hpp"
#include "tests/trainer_app/simulated_user.hpp"

using namespace bolt;
using namespace bolt::trainer;
using platform::Key;

namespace {

using test::HeadlessTrainer;
using test::options;

constexpr test::Display small{{640, 360}, 0.5F, 0.1};  // 1280 × 720 points

void wait_for_pictures(HeadlessTrainer& driver) {
    for (int i = 0; i < 20000 && !driver.app().pictures().complete(); ++i) {
        driver.frame();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(driver.app().pictures().complete());
    driver.frame();
    driver.frame();
}

const DrawnWidget* find_button(const HeadlessTrainer& driver, words::TextKey label,
                               const std::string& assembly = {}) {
    for (const DrawnWidget& place : driver.app().drawn_widgets())
        if (place.label == label && place.assembly == assembly) return &place;
    return nullptr;
}

void press_card(HeadlessTrainer& driver, const std::string& assembly) {
    driver.frame();
    driver.frame();
    const DrawnWidget* card = find_button(driver, "menu.assemblies", assembly);
    REQUIRE(card != nullptr);
    const glm::dvec2 at(card->middle);
    driver.press(at);
    driver.release(at);
    driver.frame();
}

// Mean difference of the channels (0 … 255) from the first texel of a square about `middle`, px.
double difference_from_first_texel(const render::Picture& picture, const glm::vec2& middle, int radius) {
    const auto texel = [&](int x, int y, int channel) {
        return static_cast<double>(
            picture.rgba.at((static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x)) * 4 +
                            static_cast<std::size_t>(channel)));
    };
    const int x0 = static_cast<int>(middle.x), y0 = static_cast<int>(middle.y);
    double sum = 0.0;
    for (int y = y0 - radius; y <= y0 + radius; ++y)
        for (int x = x0 - radius; x <= x0 + radius; ++x)
            for (int c = 0; c < 3; ++c) sum += std::abs(texel(x, y, c) - texel(x0 - radius, y0 - radius, c));
    return sum / (3.0 * (2.0 * radius + 1.0) * (2.0 * radius + 1.0));
}

void controller(HeadlessTrainer& driver, platform::ControllerButton button) {
    driver.frame({platform::ControllerEvent{button, true}});
    driver.frame({platform::ControllerEvent{button, false}});
}

// Writes `text` as the assembly.json of an assembly of the user; if it is empty, copies cover-m8.
void add_user_assembly(const std::filesystem::path& data, const std::string& name, const std::string& text) {
    const auto folder = data / "boltwright" / "assemblies" / name;
    std::filesystem::create_directories(folder);
    if (text.empty())
        std::filesystem::copy(content::content_folder() / "assemblies" / "cover-m8", folder,
                              std::filesystem::copy_options::recursive);
    else
        std::ofstream(folder / "assembly.json") << text;
}

}  // namespace

TEST_CASE("Menu: each assembly has a card with its picture, and the chosen one is shown behind the menu") {
    HeadlessTrainer driver(options("zq350", true), small);
    driver.frame();
    const render::Picture bare = driver.picture();
    wait_for_pictures(driver);
    const render::Picture shown = driver.picture();
    for (const char* name : {"zq350", "cover-m8", "dn200-pn16", "pump-32-160"}) {
        CAPTURE(name);
        const DrawnWidget* card = find_button(driver, "menu.assemblies", name);
        REQUIRE(card != nullptr);
        const glm::vec2 middle = card->middle - glm::vec2(0.0F, 10.0F);  // of the thumbnail
        CHECK(difference_from_first_texel(bare, middle, 15) < 1.0);
        CHECK(difference_from_first_texel(shown, middle, 15) > 8.0);
    }
    CHECK(find_button(driver, "menu.assemblies", tour_assembly) == nullptr);  // it has its own button
    const glm::vec2 beside(440.0F, 75.0F);  // right of the choices, above the description
    CHECK(difference_from_first_texel(bare, beside, 40) < 1.0);
    CHECK(difference_from_first_texel(shown, beside, 40) > 8.0);

    press_card(driver, "cover-m8");
    CHECK(driver.app().choice().assembly == "cover-m8");
    wait_for_pictures(driver);
    CHECK(driver.picture().rgba != shown.rgba);
}

TEST_CASE("Menu: pictures are drawn again after the GPU was lost") {
    HeadlessTrainer driver(options("cover-m8", true), small);
    wait_for_pictures(driver);
    const render::Picture before = driver.picture();
    driver.lose_gpu();
    driver.frame();
    wait_for_pictures(driver);
    const render::Picture after = driver.picture();
    REQUIRE(after.rgba.size() == before.rgba.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < after.rgba.size(); ++i)
        differing += std::abs(int{after.rgba[i]} - int{before.rgba[i]}) > 8 ? 1U : 0U;
    CHECK(differing < after.rgba.size() / 500);
}

TEST_CASE("Menu: keys alone choose, open pages and start; Enter presses the marked control") {
    HeadlessTrainer driver(options("cover-m8", true), small);
    wait_for_pictures(driver);
    driver.key(Key::down);  // the focus is on Start; the tour and the pages follow
    driver.key(Key::down);
    driver.key(Key::right);
    driver.key(Key::right);
    driver.key(Key::enter);
    CHECK(driver.app().menu_page() == MenuPage::files);
    driver.key(Key::escape);
    CHECK(driver.app().menu_page() == MenuPage::choices);
    driver.frame();
    // From the start button upwards through every row, to the task "Loosen".
    for (int i = 0; i < 30 && driver.app().choice().task != lesson::Task::loosen; ++i) {
        driver.key(Key::up);
        driver.key(Key::right);
        driver.key(Key::space);
        driver.key(Key::left);
        if (driver.app().screen() != ShownScreen::menu || driver.app().menu_page() != MenuPage::choices)
            break;
    }
    CHECK(driver.app().choice().task == lesson::Task::loosen);
}

TEST_CASE("Menu: a key that is pressed and released within one frame is not lost") {
    HeadlessTrainer driver(options("cover-m8", true), small);
    driver.frame();
    const auto tap = [&](Key key) {
        driver.frame({platform::KeyEvent{key, true}, platform::KeyEvent{key, false}});
        driver.frame();
    };
    for (const Key key : {Key::down, Key::down, Key::right, Key::right, Key::enter}) tap(key);
    CHECK(driver.app().menu_page() == MenuPage::files);
}

TEST_CASE("Menu: an assembly of the menu is not the folder of its name in the current folder") {
    const test::Folder here;
    std::filesystem::create_directories(here / "cover-m8");
    std::ofstream(here / "cover-m8" / "assembly.json") << R"({"title": 3})";
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(here.path());
    HeadlessTrainer driver(options("cover-m8", true), small);
    wait_for_pictures(driver);
    driver.press_button("menu.start");
    driver.frame();
    std::filesystem::current_path(before);
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    CHECK(driver.lesson().session->assembly().joints.size() == 4);
}

TEST_CASE("Menu: an assembly whose first view is from straight above is shown behind the menu") {
    const test::Folder data;
    const test::EnvironmentVariable home("XDG_DATA_HOME", data.path().c_str());
    std::ifstream shipped(content::content_folder() / "assemblies/cover-m8/assembly.json");
    std::string text(std::istreambuf_iterator<char>(shipped), {});
    add_user_assembly(data.path(), "above", "");
    const std::size_t views = text.find("\"views\"");
    REQUIRE(views != std::string::npos);
    const std::size_t open = text.find('{', views), close = text.find('}', open);
    text.replace(open, close + 1 - open,
                 R"({ "name": "above", "eye_mm": [0, 600, 0], "target_mm": [0, 0, 0] })");
    std::ofstream(data / "boltwright/assemblies/above/assembly.json") << text;
    HeadlessTrainer driver(options("above", true), small);
    wait_for_pictures(driver);
    const glm::vec2 size(driver.size());
    CHECK(difference_from_first_texel(driver.picture(), {0.7F * size.x, 0.25F * size.y}, 40) > 2.0);
}

TEST_CASE(
    "Menu: instructions that are too long for two columns are shown in one, and the buttons stay inside") {
    const test::Folder data;
    const test::EnvironmentVariable home("XDG_DATA_HOME", data.path().c_str());
    std::ifstream shipped(content::content_folder() / "assemblies/cover-m8/assembly.json");
    std::string text(std::istreambuf_iterator<char>(shipped), {});
    add_user_assembly(data.path(), "long", "");
    const std::size_t lesson = text.find("\"lesson\"");
    REQUIRE(lesson != std::string::npos);
    std::string sentences;
    for (int i = 0; i < 200; ++i) sentences += "Tighten every nut in turn. ";
    text.insert(text.find("\"en\": \"", lesson) + 7, sentences);
    std::ofstream(data / "boltwright/assemblies/long/assembly.json") << text;
    HeadlessTrainer driver(options("long", true), small);
    driver.frame();
    driver.frame();
    for (const words::TextKey key : {words::TextKey("menu.start"), words::TextKey("menu.tour"),
                                     words::TextKey("menu.settings"), words::TextKey("menu.quit")}) {
        CAPTURE(key.row().name);
        const DrawnWidget* button = find_button(driver, key);
        REQUIRE(button != nullptr);
        CHECK(button->middle.y > 0.0F);
        CHECK(button->middle.y < static_cast<float>(driver.size().y));
    }
    driver.press_button("menu.start");
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::lesson);
}

TEST_CASE("Menu: without a marked control Enter starts the lesson") {
    HeadlessTrainer driver(options("cover-m8", true), small);
    driver.frame();
    driver.key(Key::enter);
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    CHECK(driver.lesson().session->assembly().name == "cover-m8");
    CHECK_FALSE(driver.app().tour());
}

TEST_CASE("Menu: a controller chooses, opens and leaves pages, starts and pauses") {
    using platform::ControllerButton;
    HeadlessTrainer driver(options("cover-m8", true), small);
    wait_for_pictures(driver);
    for (const ControllerButton button :
         {ControllerButton::down, ControllerButton::down, ControllerButton::right, ControllerButton::right,
          ControllerButton::confirm})
        controller(driver, button);
    CHECK(driver.app().menu_page() == MenuPage::files);
    controller(driver, ControllerButton::cancel);
    CHECK(driver.app().menu_page() == MenuPage::choices);
    controller(driver, ControllerButton::start);
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    controller(driver, ControllerButton::start);
    CHECK(driver.lesson().clock.paused);
    controller(driver, ControllerButton::start);
    CHECK_FALSE(driver.lesson().clock.paused);
}

TEST_CASE(
    "Menu: its buttons are inside the picture in every language, from 1280 × 720 to 4K, at scales 1 to 2") {
    struct Screen {
        VkExtent2D size;
        float scale;
    };
    // Divided by four, which changes nothing but the number of pixels.
    constexpr Screen screens[] = {{{320, 180}, 0.25F},
                                  {{320, 180}, 0.5F},
                                  {{480, 270}, 0.375F},
                                  {{960, 540}, 0.25F},
                                  {{960, 540}, 0.5F}};
    for (const Screen& screen : screens) {
        CAPTURE(screen.size.width);
        CAPTURE(screen.scale);
        for (const char* language : {"en", "de", "zh"}) {
            CAPTURE(language);
            AppOptions o = options("zq350", true);
            o.choice.language = language;
            o.first_start = true;
            HeadlessTrainer driver(o, {screen.size, screen.scale, 0.1});
            for (int i = 0; i < 3; ++i) driver.frame();
            const bool wide = static_cast<float>(screen.size.width) / screen.scale > 940.0F;
            for (const words::TextKey label :
                 {words::TextKey("menu.start"), words::TextKey("menu.tour"), words::TextKey("menu.settings"),
                  words::TextKey("menu.files"), words::TextKey("menu.quit"),
                  words::TextKey("mode.practice")}) {
                CAPTURE(label.row().name);
                const DrawnWidget* button = find_button(driver, label);
                REQUIRE(button != nullptr);
                CHECK(button->middle.x - 0.5F * button->width >= 0.0F);
                CHECK(button->middle.x + 0.5F * button->width <= static_cast<float>(screen.size.width));
                if (wide || label != words::TextKey("mode.practice"))
                    CHECK(button->middle.y < static_cast<float>(screen.size.height));
            }
        }
    }
}

TEST_CASE("Menu: an assembly of the user is listed; one with mistakes says why and cannot start") {
    const test::Folder data;
    const test::EnvironmentVariable variable("XDG_DATA_HOME", data.path().c_str());
    add_user_assembly(data.path(), "another", {});
    add_user_assembly(data.path(), "broken", R"({"title": 3})");
    HeadlessTrainer driver(options("cover-m8", true), small);
    wait_for_pictures(driver);
    press_card(driver, "broken");
    CHECK(driver.app().choice().assembly == "broken");
    driver.press_button("menu.start");
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK_FALSE(driver.app().start_error());  // the button did nothing
    driver.key(Key::enter);
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    REQUIRE(driver.app().start_error());
    CHECK(driver.app().start_error()->file.find("broken") != std::string::npos);

    press_card(driver, "another");
    driver.press_button("menu.start");
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    CHECK(driver.lesson().session->assembly().file.find("assemblies/another/") != std::string::npos);
}

TEST_CASE("Menu: a file with variants and no default one also offers the lesson without a variant") {
    const test::Folder data;
    const test::EnvironmentVariable home("XDG_DATA_HOME", data.path().c_str());
    std::ifstream shipped(content::content_folder() / "assemblies/cover-m8/assembly.json");
    std::string text(std::istreambuf_iterator<char>(shipped), {});
    const std::size_t order = text.find("\"order\"");
    REQUIRE(order != std::string::npos);
    text.insert(order, R"("variants": { "one": { "title": { "en": "One" }, "joints": ["B1"] } }, )");
    add_user_assembly(data.path(), "several", "");
    std::ofstream(data / "boltwright/assemblies/several/assembly.json") << text;
    HeadlessTrainer driver(options("several", true), small);
    driver.frame();
    driver.frame();
    const auto entries = trainer::list_assemblies();
    const auto entry = std::find_if(entries.begin(), entries.end(),
                                    [](const auto& listed) { return listed.name == "several"; });
    REQUIRE(entry != entries.end());
    if (entry->error) FAIL(entry->error->message());
    REQUIRE(entry->variants.size() == 2);
    CHECK(entry->variants[0].variant.name.empty());
    CHECK(entry->variants[0].variant.title == entry->title);
    CHECK(entry->variants[0].joints == 4);
    CHECK(trainer::variant_of(*entry, "").joints == 4);
    CHECK(trainer::variant_of(*entry, "one").joints == 1);
}

TEST_CASE("Menu: the page about this computer shows what is found at once, and the timing afterwards") {
    int calls = 0;
    AppOptions o = options("cover-m8", true);
    o.gather_facts = [&](const computer::FactsRequest& request) {
        ++calls;
        computer::ComputerFacts facts;
        facts.gpu = request.gpu;
        facts.sound = "a sound card";
        facts.sessions = request.sessions;
        facts.free_space = 5e9;
        if (request.seconds > 0.0) {
            facts.timing = Result<computer::ServoTiming>(computer::ServoTiming{});
            (*facts.timing)->assessment = servo::assess_host({}, 1000.0);
        }
        return facts;
    };
    HeadlessTrainer driver(o, small);
    driver.frame();
    driver.press_button("menu.computer");
    CHECK(driver.app().menu_page() == MenuPage::computer);
    const auto check = [&]() -> const ComputerCheck& { return driver.app().computer_check(); };
    for (int i = 0; i < 5000 && check().running(); ++i) {
        driver.frame();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(calls == 2);
    const auto has = [&](words::TextKey text) {
        return std::any_of(check().findings().begin(), check().findings().end(),
                           [&](const computer::Finding& finding) { return finding.text == text; });
    };
    CHECK(has("finding.gpu_software"));  // lavapipe draws the tests
    CHECK(has("finding.timing_bad"));
    CHECK(has("finding.disk"));
    driver.press_button("menu.back");
    CHECK(driver.app().menu_page() == MenuPage::choices);
}

TEST_CASE("Tour: it is offered at the first start, and each control is ticked off when it was used") {
    AppOptions o = options("zq350", true);
    o.first_start = true;
    HeadlessTrainer driver(o, {{320, 180}, 0.25F, 0.1});
    driver.frame();
    driver.key(Key::enter);
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    REQUIRE(driver.app().tour());
    const auto done = [&](TourTask step) {
        return driver.app().tour()->done.at(static_cast<std::size_t>(step));
    };
    CHECK(driver.lesson().session->assembly().name == tour_assembly);
    CHECK(driver.app().tour()->due_task() == 0);

    const glm::dvec2 empty(300.0, 20.0);
    driver.move(empty);
    driver.frame({platform::ButtonEvent{platform::Button::right, true, empty}});
    driver.move(empty - glm::dvec2(3.0, 0.0));
    CHECK_FALSE(done(TourTask::look));  // too little
    driver.move(empty - glm::dvec2(40.0, 0.0));
    CHECK(done(TourTask::look));
    driver.frame({platform::ButtonEvent{platform::Button::right, false, empty}});
    CHECK_FALSE(done(TourTask::zoom));
    driver.frame({platform::WheelEvent{{0.0, 1.0}, empty}});
    CHECK(done(TourTask::zoom));
    driver.key(Key::v);
    CHECK(done(TourTask::find));
    CHECK(driver.app().tour()->due_task() == static_cast<std::size_t>(TourTask::run_down));
    driver.key(Key::h);
    CHECK(done(TourTask::help));
    driver.key(Key::escape);
    CHECK_FALSE(done(TourTask::pause));
    driver.key(Key::escape);
    CHECK(done(TourTask::pause));
    CHECK_FALSE(done(TourTask::take));
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");

    driver.key(Key::i);  // hide the close-up, which doubles the rendering time
    test::SimulatedUser user(driver);
    user.play(120.0);
    REQUIRE(driver.app().screen() == ShownScreen::result);
    CHECK(driver.outcome()->result.finished);
    CHECK(driver.outcome()->result.duration < 60.0);
    CHECK(driver.app().tour()->due_task() == tour_task_count);
    driver.press_button("menu.menu");
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK(driver.app().lesson() == nullptr);  // the pictures of the menu are shown again
    driver.key(Key::enter);                   // the tour is offered first only once
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    CHECK_FALSE(driver.app().tour());
}

TEST_CASE("Menu: Enter ends the input of the trainee's name and starts nothing") {
    HeadlessTrainer driver(options("cover-m8", true), small);
    driver.press_button("menu.trainee");
    driver.frame();
    driver.frame({platform::TextEvent{U'A'}, platform::TextEvent{U'd'}, platform::TextEvent{U'a'}});
    driver.frame();
    driver.key(Key::enter);
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK(driver.app().choice().trainee == "Ada");
}
