// The rotation of a drawn head about its bolt, found from the points of its mesh.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "engine/base/math.hpp"
#include "game/session/contact_models.hpp"

using namespace bolt;

namespace {

// An M12 cap screw: its socket is 10 mm wide, and its shank is about as wide as the socket's corners.
servo::NutGeometry cap_screw() {
    servo::NutGeometry nut;
    nut.is_head = true;
    nut.height = 12e-3;
    nut.across_flats = 10e-3;
    nut.socket_depth = 6e-3;
    nut.head_diameter = 18e-3;
    return nut;
}

void add_ring(std::vector<Vec3>& points, const servo::NutGeometry& nut, double radius, double height,
              int count, double turn) {
    for (int i = 0; i < count; ++i) {
        const double angle = turn + i * 2.0 * pi / count;
        points.push_back(nut.seat + radius * (std::cos(angle) * nut.e1 + std::sin(angle) * nut.e2) +
                         height * nut.axis);
    }
}

}  // namespace

TEST_CASE("Session: the corners of a socket are found beside shank, countersink and drilled end") {
    const servo::NutGeometry nut = cap_screw();
    for (const double degrees : {-25.0, -10.0, 0.0, 5.0, 17.0}) {
        CAPTURE(degrees);
        const double turn = to_radians(degrees);
        std::vector<Vec3> points;
        for (const double height : {6e-3, 12e-3})
            add_ring(points, nut, 10.1e-3 / std::sqrt(3.0), height, 6, turn);
        add_ring(points, nut, 6e-3, -20e-3, 6, 0.1);  // the end of the shank
        add_ring(points, nut, 6e-3, 0.0, 6, 0.1);     // where it meets the head
        add_ring(points, nut, 9e-3, 0.0, 6, 0.2);
        add_ring(points, nut, 9e-3, 12e-3, 6, 0.2);    // the outside of the head
        add_ring(points, nut, 6.1e-3, 12e-3, 6, 0.2);  // the countersink
        add_ring(points, nut, 5e-3, 6e-3, 6, 0.2);     // the drilled end
        const session::HexagonPose found = session::find_hexagon(nut, points);
        const Vec3 corner =
            session::to_nut_frame(nut, found, nut.seat + std::cos(turn) * nut.e1 + std::sin(turn) * nut.e2);
        CHECK(std::remainder(std::atan2(corner.y, corner.x), pi / 3.0) == doctest::Approx(0.0).epsilon(1e-3));
        CHECK(found.low == 0.0);
    }
}

TEST_CASE("Session: a head that is drawn without its socket is not rotated") {
    const servo::NutGeometry nut = cap_screw();
    std::vector<Vec3> points;
    add_ring(points, nut, 9e-3, 12e-3, 24, 0.2);
    add_ring(points, nut, 6e-3, -20e-3, 24, 0.1);
    CHECK(session::find_hexagon(nut, points).straighten.w == 1.0);
}
