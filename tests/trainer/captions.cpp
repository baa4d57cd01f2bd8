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
    const auto all = visible_captions(captions);
    return std::find(all.begin(), all.end(), caption) != all.end();
}

}  // namespace

TEST_CASE("Captions: each sound shows its caption in the same tick, and the caption expires") {
    struct Row {
        sound::SoundCues heard;
        Caption caption;
    };
    std::vector<Row> rows(7);
    rows[0] = {{}, Caption::slip};
    rows[0].heard.slip = 0.05F;
    rows[1] = {{}, Caption::mistake};
    rows[1].heard.mistake = true;
    rows[2] = {{}, Caption::click};
    rows[2].heard.click = true;
    rows[3] = {{}, Caption::done};
    rows[3].heard.done = true;
    rows[4] = {{}, Caption::strike_casing};
    rows[4].heard.strike_speed = 0.3F;
    rows[5] = {{}, Caption::strike_nut};
    rows[5].heard.strike_speed = 0.3F;
    rows[5].heard.surface = sound::StruckSurface::nut;
    rows[6] = {{}, Caption::tooth};
    rows[6].heard.tooth = true;
    for (const Row& row : rows) {
        Captions captions;
        observe(captions, {}, dt);
        CHECK(visible_captions(captions).empty());
        observe(captions, row.heard, dt);
        CHECK(visible_captions(captions) == std::vector{row.caption});
        update(captions, caption_duration - 0.01);
        CHECK(says(captions, row.caption));
        update(captions, 0.02);
        CHECK(visible_captions(captions).empty());
    }
}

TEST_CASE("Captions: a lasting sound has one caption while it lasts; a short blip has none") {
    sound::SoundCues groans;
    groans.creep_speed = 0.2F;
    groans.load = 0.8F;
    Captions captions;
    for (int i = 0; i < 90; ++i) observe(captions, groans, dt);  // 0.018 rad
    CHECK(visible_captions(captions).empty());
    for (int i = 0; i < 50; ++i) observe(captions, groans, dt);
    CHECK(visible_captions(captions) == std::vector{Caption::creep});
    for (int frame = 0; frame < 50; ++frame) {  // five seconds
        for (int i = 0; i < 100; ++i) observe(captions, groans, dt);
        update(captions, 0.1);
        CHECK(says(captions, Caption::creep));
    }
    Captions blips;
    for (int i = 0; i < 5000; ++i) observe(blips, i % 1000 < 50 ? groans : sound::SoundCues{}, dt);
    CHECK(visible_captions(blips).empty());
    sound::SoundCues scrapes;
    scrapes.slide_speed = 0.2F;
    scrapes.contact_force = 5.0F;
    for (int i = 0; i < 5000; ++i) observe(blips, i % 1000 < 100 ? scrapes : sound::SoundCues{}, dt);
    CHECK(visible_captions(blips).empty());
    for (int i = 0; i < 200; ++i) observe(blips, scrapes, dt);
    CHECK(visible_captions(blips) == std::vector{Caption::scrape});
    blips = {};
    sound::SoundCues unloaded = groans;
    unloaded.load = 0.05F;
    for (int i = 0; i < 1000; ++i) observe(blips, unloaded, dt);
    CHECK(visible_captions(blips).empty());
}

TEST_CASE("Captions: a played lesson shows exactly the captions of the sounds that occur") {
    const content::Assembly cover = trainer_test::assembly("cover-m8");
    session::LessonOptions options;
    options.trainee_profile = "player";
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    auto session = session::LessonSession::begin(cover, options, file);
    if (!session) FAIL(session.error().message());
    session::LessonSession& c = **session;
    trainer_test::Player player;
    player.hand = trainer::make_hand({Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)});
    sound::EventDetector detector;
    world::World world;
    world::add_haptics(world, c.state());
    Captions captions;
    std::set<Caption> said, before_tightening;
    while (!c.finished() && c.time() < 200.0) {
        trainer::apply_command(player.hand, trainer_test::next_command(player, c, 0.02), c.setup(),
                               c.state());
        const bool tightens = c.lesson().due()->kind != lesson::StepKind::run_down;
        for (int i = 0; i < 20 && !c.finished(); ++i) {
            const auto output = c.tick(world, trainer::step_hand(player.hand, c.setup(), c.state()));
            REQUIRE(output);
            observe(captions,
                    sound::detect_events(detector, c.setup(), world, sound::lesson_cues(c.events())),
                    c.setup().dt);
        }
        update(captions, 0.02);
        for (const Caption caption : visible_captions(captions)) {
            said.insert(caption);
            if (!tightens) before_tightening.insert(caption);
        }
    }
    std::filesystem::remove(file);
    REQUIRE(c.finished());
    CHECK(said.count(Caption::run) == 1);
    CHECK(said.count(Caption::creep) == 1);
    CHECK(said.count(Caption::done) == 1);
    CHECK(before_tightening.count(Caption::run) == 1);
    CHECK(before_tightening.count(Caption::creep) == 0);
    CHECK(said.count(Caption::slip) == 0);
    CHECK(said.count(Caption::mistake) == 0);
    CHECK(said.count(Caption::click) == 0);
    CHECK(said.count(Caption::tooth) == 0);
}

TEST_CASE("Captions: at most three at once, the most important first, each with its own text") {
    sound::SoundCues all;
    all.slip = 1.0F;
    all.done = all.mistake = all.click = true;
    all.strike_speed = 1.0F;
    Captions captions;
    observe(captions, all, dt);
    CHECK(visible_captions(captions) == std::vector{Caption::slip, Caption::mistake, Caption::click});
    std::set<std::size_t> keys;
    for (std::size_t i = 0; i < caption_count; ++i)
        CHECK(keys.insert(text_key(static_cast<Caption>(i)).index()).second);
}
