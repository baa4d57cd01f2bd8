#include "game/trainer/hud.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "game/sound/event_detection.hpp"
#include "tests/support/folder.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;
using namespace bolt::trainer;

namespace {

constexpr double dt = 1e-3;

bool says(const Captions& captions, Caption caption) {
    const auto all = shown(captions);
    return std::find(all.begin(), all.end(), caption) != all.end();
}

}  // namespace

TEST_CASE("each sound has its caption: it comes in the tick of the sound, stands, and goes") {
    struct Row {
        sound::Heard heard;
        Caption caption;
    };
    std::vector<Row> rows(6);
    rows[0] = {{}, Caption::slip};
    rows[0].heard.slip = 0.05F;
    rows[1] = {{}, Caption::mistake};
    rows[1].heard.mistake = true;
    rows[2] = {{}, Caption::click};
    rows[2].heard.click = true;
    rows[3] = {{}, Caption::done};
    rows[3].heard.done = true;
    rows[4] = {{}, Caption::strike_casing};
    rows[4].heard.strike = 0.3F;
    rows[5] = {{}, Caption::strike_nut};
    rows[5].heard.strike = 0.3F;
    rows[5].heard.met = sound::Met::nut;
    for (const Row& row : rows) {
        Captions captions;
        note(captions, {}, dt);
        CHECK(shown(captions).empty());
        note(captions, row.heard, dt);
        CHECK(shown(captions) == std::vector{row.caption});
        update(captions, caption_stands - 0.01);
        CHECK(says(captions, row.caption));
        update(captions, 0.02);
        CHECK(shown(captions).empty());
    }
}

TEST_CASE("what goes on is said once it lasts, and for as long; a blip and silence are not") {
    sound::Heard groans;
    groans.creep = 0.2F;
    groans.load = 0.8F;
    Captions captions;
    for (int i = 0; i < 90; ++i) note(captions, groans, dt);  // 0.018 rad
    CHECK(shown(captions).empty());
    for (int i = 0; i < 50; ++i) note(captions, groans, dt);
    CHECK(shown(captions) == std::vector{Caption::groan});
    for (int frame = 0; frame < 50; ++frame) {  // five seconds
        for (int i = 0; i < 100; ++i) note(captions, groans, dt);
        update(captions, 0.1);
        CHECK(says(captions, Caption::groan));
    }
    Captions blips;
    for (int i = 0; i < 5000; ++i) note(blips, i % 1000 < 50 ? groans : sound::Heard{}, dt);
    CHECK(shown(blips).empty());
    sound::Heard scrapes;
    scrapes.slide = 0.2F;
    scrapes.press = 5.0F;
    for (int i = 0; i < 5000; ++i) note(blips, i % 1000 < 100 ? scrapes : sound::Heard{}, dt);
    CHECK(shown(blips).empty());
    for (int i = 0; i < 200; ++i) note(blips, scrapes, dt);
    CHECK(shown(blips) == std::vector{Caption::scrape});
    blips = {};
    sound::Heard unloaded = groans;
    unloaded.load = 0.05F;
    for (int i = 0; i < 1000; ++i) note(blips, unloaded, dt);
    CHECK(shown(blips).empty());
}

TEST_CASE(
    "a lesson in words: nuts that run, joints that groan, chimes, and no words for what was not heard") {
    const content::Assembly cover = trainer_test::assembly("cover-m8");
    session::CourseOptions options;
    options.operator_name = "player";
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    auto course = session::Course::begin(cover, options, file);
    if (!course) FAIL(course.error().message());
    session::Course& c = **course;
    trainer_test::Player player;
    player.hand = trainer::make_hand({Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)});
    sound::Ear ear;
    world::World world;
    world::add_haptics(world, c.state());
    Captions captions;
    std::set<Caption> said, before_tightening;
    while (!c.over() && c.time() < 200.0) {
        trainer::wish(player.hand, trainer_test::wish_of(player, c, 0.02), c.setup(), c.state());
        const bool tightens = c.lesson().due()->kind != lesson::StepKind::run_down;
        for (int i = 0; i < 20 && !c.over(); ++i) {
            const auto output = c.step(trainer::move(player.hand, c.setup(), c.state()));
            REQUIRE(output);
            world::write_joints(world, c.state().joints, c.state().rounded);
            world::write_output(world, *output);
            note(captions, sound::hear(ear, c.setup(), world, sound::cues_of(c.events())), c.setup().dt);
        }
        update(captions, 0.02);
        for (const Caption caption : shown(captions)) {
            said.insert(caption);
            if (!tightens) before_tightening.insert(caption);
        }
    }
    std::filesystem::remove(file);
    REQUIRE(c.over());
    CHECK(said.count(Caption::run) == 1);
    CHECK(said.count(Caption::groan) == 1);
    CHECK(said.count(Caption::done) == 1);
    CHECK(before_tightening.count(Caption::run) == 1);
    CHECK(before_tightening.count(Caption::groan) == 0);
    CHECK(said.count(Caption::slip) == 0);
    CHECK(said.count(Caption::mistake) == 0);
    CHECK(said.count(Caption::click) == 0);
}

TEST_CASE("no more than three at once, what matters most first; each has words of its own") {
    sound::Heard all;
    all.slip = 1.0F;
    all.done = all.mistake = all.click = true;
    all.strike = 1.0F;
    Captions captions;
    note(captions, all, dt);
    CHECK(shown(captions) == std::vector{Caption::slip, Caption::mistake, Caption::click});
    std::set<std::size_t> keys;
    for (std::size_t i = 0; i < caption_count; ++i)
        CHECK(keys.insert(term(static_cast<Caption>(i)).index()).second);
}
