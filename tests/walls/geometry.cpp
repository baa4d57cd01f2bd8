// The views through walls, against closed forms.
#include <doctest/doctest.h>

#include "content/displays/wall_geometry.hpp"
#include "engine/base/random.hpp"
#include "game/view/walls.hpp"
#include "tests/walls/cave.hpp"

using namespace bolt;

namespace {

constexpr VkExtent2D picture_size{240, 192};

// Where a point is in the picture: 0 … 1 to the right and upwards.
glm::dvec2 in_picture(const render::Eye& eye, const Vec3& point) {
    const glm::dvec4 clip = glm::dmat4(eye.clip_from_world) * glm::dvec4(point, 1.0);
    return {0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w};
}

Pose random_head(Random& random) {
    const Vec3 position(random.uniform(-1.2, 1.2), random.uniform(0.5, 2.0), random.uniform(-1.2, 1.2));
    const Vec3 axis = glm::normalize(
        Vec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0) + 1.5));
    return {position, glm::angleAxis(random.uniform(-1.0, 1.0), axis)};
}

}  // namespace

TEST_CASE("Walls: a point of the wall is at its place in the picture, and hides what is behind it") {
    Random random(11);
    const content::DisplayFile cave = test::small_cave();
    for (int i = 0; i < 400; ++i) {
        const content::Wall& wall = cave.walls[static_cast<std::size_t>(i) % test::cave_walls];
        const content::WallAxes axes = content::axes_of(wall);
        const view::EyeGroup group = view::wall_eyes(wall, random_head(random), 0.065, picture_size);
        REQUIRE(group.eyes.size() == 1);
        const glm::dvec2 place(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        const Vec3 on_wall = content::in_room(axes, place.x * axes.width, place.y * axes.height);
        CHECK(glm::distance(in_picture(group.eyes[0], on_wall), place) < 1e-5);
        const Vec3 eye(group.eyes[0].position);
        const Vec3 behind = eye + random.uniform(1.01, 5.0) * (on_wall - eye);
        CHECK(glm::distance(in_picture(group.eyes[0], behind), place) < 1e-5);
    }
}

TEST_CASE("Walls: an edge that two walls share is at the same height in both pictures") {
    Random random(12);
    const content::DisplayFile cave = test::small_cave();
    const content::Wall &left = cave.walls[0], &front = cave.walls[1];
    for (int i = 0; i < 50; ++i) {
        const Pose head = random_head(random);
        const Vec3 along = glm::mix(front.lower_left, content::upper_left(front), random.uniform(0.0, 1.0));
        const glm::dvec2 a = in_picture(view::wall_eyes(left, head, 0.065, picture_size).eyes.at(0), along),
                         b = in_picture(view::wall_eyes(front, head, 0.065, picture_size).eyes.at(0), along);
        CHECK(a.x == doctest::Approx(1.0).epsilon(1e-5));
        CHECK(std::abs(b.x) < 1e-5);
        CHECK(a.y == doctest::Approx(b.y).epsilon(1e-5));
    }
}

TEST_CASE("Walls: two eyes are apart along the head's x, the left one first, and none is behind the wall") {
    content::Wall wall = test::small_cave().walls[1];
    const Pose head{{0.2, 1.6, 0.0}, glm::angleAxis(0.3, Vec3(0.0, 1.0, 0.0))};
    CHECK(view::wall_eyes(wall, head, 0.065, picture_size).eyes.size() == 1);
    wall.stereo = content::StereoMode::side_by_side;
    const view::EyeGroup both = view::wall_eyes(wall, head, 0.065, picture_size);
    REQUIRE(both.eyes.size() == 2);
    const Vec3 across = Vec3(both.eyes[1].position) - Vec3(both.eyes[0].position);
    CHECK(glm::distance(across, head.orientation * Vec3(0.065, 0.0, 0.0)) < 1e-6);
    CHECK(view::wall_eyes(wall, {{0.0, 1.6, -1.6}, head.orientation}, 0.065, picture_size).eyes.empty());
    // One eye in front of the plane and one behind it.
    const Pose across_plane{{0.0, 1.6, -1.45}, glm::angleAxis(to_radians(90.0), Vec3(0.0, 1.0, 0.0))};
    CHECK(view::wall_eyes(wall, across_plane, 0.2, picture_size).eyes.empty());
}

TEST_CASE("Walls: each stereo mode has its viewports in the window") {
    content::Wall wall;
    const VkExtent2D window{401, 300};
    const auto viewports = [&](view::WallWindow::Shows shows) {
        return view::eye_viewports(wall, shows, window);
    };
    const auto is_at = [](const view::EyeViewport& viewport, std::uint32_t eye, const VkRect2D& r) {
        return viewport.eye == eye && viewport.area.offset.x == r.offset.x &&
               viewport.area.offset.y == r.offset.y && viewport.area.extent.width == r.extent.width &&
               viewport.area.extent.height == r.extent.height;
    };
    using Shows = view::WallWindow::Shows;
    REQUIRE(viewports(Shows::all).size() == 1);
    CHECK(is_at(viewports(Shows::all)[0], 0, {{0, 0}, window}));
    wall.stereo = content::StereoMode::side_by_side;
    REQUIRE(viewports(Shows::all).size() == 2);
    CHECK(is_at(viewports(Shows::all)[0], 0, {{0, 0}, {200, 300}}));
    CHECK(is_at(viewports(Shows::all)[1], 1, {{200, 0}, {201, 300}}));
    wall.swap_eyes = true;
    CHECK(viewports(Shows::all)[0].eye == 1);
    wall.stereo = content::StereoMode::top_bottom;
    wall.swap_eyes = false;
    CHECK(is_at(viewports(Shows::all)[0], 0, {{0, 0}, {401, 150}}));
    CHECK(is_at(viewports(Shows::all)[1], 1, {{0, 150}, {401, 150}}));
    wall.stereo = content::StereoMode::two_outputs;
    CHECK(is_at(viewports(Shows::left_output).at(0), 0, {{0, 0}, window}));
    CHECK(is_at(viewports(Shows::right_output).at(0), 1, {{0, 0}, window}));
    wall.swap_eyes = true;
    CHECK(viewports(Shows::left_output).at(0).eye == 1);
}

TEST_CASE("Walls: a point is on a wall if the line from the eye through it meets the picture") {
    const content::DisplayFile cave = test::small_cave();
    const std::span<const content::Wall> front(&cave.walls[1], 1);
    const Vec3 eye(0.0, 1.2, 0.0);
    CHECK(view::on_a_wall(front, eye, {0.0, 1.2, -0.5}));
    CHECK(view::on_a_wall(front, eye, {0.0, 1.2, -5.0}));
    CHECK_FALSE(view::on_a_wall(front, eye, {0.0, 1.2, 0.5}));   // behind the viewer
    CHECK_FALSE(view::on_a_wall(front, eye, {0.0, 0.5, -0.5}));  // meets the plane below the picture
    CHECK(view::on_a_wall(cave.walls, eye, {0.0, 0.5, -0.5}));   // the floor shows it
    CHECK_FALSE(view::on_a_wall(front, {0.0, 1.2, -2.0}, {0.0, 1.2, -3.0}));  // an eye behind the wall
}

TEST_CASE("Walls: outputs become windows, and an output that is not here is refused by name") {
    content::DisplayFile file = test::small_cave();
    const content::DisplayHost host{{{"DP-1", 0, 0, 1920, 1080}, {"DP-2", 1920, 0, 1280, 720}}, 0, ":0"};
    const auto plan = view::plan_wall_windows(file, host);
    REQUIRE(plan);
    REQUIRE(plan->size() == test::cave_walls);
    CHECK((*plan)[1].area.x == 240);
    CHECK((*plan)[1].area.width == 240);
    CHECK((*plan)[1].wall == 1);

    content::Wall& wall = file.walls[1];
    wall.stereo = content::StereoMode::two_outputs;
    wall.output = {};
    wall.output.monitor = "DP-2";
    wall.right_output = content::DisplayOutput();
    wall.right_output->monitor_index = 0;
    const auto two = view::plan_wall_windows(file, host);
    REQUIRE(two);
    REQUIRE(two->size() == test::cave_walls + 1);
    CHECK((*two)[1].area.x == 1920);
    CHECK((*two)[1].shows == view::WallWindow::Shows::left_output);
    CHECK((*two)[2].area.height == 1080);
    CHECK((*two)[2].shows == view::WallWindow::Shows::right_output);

    const auto refused = [&](const char* part) {
        const auto result = view::plan_wall_windows(file, host);
        REQUIRE_FALSE(result);
        CHECK(result.error().code == ErrorCode::no_device);
        CHECK(result.error().message().find("\"front\"") != std::string::npos);
        CHECK(result.error().message().find(part) != std::string::npos);
    };
    wall.output.monitor = "DP-7";
    refused("\"DP-7\"; expected \"DP-1\", \"DP-2\"");
    wall.output.monitor = "DP-1";
    wall.output.display = ":0.1";
    refused(":0.1");
    wall.output.display = {};
}

TEST_CASE(
    "Walls: each process opens its windows, and the number of a process that does not exist is refused") {
    content::DisplayFile file = test::small_cave();
    file.walls[1].output.process = 1;
    file.walls[3].output.process = 1;
    content::DisplayHost host{{{"DP-1", 0, 0, 1920, 1080}}, 0, ":0", 2};
    const auto first = view::plan_wall_windows(file, host);
    REQUIRE(first);
    CHECK(first->size() == test::cave_walls - 2);
    host.process = 1;
    const auto second = view::plan_wall_windows(file, host);
    REQUIRE(second);
    REQUIRE(second->size() == 2);
    CHECK((*second)[0].wall == 1);
    CHECK((*second)[1].wall == 3);

    const auto refused = [&](const char* part) {
        const auto result = view::plan_wall_windows(file, host);
        REQUIRE_FALSE(result);
        CHECK(result.error().code == ErrorCode::usage);
        CHECK(result.error().message().find(part) != std::string::npos);
    };
    host = {{}, 2, ":0", 3};
    refused("process 2 shows no wall");
    file.walls[1].output.process = 4;
    refused("wall \"front\": its output has rank 4, and there are 3 processes; expected mpirun -n 5");
    host = {{}, 0, ":0", 1};
    refused("has rank 4, and the program was started alone");
}
