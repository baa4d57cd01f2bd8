#include "haptics/contact/solid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "haptics/contact/closest.hpp"
#include "haptics/contact/embree_query.hpp"

namespace bolt::contact {
namespace {

struct DeviceRelease {
    void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
};
struct GeometryRelease {
    void operator()(RTCGeometryTy* geometry) const { rtcReleaseGeometry(geometry); }
};

struct Candidate {
    double squared;
    std::uint32_t triangle;
    Region region;
    Vec3 point;
};

bool nearer(const Candidate& a, const Candidate& b) {
    return a.squared != b.squared ? a.squared < b.squared : a.triangle < b.triangle;
}

Vec3 pseudonormal(const ContactMesh& mesh, const Candidate& c) {
    if (c.region < 3) return Vec3(mesh.vertex_normals[mesh.triangles[c.triangle][c.region]]);
    if (c.region < 6) return Vec3(mesh.edge_normals[c.triangle][c.region - 3U]);
    const auto [a, b, d] = corners(mesh, c.triangle);
    return glm::cross(b - a, d - a);
}

bool is_behind_surface(const ContactMesh& mesh, const Vec3& p, const Candidate& c) {
    return glm::dot(p - c.point, pseudonormal(mesh, c)) < 0.0;
}

// What one point query has found so far. The set kept does not depend on the order of arrival: it is the
// nearest ones by distance and triangle.
struct Gathering {
    static constexpr std::size_t room = 64;
    const ContactMesh* mesh;
    const std::array<glm::vec3, 3>* corners;
    const std::uint16_t* part;
    Vec3 p;
    double band2, radius2;
    double asked2;  // the square of the radius that is looked within now
    glm::vec3 rounded;
    float asked_in_float;  // the square of Embree's radius
    static constexpr double limit = std::numeric_limits<double>::infinity();
    Candidate nearest{limit, 0xffffffffU, 6, {}};
    // Where surfaces of several parts are in one place: the nearest that the point is inside of.
    Candidate inside = nearest;
    std::array<Candidate, room> kept;
    std::size_t count = 0;
    std::size_t furthest = 0;  // of the kept, once they fill the room

    [[nodiscard]] double limit2() const { return count < room ? band2 : kept[furthest].squared; }

    void consider_inside(const Candidate& c) {
        if (nearer(c, inside) && is_behind_surface(*mesh, p, c)) inside = c;
    }
    void find_furthest() {
        furthest = 0;
        for (std::size_t i = 1; i < count; ++i)
            if (nearer(kept[furthest], kept[i])) furthest = i;
    }
    void add(const Candidate& found) {
        if (nearest.squared < limit && part[found.triangle] != part[nearest.triangle] &&
            std::sqrt(found.squared) <= std::sqrt(nearest.squared) + one_place) {
            consider_inside(found);
            consider_inside(nearest);
        }
        if (nearer(found, nearest)) nearest = found;
        if (found.squared > band2) return;
        if (count < room) {
            kept[count++] = found;
            if (count == room) find_furthest();
            return;
        }
        if (!nearer(found, kept[furthest])) return;
        kept[furthest] = found;
        find_furthest();
    }
};

bool gather(RTCPointQueryFunctionArguments* arguments) {
    auto& g = *static_cast<Gathering*>(arguments->userPtr);
    const auto& t = g.corners[arguments->primID];
    // Embree asks for all triangles of a leaf; most are set aside by their box.
    const glm::vec3 low = glm::min(glm::min(t[0], t[1]), t[2]);
    const glm::vec3 high = glm::max(glm::max(t[0], t[1]), t[2]);
    const glm::vec3 beside = glm::max(glm::max(low - g.rounded, g.rounded - high), glm::vec3(0.0F));
    if (glm::dot(beside, beside) > g.asked_in_float) return false;
    const auto [point, region] = closest_on_triangle(g.p, {Vec3(t[0]), Vec3(t[1]), Vec3(t[2])});
    const Vec3 between = g.p - point;
    g.add({glm::dot(between, between), arguments->primID, region, point});
    const double needed2 = std::max(g.limit2(), std::min(g.nearest.squared, g.radius2));
    if (!(needed2 < g.asked2)) return false;
    g.asked2 = needed2;
    const float radius = std::min(arguments->query->radius, with_margin(std::sqrt(needed2), g.p));
    arguments->query->radius = radius;
    g.asked_in_float = radius * radius;
    return true;
}

Side make_side(const ContactMesh& mesh, const Vec3& p, const Candidate& c) {
    const Vec3 pseudo = glm::normalize(pseudonormal(mesh, c));
    const Vec3 between = p - c.point;
    Side side{std::sqrt(c.squared), c.point, pseudo, c.triangle};
    const bool inside = glm::dot(between, pseudo) < 0.0;
    // On the surface itself, or over a face, the direction is the surface's own.
    if (c.region < 6 && side.distance > 1e-9)
        side.normal = between / (inside ? -side.distance : side.distance);
    if (inside) side.distance = -side.distance;
    return side;
}

// Of several surfaces in one place the one that the point is inside of counts: where parts touch, a point in
// one of them is on the other's surface too, from outside.
Side nearest_side(const Gathering& g) {
    const bool inside = g.inside.squared < Gathering::limit &&
                        std::sqrt(g.inside.squared) <= std::sqrt(g.nearest.squared) + one_place;
    return make_side(*g.mesh, g.p, inside ? g.inside : g.nearest);
}

// Whether all of the triangle that is within the band lies behind the side's plane, but for the tolerance.
bool is_behind(const ContactMesh& mesh, const Candidate& c, const Side& side, double band2) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : corners(mesh, c.triangle))
        highest = std::max(highest, glm::dot(v - side.point, side.normal));
    if (highest <= side_tolerance) return true;
    const Vec3 face(mesh.face_normals[c.triangle]);
    const double along = glm::dot(face, side.normal);
    const double slope = std::sqrt(std::max(0.0, 1.0 - along * along));
    const double height = glm::dot(c.point - side.point, side.normal);
    // Nothing of the band is further from the closest point than this, within the triangle's plane.
    const double span = std::sqrt(std::max(0.0, band2 - c.squared)) + std::sqrt(c.squared);
    return height + slope * span <= side_tolerance;
}

