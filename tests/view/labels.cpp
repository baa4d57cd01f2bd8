#include "game/view/labels.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "engine/base/random.hpp"
#include "engine/render/camera.hpp"

using namespace bolt;
using namespace bolt::view;

namespace {

const glm::vec2 picture(1280.0F, 720.0F);

struct Scenery {
    text::Fonts fonts = text::load_fonts().value();
    render::Eye eye = render::make_eye({0.0F, 0.0F, 2.0F}, {0.0F, 0.0F, 0.0F}, {.aspect = 16.0F / 9.0F});

    [[nodiscard]] static render::Label label(const std::string& text, const glm::vec3& at) {
        render::Label label;
        label.text = text;
        label.position = at;
        label.height = 15.0F;
        label.anchor = {0.5F, 0.0F};
        label.offset_px = {0.0F, 10.0F};
        return label;
    }
    [[nodiscard]] int overlaps(const std::vector<render::Label>& labels) const {
        int count = 0;
        for (std::size_t i = 0; i < labels.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const LabelBox a = box_of(fonts, labels[i], eye, picture),
                               b = box_of(fonts, labels[j], eye, picture);
                if (a.visible && b.visible && a.low.x < b.high.x && b.low.x < a.high.x &&
                    a.low.y < b.high.y && b.low.y < a.high.y)
                    ++count;
            }
        return count;
    }
};

}  // namespace

TEST_CASE("Labels: a label's box is where its text is drawn") {
    const Scenery s;
    const render::Label label = Scenery::label("B1", glm::vec3(0.0F));
    const LabelBox box = box_of(s.fonts, label, s.eye, picture);
    CHECK(box.visible);
    CHECK(0.5F * (box.low.x + box.high.x) == doctest::Approx(640.0F));
    CHECK(box.high.y == doctest::Approx(360.0F - 10.0F + 0.15F * 15.0F));
    CHECK(box.high.y - box.low.y > 15.0F);
    CHECK_FALSE(box_of(s.fonts, Scenery::label("B1", {0.0F, 0.0F, 3.0F}), s.eye, picture).visible);
}

TEST_CASE("Labels: overlapping labels are separated by short moves, and others stay in place") {
    const Scenery s;
    std::vector<render::Label> two = {Scenery::label("B8 OK 84 N·m", {0.0F, 0.0F, 0.0F}),
                                      Scenery::label("F4 OK 78 N·m", {0.02F, 0.005F, 0.0F})};
    REQUIRE(s.overlaps(two) == 1);
    separate_labels(s.fonts, two, s.eye, picture);
    CHECK(s.overlaps(two) == 0);
    CHECK(two[0].offset_px == glm::vec2(0.0F, 10.0F));  // the lower one stays
    CHECK(glm::distance(two[1].offset_px, glm::vec2(0.0F, 10.0F)) < 30.0F);

    std::vector<render::Label> alone = {Scenery::label("B1", {0.0F, 0.0F, 0.0F}),
                                        Scenery::label("B2", {0.3F, 0.0F, 0.0F}),
                                        Scenery::label("behind", {0.0F, 0.0F, 3.0F})};
    separate_labels(s.fonts, alone, s.eye, picture);
    for (const render::Label& label : alone) CHECK(label.offset_px == glm::vec2(0.0F, 10.0F));
}

TEST_CASE("Labels: 25 crowded labels are separated, inside the picture") {
    const Scenery s;
    Random random(5, 1);
    std::vector<render::Label> crowd;
    for (int i = 0; i < 24; ++i)
        crowd.push_back(Scenery::label(fmt::format("J{} OK {} N·m", i, 60 + i),
                                       {random.uniform(-0.3, 0.3), random.uniform(-0.12, 0.12), 0.0}));
    crowd.push_back(Scenery::label("at the edge", {0.0F, 0.61F, 0.0F}));
    REQUIRE(s.overlaps(crowd) > 5);
    separate_labels(s.fonts, crowd, s.eye, picture);
    CHECK(s.overlaps(crowd) == 0);
    CHECK(box_of(s.fonts, crowd.back(), s.eye, picture).low.y >= 0.0F);
}

TEST_CASE("Labels: a label under a plate moves to the nearest side of the plate that has room") {
    const Scenery s;
    const auto where = [&](const render::Label& label) { return box_of(s.fonts, label, s.eye, picture); };
    std::vector<render::Label> one = {Scenery::label("B1", glm::vec3(0.0F))};
    const LabelBox before = where(one[0]);
    const render::Rectangle plate{{before.low.x - 200.0F, before.low.y - 120.0F},
                                  {before.high.x + 60.0F, before.high.y + 150.0F}};
    separate_labels(s.fonts, one, s.eye, picture, {&plate, 1});
    const LabelBox after = where(one[0]);
    CHECK(after.low.x >= plate.high.x);
    CHECK(after.low.x < plate.high.x + 4.0F);
    CHECK(after.low.y == doctest::Approx(before.low.y));

    // A plate in the corner: the moves beyond the picture do not count.
    const render::Rectangle corner{{560.0F, 330.0F}, {1280.0F, 720.0F}};
    std::vector<render::Label> two = {Scenery::label("B1", {0.55F, -0.2F, 0.0F}),
                                      Scenery::label("B2", {0.56F, -0.21F, 0.0F})};
    separate_labels(s.fonts, two, s.eye, picture, {&corner, 1});
    CHECK(s.overlaps(two) == 0);
    for (const render::Label& label : two) {
        const LabelBox box = where(label);
        CHECK((box.high.x <= corner.low.x || box.high.y <= corner.low.y));
        CHECK(box.low.x >= 0.0F);
        CHECK(box.high.x <= picture.x);
    }
}

TEST_CASE("Labels: crowded labels at the upper edge move along it or down and stay in the picture") {
    const Scenery s;
    std::vector<render::Label> crowd;
    for (int i = 0; i < 8; ++i)
        crowd.push_back(Scenery::label("0.0 turns", {0.01F * static_cast<float>(i % 2), 0.6F, 0.0F}));
    separate_labels(s.fonts, crowd, s.eye, picture);
    CHECK(s.overlaps(crowd) == 0);
    for (const render::Label& label : crowd) {
        const LabelBox box = box_of(s.fonts, label, s.eye, picture);
        REQUIRE(box.anchor_in_picture);
        CHECK(box.low.y >= -0.05F);
    }
    // An anchor outside the picture keeps its label there.
    std::vector<render::Label> away = {Scenery::label("B1", {0.0F, 0.8F, 0.0F})};
    separate_labels(s.fonts, away, s.eye, picture);
    const LabelBox box = box_of(s.fonts, away[0], s.eye, picture);
    CHECK_FALSE(box.anchor_in_picture);
    CHECK(box.high.y < 0.0F);
}
