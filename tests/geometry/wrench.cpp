// Room for the wrench. Closed form: a bar of half width w between two walls in planes through the axis of the
// nut, which begin at the radius r, can swing through the angle between the walls minus 2 asin(w/r).
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "engine/base/random.hpp"
#include "support.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/free_swing.hpp"
#include "tools/author/geometry/tool_geometry.hpp"

namespace geometry_wrench_test {

using namespace bolt;
using namespace geometry_test;

namespace {

constexpr double jaw = 13.2, inner = 40.0, outer = 200.0;  // mm

// Half the angle between the walls that leaves a swing of `swing_deg`.
double half_opening(double swing_deg) {
    return 0.5 * swing_deg + to_degrees(std::asin(0.5 * handle_width_ratio * jaw / inner));
}

// Two walls around a nut that leave a swing of `swing_deg`, centred at -Z.
Machine walled(double swing_deg, double low, double high) {
    Machine machine;
    const double half = half_opening(swing_deg);
    machine.add("wall_left", sector(inner, outer, 90.0 + half, 270.0, low, high));
    machine.add("wall_right", sector(inner, outer, 270.0, 450.0 - half, low, high));
    return machine;
}

std::string at_joint(const std::string& text) { return "16:5: /joints/0: " + text; }

const content::WrenchDesign design{
    .jaw = jaw * mm, .head_angle = to_radians(15.0), .handle_length = 140.0 * mm, .model = {}};

}  // namespace

TEST_CASE(
    "Geometry: 29 degrees of swing are an error, 31 give a note to turn the wrench over, 61 are enough") {
    // The walls end at 10 mm, below the start height of the nut.
    const CheckOutput few = check(walled(29.0, 0.0, 10.0));
    CHECK(
        all(few.errors) ==
        at_joint(
            R"(the wrench has 29.0 degrees of free swing on the nut: between "wall_right" and "wall_left"; expected 30 degrees or more both ways up, or 60 one way up, or a ring of 13 mm with a handle of 140 mm, which fits)"));
    const CheckOutput flip = check(walled(31.0, 0.0, 10.0));
    CHECK(all(flip.errors) == "");
    CHECK(
        all(flip.notes) ==
        at_joint(
            R"(the wrench has 31.0 degrees of free swing on the nut, between "wall_right" and "wall_left": it has to be turned over after every stroke)"));
    const CheckOutput enough = check(walled(61.0, 0.0, 10.0));
    CHECK(all(enough.errors) == "");
    CHECK(all(enough.notes) == "");
    CHECK(all(check(walled(59.0, 0.0, 10.0)).notes).find("59.0 degrees") != std::string::npos);
    CHECK(all(check(walled(29.9, 0.0, 10.0)).errors).find("29.9 degrees") != std::string::npos);
    CHECK(all(check(walled(30.1, 0.0, 10.0)).errors) == "");
}

TEST_CASE("Geometry: the free swing agrees with the closed form within 0.025 degrees") {
    const geometry::ToolGeometry wrench = plain_wrench(design);
    for (const double swing : {5.0, 17.3, 29.0, 31.0, 100.0, 200.0}) {
        const double half = half_opening(swing);
        const geometry::Bvh walls(triangles_of(sector(inner, outer, half, 360.0 - half, 0.0, 10.0)));
        for (const bool over : {false, true}) {
            const auto found =
                geometry::find_free_swing(walls, geometry::place_on_joint(wrench, over), 0.005);
            CAPTURE(swing);
            REQUIRE(found.arcs.size() == 1);
            CHECK(std::abs(to_degrees(found.arcs[0].width()) - swing) < 0.025);
        }
    }
    // The wrench is free above the walls and blocked between them.
    const geometry::Bvh walls(triangles_of(sector(inner, outer, 0.0, 350.0, 0.0, 10.0)));
    CHECK(
        geometry::find_free_swing(walls, geometry::place_on_joint(wrench, false), 0.0135).widest()->width() ==
        2.0 * pi);
    CHECK(geometry::find_free_swing(walls, geometry::place_on_joint(wrench, false), 0.005).arcs.empty());
}

TEST_CASE(
    "Geometry: separate grips add up modulo 60 degrees if one has 30 degrees; gaps too narrow to enter do "
    "not count") {
    // Openings: angle of the middle and swing, degrees.
    const auto opened = [](const std::vector<std::pair<double, double>>& openings) {
        Machine machine;
        double from = openings.front().first + half_opening(openings.front().second);
        for (std::size_t i = 1; i <= openings.size(); ++i) {
            const auto& [middle, swing] = openings[i % openings.size()];
            const double turn = i == openings.size() ? 360.0 : 0.0;
            machine.add("wall_" + std::to_string(i),
                        sector(inner, outer, from, middle + turn - half_opening(swing), 0.0, 10.0));
            from = middle + half_opening(swing);
        }
        return machine;
    };
    const auto thirty = opened({{0.0, 30.3}, {80.0, 30.3}, {160.0, 30.3}});
    CHECK(all(check(thirty).errors) == "");
    CHECK(all(check(thirty).notes) == "");  // 0, 20 and 40 degrees: no need to turn the wrench over
    CHECK(all(check(opened({{0.0, 29.7}, {80.0, 29.7}, {160.0, 29.7}})).errors).find("has 29.7 degrees") !=
          std::string::npos);
    // 58 degrees of swing; a second gap of 4 or 6 degrees supplies the missing two.
    CHECK(all(check(opened({{29.0, 58.0}, {119.0, 4.0}})).notes).find("turned over") != std::string::npos);
    CHECK(all(check(opened({{29.0, 58.0}, {119.0, 6.0}})).notes) == "");
}

TEST_CASE("Geometry: the swing is also checked at the start height of the nut") {
    CHECK(
        all(check(walled(29.0, 10.5, 20.0)).errors) ==
        at_joint(
            R"(the wrench has 29.0 degrees of free swing on the nut where it starts, 8.92 mm above its seat: between "wall_right" and "wall_left"; expected 30 degrees or more both ways up, or 60 one way up, or a ring of 13 mm with a handle of 140 mm, which fits)"));
}

TEST_CASE("Geometry: a nut that no open end fits is an error, which names a socket that does") {
    Machine machine;
    machine.add("pipe", sector(12.0, 30.0, 0.0, 360.0, 0.0, 10.0));
    CHECK(
        all(check(machine).errors) ==
        at_joint(
            R"(the wrench has 0.0 degrees of free swing on the nut: "pipe" is in its way; expected 30 degrees or more both ways up, or 60 one way up, or a socket of 13 mm with a handle of 150 mm, which fits)"));
}

TEST_CASE("Geometry: a neighbouring nut too close to the head of the wrench is an error") {
    // The head has a radius of 13.86 mm; a neighbouring nut at 20 mm begins at 12.5 to 13.5 mm.
    NutAndBolt narrow;
    narrow.side = 18.0;
    CHECK(all(check(Machine({{0, 0, 0}, {60, 0, 0}})).errors) == "");
    CHECK(all(check(Machine({{0, 0, 0}, {22, 0, 0}}, narrow)).errors) == "");
    // At 20 mm the wrench fits either way up only with the neighbour in its mouth.
    CHECK(
        all(check(Machine({{0, 0, 0}, {20, 0, 0}}, narrow)).errors)
            .starts_with(at_joint(
                R"(the wrench has 39.5 degrees of free swing on the nut: "B2_nut" is on both sides; expected 60 degrees: turning the wrench over gains nothing here)")));
    const Machine ring({{0, 0, 0}, {20, 0, 0}, {-10, 0, 17}, {-10, 0, -17}}, narrow);
    const std::string tight = all(check(ring).errors);
    CHECK(tight.find("16:5: /joints/0: the wrench has") != std::string::npos);
    CHECK(tight.find(R"("B2_)") != std::string::npos);
}

TEST_CASE("Geometry: a wrench that fits but has no free path onto the nut is an error") {
    const auto boxed = [](double from, double to, bool roof) {
        Machine machine;
        machine.add("fence", sector(170.0, 180.0, from, to, 0.0, 60.0));
        if (roof) machine.add("roof", sector(0.1, 180.0, 0.0, 360.0, 55.0, 60.0));
        return all(check(machine).errors);
    };
    CHECK(boxed(0.0, 360.0, false) == "");  // from above
    CHECK(boxed(60.0, 360.0, true) == "");  // from the side
    CHECK(
        boxed(0.0, 360.0, true) ==
        at_joint(
            R"(the wrench cannot be brought onto the nut, neither along the bolt nor from the side: "fence" is in its way; expected a free path, or the head turned instead (bolt-author import-step --turn-heads B1))"));
}

TEST_CASE("Geometry: a corner at 1e30 mm does not keep the checks from ending") {
    Machine machine;
    PrismMesh needle;
    needle.quad({30, 0, 30}, {31, 0, 30}, {31, 1e30, 31}, {30, 1e30, 31});
    machine.add("needle", needle);
    CHECK(all(check(machine).errors) == "");
}

TEST_CASE("Geometry: the jaw, the origin and the unit of a wrench model are measured") {
    const auto model_of = [](double opening, double shift, double scale, bool lies) {
        const content::WrenchDesign other{
            .jaw = opening * mm, .head_angle = to_radians(15.0), .handle_length = 140.0 * mm, .model = {}};
        return geometry_test::model_of(plain_wrench(other), shift, scale, lies);
    };
    const auto errors_with = [&](const assets::Model& tool) {
        return all(check(Machine(), {}, nullptr, nullptr, &tool).errors);
    };
    CHECK(errors_with(model_of(13.2, 0.0, 1.0, false)) == "");
    CHECK(errors_with(model_of(13.2, 0.0, 1.0, true)) == "");
    CHECK(errors_with(model_of(13.2, 0.0, -1.0, true)).find("the wrench has no jaw about its origin") !=
          std::string::npos);
    CHECK(
        errors_with(model_of(13.0, 0.0, 1.0, false)) ==
        R"(5:49: /tool/model: the jaw of the wrench measures 13.00 mm in its model, and jaw_mm is 13.2; expected both within 0.05 mm)");
    CHECK(errors_with(model_of(13.2, 0.2, 1.0, false)).find("mm beside the origin of the wrench's model") !=
          std::string::npos);
    CHECK(
        errors_with(model_of(13.2, 0.0, 1000.0, false)).find("expected metres: it looks like millimetres") !=
        std::string::npos);
    // The plain wrench that lies flat has the same swing.
    const assets::Model same = model_of(13.2, 0.0, 1.0, true);
    CHECK(all(check(walled(29.0, 0.0, 10.0), {}, nullptr, nullptr, &same).errors).find("29.0 degrees") !=
          std::string::npos);
    CHECK(all(check(walled(31.0, 0.0, 10.0), {}, nullptr, nullptr, &same).errors) == "");
}

TEST_CASE("Geometry: a tool without a model is checked with the wrench that the trainer generates") {
    // Its handle is 12.8 mm wide at the walls, and that of the plain wrench 11.2 mm.
    const double lost = 2.0 * to_degrees(std::asin(6.4 / inner)) - 2.0 * (half_opening(29.0) - 14.5);
    CHECK(lost == doctest::Approx(2.3).epsilon(0.05));
    CHECK(all(check_generated(walled(29.0, 0.0, 10.0)).errors)
              .find("the wrench has 26.7 degrees of free swing") != std::string::npos);
    CHECK(all(check_generated(walled(30.0 + lost + 0.2, 0.0, 10.0)).errors) == "");
    Machine machine;
    machine.add("pipe", sector(12.0, 30.0, 0.0, 360.0, 0.0, 10.0));
    CHECK(all(check_generated(machine).errors).find("the wrench has 0.0 degrees of free swing") !=
          std::string::npos);
    const CheckOutput plain = check_generated(Machine());
    CHECK(all(plain.errors) == "");
    CHECK(all(plain.notes) ==
          "5:11: /tool: no model is named, so the tool is generated: open_end: size 13 mm, opening 13.2 mm, "
          "length 190 mm, head at 15 degrees");
    const auto clicks = [](std::string& text) { replace(text, "open_end_wrench", "click_torque_wrench"); };
    CHECK(all(check_generated(Machine(), clicks).errors) == "");
    // The frame of a generated wrench is known, however thick its head is.
    const auto thick = [](std::string& text) {
        replace(text, "\"jaw_mm\"", "\"head_thickness_mm\": 60, \"jaw_mm\"");
    };
    CHECK(all(check_generated(Machine(), thick).errors) == "");
}

TEST_CASE("Geometry: a straight head gains nothing from turning the wrench over") {
    const auto straight = [](std::string& text) {
        replace(text, "\"jaw_mm\"", "\"head_angle_deg\": 0, \"jaw_mm\"");
    };
    CHECK(
        all(check(walled(45.0, 0.0, 10.0), straight).errors)
            .find(
                R"(between "wall_right" and "wall_left"; expected 60 degrees: turning the wrench over gains nothing here)") !=
        std::string::npos);
    CHECK(all(check(walled(45.0, 0.0, 10.0)).errors) == "");
    CHECK(all(check(walled(61.0, 0.0, 10.0), straight).errors) == "");
}

TEST_CASE("Geometry: each tool of the file is checked and reported by its name") {
    const auto one_more = [](std::string& text) {
        replace(text, "\"tool\"",
                R"("more_tools": { "bar": { "title": { "en": "Bar" }, "kind": "open_end_wrench", )"
                R"("jaw_mm": 13.2, "head_angle_deg": 0, "handle_length_mm": 140 } }, "tool")");
    };
    CHECK(all(check(walled(45.0, 0.0, 10.0), one_more).errors).find(": the tool \"bar\" has 45.0 degrees") !=
          std::string::npos);
    CHECK(all(check(walled(45.0, 0.0, 10.0), one_more).errors).find(": the wrench has") == std::string::npos);
    CHECK(all(check(walled(61.0, 0.0, 10.0), one_more).errors) == "");
}

TEST_CASE("Geometry: intervals cover a period or leave a gap") {
    CHECK(geometry::covers_period({{0.0, 1.0}}, 1.0));
    CHECK(geometry::covers_period({{5.3, 5.8}, {7.7, 8.4}}, 1.0));
    CHECK_FALSE(geometry::covers_period({{5.3, 5.8}, {7.9, 8.2}}, 1.0));
    CHECK_FALSE(geometry::covers_period({{-0.4, 0.4}}, 1.0));
    CHECK(geometry::covers_period({{-0.4, 0.4}, {0.35, 0.65}}, 1.0));
    CHECK_FALSE(geometry::covers_period({}, 1.0));
}

TEST_CASE("Geometry: the tree finds the same crossings as all pairs of triangles") {
    Random random(5);
    const auto cloud = [&](int count, double size) {
        std::vector<geometry::Triangle> triangles;
        const auto point = [&](double reach) {
            return Vec3{random.uniform(-reach, reach), random.uniform(-reach, reach),
                        random.uniform(-reach, reach)};
        };
        for (int i = 0; i < count; ++i) {
            const Vec3 at = point(1.0);
            triangles.push_back(
                {at + point(size), at + point(size), at + point(size), static_cast<std::uint32_t>(i)});
        }
        return triangles;
    };
    int crossings = 0;
    for (int round = 0; round < 200; ++round) {
        const auto still = cloud(40, 0.1), moving = cloud(30, 0.1);
        const auto pose = geometry::RigidMotion::about_y(random.uniform(-4.0, 4.0),
                                                         Vec3{random.uniform(-1.0, 1.0), 0.1, 0.2});
        bool any = false;
        for (const auto& m : moving)
            for (const auto& s : still)
                any = any || geometry::triangles_cross({pose(m.a), pose(m.b), pose(m.c), 0}, s);
        const geometry::Bvh still_tree(still), moving_tree(moving);
        const auto found = geometry::first_crossing(still_tree, moving_tree, pose);
        REQUIRE(found.has_value() == any);
        CHECK_FALSE(
            geometry::first_crossing(still_tree, moving_tree, pose, [](std::uint32_t) { return true; }));
        crossings += any ? 1 : 0;
    }
    CHECK(crossings > 20);
    CHECK(crossings < 180);
    const geometry::Triangle flat{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
    CHECK(geometry::triangles_cross(flat, {{0.2, -1, 0.2}, {0.2, 1, 0.2}, {0.3, 1, 0.2}, 0}));
    CHECK_FALSE(
        geometry::triangles_cross(flat, {{0.2, 0, 0.2}, {0.2, 1, 0.2}, {0.3, 1, 0.2}, 0}));  // touches
    CHECK_FALSE(geometry::triangles_cross(flat, flat));
}

TEST_CASE("Geometry: the tree finds the same ray hits as all triangles") {
    Random random(6);
    std::vector<geometry::Triangle> triangles;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto point = [&] {
            return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        };
        const Vec3 at = point();
        triangles.push_back({at, at + 0.3 * point(), at + 0.3 * point(), i});
    }
    const geometry::Bvh tree(triangles);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 origin{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const Vec3 direction =
            i % 3 == 0 ? Vec3{0, 1, 0} : glm::normalize(Vec3{random.normal(), random.normal(), 0.5});
        double nearest = 1.0;
        for (const geometry::Triangle& t : triangles)
            if (const auto hit = geometry::first_hit(geometry::Bvh({t}), origin, direction, nearest))
                nearest = hit->distance;
        const auto hit = geometry::first_hit(tree, origin, direction, 1.0);
        REQUIRE(hit.has_value() == (nearest < 1.0));
        if (hit) CHECK(hit->distance == nearest);
        hits += hit ? 1 : 0;
    }
    CHECK(hits > 50);
}

TEST_CASE(
    "Geometry: the room for the wrench has its free and its blocked directions, and the nut fits the jaw") {
    const CheckOutput output = check(walled(61.0, 0.0, 10.0));
    REQUIRE(output.rooms);
    REQUIRE(output.rooms->joints.size() == 1);
    const geometry::DrawnToolRoom& room = output.rooms->joints.front();
    CHECK(room.gripped);
    CHECK(room.turned.high.y == doctest::Approx(8.4 * mm));
    CHECK(room.parts.size() == 4);
    const geometry::Arc* arc = room.swing.widest();
    REQUIRE(arc != nullptr);
    CHECK(to_degrees(arc->width()) == doctest::Approx(61.0).epsilon(0.01));
    CHECK(room.handle == doctest::Approx(0.5 * (arc->from + arc->to)));
    double blocked = 0.0;
    std::set<std::string> names;
    for (const geometry::BlockedArc& other : room.swing.blocked) {
        CHECK(other.from < other.to);
        CHECK((other.to <= arc->from + to_radians(1.0) || other.from >= arc->to - to_radians(1.0)));
        blocked += other.to - other.from;
        names.insert(output.rooms->scene.parts[other.part].name);
    }
    CHECK(names == std::set<std::string>{"wall_left", "wall_right"});
    CHECK(to_degrees(blocked + arc->width()) == doctest::Approx(360.0).epsilon(0.01));
    // A flat of the turned hexagon is at right angles to the jaw. The model's hexagon has a flat at 30
    // degrees.
    const double jaw = room.handle + (room.turned_over ? -1.0 : 1.0) * output.rooms->tools.front().head_angle;
    const double flat = to_radians(30.0) + room.turn;
    CHECK(std::abs(wrap(flat - jaw - 0.5 * pi, pi / 3.0)) < 1e-6);
}

}  // namespace geometry_wrench_test
