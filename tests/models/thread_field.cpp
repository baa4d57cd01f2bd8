// Tests of the thread as a height field: its polygons are closed and follow the profile of ISO 68-1.
#include "tools/assets/models/screw_thread.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::models;

namespace {

ThreadField bolt_thread(double d, double pitch, double z0, double length) {
    ThreadField field;
    field.pitch = pitch;
    field.r_crest = 0.5 * d;
    field.r_root = 0.5 * d - 0.613435 * pitch;
    field.crest_half_width = pitch / 16.0;
    field.half_angle = pi / 6.0;
    field.z0 = z0;
    field.z1 = length;
    const double slope = (field.r_crest - field.r_root) / (2.0 * pitch);
    field.at_least = {{field.r_crest + slope * z0, 0.0, -slope}};
    field.at_most = {{field.r_root - 0.1 * pitch + length, 0.0, -1.0}};
    return field;
}

// Counts the sides that belong to one face only, except those on the two ends.
int open_sides(const FieldMesh& mesh, const ThreadField& field) {
    std::map<std::pair<int, int>, int> sides;
    for (const FieldFace& face : mesh.faces)
        for (std::size_t i = 0; i < face.corners.size(); ++i)
            ++sides[{face.corners[i], face.corners[(i + 1) % face.corners.size()]}];
    int open = 0;
    for (const auto& [side, count] : sides) {
        const FieldVertex& a = mesh.vertices[static_cast<std::size_t>(side.first)];
        const FieldVertex& b = mesh.vertices[static_cast<std::size_t>(side.second)];
        const auto on_end = [&](double z) { return std::abs(a.z - z) < 1e-7 && std::abs(b.z - z) < 1e-7; };
        if (count != 1) ++open;
        if (sides.count({side.second, side.first}) == 0 && !on_end(field.z0) && !on_end(field.z1)) ++open;
    }
    return open;
}

double area(const FieldMesh& mesh) {
    double sum = 0.0;
    for (const FieldFace& face : mesh.faces)
        for (std::size_t i = 0; i < face.corners.size(); ++i) {
            const FieldVertex& a = mesh.vertices[static_cast<std::size_t>(face.corners[i])];
            const FieldVertex& b =
                mesh.vertices[static_cast<std::size_t>(face.corners[(i + 1) % face.corners.size()])];
            sum += 0.5 * (theta_in_sector(a, face.sector) * b.z - theta_in_sector(b, face.sector) * a.z);
        }
    return sum;
}

}  // namespace

TEST_CASE("Thread field: the faces cover the cylinder once and leave no side open") {
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const double d = 3.0 + 40.0 * random.uniform(), pitch = d * (0.05 + 0.12 * random.uniform());
        const double z0 = 5.0 * random.uniform(), length = z0 + pitch * (4.0 + 20.0 * random.uniform());
        CAPTURE(d);
        CAPTURE(pitch);
        const ThreadField field = bolt_thread(d, pitch, z0, length);
        const FieldMesh mesh = thread_polygons(field);
        CHECK(open_sides(mesh, field) == 0);
        CHECK(area(mesh) == doctest::Approx(2.0 * pi * (length - z0)).epsilon(1e-9));
    }
}

TEST_CASE("Thread field: every corner lies on the planes of all its faces, not above the crest") {
    const ThreadField field = bolt_thread(16.0, 2.0, 27.0, 75.0);
    const FieldMesh mesh = thread_polygons(field);
    for (const FieldFace& face : mesh.faces)
        for (const int v : face.corners) {
            const FieldVertex& corner = mesh.vertices[static_cast<std::size_t>(v)];
            CHECK(face.plane.at(theta_in_sector(corner, face.sector), corner.z) ==
                  doctest::Approx(corner.r).epsilon(1e-9));
            CHECK(corner.r < field.r_crest + 1e-9);
        }
}

TEST_CASE("Thread field: the check finds a missing face") {
    const ThreadField field = bolt_thread(16.0, 2.0, 27.0, 75.0);
    FieldMesh mesh = thread_polygons(field);
    mesh.faces.erase(mesh.faces.begin() + 20);
    CHECK(open_sides(mesh, field) > 0);
}
