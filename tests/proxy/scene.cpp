#include "tests/proxy/scene.hpp"

#include <cmath>

namespace bolt::test {

namespace {

Closest closest_on(const HalfSpace& plane, const Vec3& to) {
    const double d = glm::dot(plane.normal, to) - plane.offset;
    return {to - d * plane.normal, plane.normal, d};
}

Closest closest_on(const Ball& ball, const Vec3& to) {
    const Vec3 from = to - ball.centre;
    const double length = glm::length(from);
    const Vec3 normal = length > 0.0 ? from / length : Vec3(0, 0, 1);
    return {ball.centre + ball.radius * normal, normal, length - ball.radius};
}

Closest closest_on(const Box& box, const Vec3& to) {
    const Vec3 x = inverse(box.pose) * to;
    const Vec3 nearest = glm::clamp(x, -box.half, box.half);
    const Vec3 off = x - nearest;
    const double outside = glm::length(off);
    Vec3 point = nearest, normal(0.0);
    double distance = outside;
    if (outside > 0.0) {
        normal = off / outside;
    } else {
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            if (box.half[i] - std::abs(x[i]) < box.half[axis] - std::abs(x[axis])) axis = i;
        normal[axis] = x[axis] < 0.0 ? -1.0 : 1.0;
        point[axis] = normal[axis] * box.half[axis];
        distance = std::abs(x[axis]) - box.half[axis];
    }
    return {box.pose * point, box.pose.orientation * normal, distance};
}

Closest closest_on(const Rod& rod, const Vec3& to) {
    const Vec3 along = rod.b - rod.a;
    const double t = std::clamp(glm::dot(to - rod.a, along) / glm::dot(along, along), 0.0, 1.0);
    return closest_on(Ball{rod.a + t * along, rod.radius}, to);
}

Contact against_pin(const Box& part, const Pose& pose, const Ball& pin) {
    Box placed = part;
    placed.pose = pose * part.pose;
    const Closest c = closest_on(placed, pin.centre);
    Contact contact;
    contact.on_tool = c.point;
    contact.on_obstacle = pin.centre - pin.radius * c.normal;
    contact.normal = -c.normal;
    contact.distance = c.distance - pin.radius;
    contact.obstacle = pin.obstacle;
    return contact;
}

}  // namespace

Closest closest(const Obstacle& obstacle, const Vec3& to) {
    return std::visit([&](const auto& shape) { return closest_on(shape, to); }, obstacle);
}

ContactQueryResult Scene::operator()(const Pose& pose, double band, std::span<Contact> contacts) const {
    ++looks;
    ContactQueryResult found;
    found.complete_within = band;
    const auto keep = [&](const Contact& contact) {
        if (contact.distance >= found.complete_within) return;
        std::size_t at = found.count;
        while (at > 0 && contacts[at - 1].distance > contact.distance) --at;
        if (at == contacts.size()) {
            found.truncated = true;
            found.complete_within = contact.distance;
            return;
        }
        if (found.count == contacts.size()) {
            found.truncated = true;
            found.complete_within = contacts[--found.count].distance;
        }
        for (std::size_t i = found.count; i > at; --i) contacts[i] = contacts[i - 1];
        contacts[at] = contact;
        ++found.count;
    };
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3 at = pose * points[p];
        Contact best;
        best.distance = band;
        for (std::size_t o = 0; o < obstacles.size(); ++o) {
            const Closest c = closest(obstacles[o], at);
            if (c.distance >= band) continue;
            Contact contact;
            contact.on_tool = at;
            contact.on_obstacle = c.point;
            contact.normal = c.normal;
            contact.distance = c.distance;
            contact.obstacle = collision::ObstacleId::fixed(o);
            contact.feature = static_cast<std::uint32_t>(p);
            if (!nearest_only)
                keep(contact);
            else if (contact.distance < best.distance)
                best = contact;
        }
        if (nearest_only) keep(best);
    }
    for (const Box& part : parts)
        for (std::size_t i = 0; i < pins.size(); ++i) {
            Contact contact = against_pin(part, pose, pins[i]);
            contact.feature = 1U << 31U | static_cast<std::uint32_t>(i);
            keep(contact);
        }
    return found;
}

double clearance(const Scene& scene, const Pose& pose) {
    double least = 1e9;
    for (const Vec3& point : scene.points)
        for (const Obstacle& obstacle : scene.obstacles)
            least = std::min(least, closest(obstacle, pose * point).distance);
    for (const Box& part : scene.parts)
        for (const Ball& pin : scene.pins) least = std::min(least, against_pin(part, pose, pin).distance);
    return least;
}

void add_box(Scene& scene, const Box& box, double spacing) {
    int n[3];
    for (int i = 0; i < 3; ++i) n[i] = std::max(1, static_cast<int>(std::ceil(2.0 * box.half[i] / spacing)));
    for (int i = 0; i <= n[0]; ++i)
        for (int j = 0; j <= n[1]; ++j)
            for (int k = 0; k <= n[2]; ++k) {
                if (i % n[0] != 0 && j % n[1] != 0 && k % n[2] != 0) continue;
                const Vec3 x(2.0 * i / n[0] - 1.0, 2.0 * j / n[1] - 1.0, 2.0 * k / n[2] - 1.0);
                scene.points.push_back(box.pose * (x * box.half));
            }
    scene.parts.push_back(box);
}

void add_edges_as_pins(Scene& scene, const Box& box, double spacing) {
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            const int n = std::max(1, static_cast<int>(std::ceil(2.0 * box.half[axis] / spacing)));
            for (int i = 0; i <= n; ++i) {
                Vec3 x;
                x[axis] = 2.0 * i / n - 1.0;
                x[(axis + 1) % 3] = corner % 2 == 0 ? -1.0 : 1.0;
                x[(axis + 2) % 3] = corner / 2 == 0 ? -1.0 : 1.0;
                scene.pins.push_back({box.pose * (x * box.half), 0.0});
            }
        }
}

}  // namespace bolt::test