void edge_box(const RTCBoundsFunctionArguments* arguments) {
    const auto& solid = *static_cast<const Solid*>(arguments->geometryUserPtr);
    const SharpEdge& edge = solid.mesh.sharp_edges[solid.ridges[arguments->primID]];
    const glm::vec3 low =
        glm::min(solid.mesh.vertices[edge.vertices[0]], solid.mesh.vertices[edge.vertices[1]]);
    const glm::vec3 high =
        glm::max(solid.mesh.vertices[edge.vertices[0]], solid.mesh.vertices[edge.vertices[1]]);
    *arguments->bounds_o = {low.x, low.y, low.z, 0.0F, high.x, high.y, high.z, 0.0F};
}

Result<SceneHandle> commit(RTCDevice device, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    SceneHandle scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);

    rtcAttachGeometry(scene.get(), geometry);
    rtcCommitScene(scene.get());
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        return fail(ErrorCode::failed, fmt::format("Embree could not build a contact scene (error {})",
                                                   static_cast<int>(error)));
    return scene;
}

Status build_scenes(Solid& solid) {
    const std::unique_ptr<RTCDeviceTy, DeviceRelease> device(rtcNewDevice("threads=1"));
    if (!device) return fail(ErrorCode::failed, "Embree opens no device");
    const auto new_geometry = [&](RTCGeometryType type) {
        return std::unique_ptr<RTCGeometryTy, GeometryRelease>(rtcNewGeometry(device.get(), type));
    };
    const auto triangles = new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
    const ContactMesh& mesh = solid.mesh;
    void* vertices = rtcSetNewGeometryBuffer(triangles.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(glm::vec3), mesh.vertices.size());
    void* indices = rtcSetNewGeometryBuffer(triangles.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(mesh.triangles[0]), mesh.triangles.size());
    if (vertices == nullptr || indices == nullptr)
        return fail(ErrorCode::failed, "Embree has no memory for a contact mesh");
    std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(glm::vec3));
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
    Result<SceneHandle> scene = commit(device.get(), triangles.get());
    if (!scene) return fail(scene.error());
    solid.scene = std::move(*scene);
    if (solid.ridges.empty()) return {};

    const auto edges = new_geometry(RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(edges.get(), static_cast<unsigned>(solid.ridges.size()));
    rtcSetGeometryUserData(edges.get(), &solid);  // read by `edge_box` during this commit only
    rtcSetGeometryBoundsFunction(edges.get(), edge_box, nullptr);
    Result<SceneHandle> edge_scene = commit(device.get(), edges.get());
    if (!edge_scene) return fail(edge_scene.error());
    solid.edge_scene = std::move(*edge_scene);
    return {};
}

}  // namespace

void SceneRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Result<Solid> make_solid(std::span<const ContactMesh> parts) {
    Solid solid;
    if (parts.size() > 0xffff) return fail(ErrorCode::bad_content, "more than 65,535 parts in one solid");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        append(solid.mesh, parts[i]);
        solid.part.resize(solid.mesh.triangles.size(), static_cast<std::uint16_t>(i));
    }
    if (solid.mesh.triangles.empty()) return fail(ErrorCode::bad_content, "a solid without a triangle");
    for (std::uint32_t i = 0; i < solid.mesh.sharp_edges.size(); ++i)
        if (solid.mesh.sharp_edges[i].convex) solid.ridges.push_back(i);
    for (const auto& t : solid.mesh.triangles)
        solid.corners.push_back(
            {solid.mesh.vertices[t[0]], solid.mesh.vertices[t[1]], solid.mesh.vertices[t[2]]});
    solid.box = {Vec3(solid.mesh.vertices[0]), Vec3(solid.mesh.vertices[0])};
    for (const glm::vec3& v : solid.mesh.vertices) {
        solid.box.low = glm::min(solid.box.low, Vec3(v));
        solid.box.high = glm::max(solid.box.high, Vec3(v));
    }
    solid.middle = 0.5 * (solid.box.low + solid.box.high);
    for (const glm::vec3& v : solid.mesh.vertices) {
        solid.radius = std::max(solid.radius, glm::length(Vec3(v) - solid.middle));
        solid.reach = std::max(solid.reach, glm::length(Vec3(v)));
    }
    if (const Status built = build_scenes(solid); !built) return fail(built.error());
    return solid;
}

Near near_point(const Solid& solid, const Vec3& point, double radius, double band, std::span<Side> sides) {
    Gathering g;
    g.mesh = &solid.mesh;
    g.corners = solid.corners.data();
    g.part = solid.part.data();
    g.p = point;
    g.band2 = band * band;
    const double within = std::max(radius, band);
    g.radius2 = g.asked2 = within * within;
    RTCPointQuery query = make_query(point, within);
    g.rounded = glm::vec3(point);
    g.asked_in_float = query.radius < 1e18F ? query.radius * query.radius : FLT_MAX;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(solid.scene.get(), &query, &context, gather, &g);

    Near near;
    near.complete = band;
    if (!(g.nearest.squared <= g.radius2)) return near;
    // When the room is full Embree stops looking further: whether there was more is not known.
    if (g.count == Gathering::room) near.complete = std::sqrt(g.kept[g.furthest].squared);
    std::sort(g.kept.begin(), g.kept.begin() + static_cast<std::ptrdiff_t>(g.count), nearer);
    const Side first = nearest_side(g);
    near.distance = first.distance;
    if (first.distance > band) return near;
    if (sides.empty()) {
        near.complete = std::min(near.complete, first.distance);
        return near;
    }
    sides[near.sides++] = first;
    for (std::size_t i = 0; i < g.count; ++i) {
        const Candidate& c = g.kept[i];
        if (c.triangle == first.triangle) continue;
        const auto written = sides.first(near.sides);
        if (std::any_of(written.begin(), written.end(),
                        [&](const Side& side) { return is_behind(solid.mesh, c, side, g.band2); }))
            continue;
        const Side side = make_side(solid.mesh, point, c);
        // Seen from behind: inside, where the nearest surface alone leads out.
        if (side.distance < 0.0 || glm::dot(point - c.point, Vec3(solid.mesh.face_normals[c.triangle])) < 0.0)
            continue;
        if (near.sides == sides.size()) {
            near.complete = std::min(near.complete, side.distance);
            break;
        }
        sides[near.sides++] = side;
    }
    return near;
}

bool blocked(const Solid& solid, const Vec3& from, const Vec3& to) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x);
    ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(to.x - from.x);
    ray.dir_y = static_cast<float>(to.y - from.y);
    ray.dir_z = static_cast<float>(to.z - from.z);
    ray.tfar = 1.0F;
    ray.mask = 0xffffffffU;
    rtcOccluded1(solid.scene.get(), &context, &ray);
    return ray.tfar < 0.0F;
}

}  // namespace bolt::contact
