#include "haptics/collision/solid.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>

#include "haptics/collision/closest.hpp"
#include "haptics/collision/triangle_octree.hpp"

namespace bolt::collision {
namespace {

struct DeviceRelease {
    void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
};
struct GeometryRelease {
    void operator()(RTCGeometryTy* geometry) const { rtcReleaseGeometry(geometry); }
};

void edge_box(const RTCBoundsFunctionArguments* arguments) {
    const auto& solid = *static_cast<const Solid*>(arguments->geometryUserPtr);
    const auto& [a, b] = solid.ridges[arguments->primID].ends;
    const glm::vec3 low = glm::min(a, b);
    const glm::vec3 high = glm::max(a, b);
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
    BOLT_TRY_ASSIGN(auto scene, commit(device.get(), triangles.get()));
    solid.scene = std::move(scene);
    if (solid.ridges.empty()) return {};

    const auto edges = new_geometry(RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(edges.get(), static_cast<unsigned>(solid.ridges.size()));
    rtcSetGeometryUserData(edges.get(), &solid);  // read by `edge_box` during this commit only
    rtcSetGeometryBoundsFunction(edges.get(), edge_box, nullptr);
    BOLT_TRY_ASSIGN(auto edge_scene, commit(device.get(), edges.get()));
    solid.edge_scene = std::move(edge_scene);
    return {};
}

}  // namespace

void SceneRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Result<Solid> make_solid(std::span<const ContactMesh> parts) {
    Solid solid;
    if (parts.size() > 0xffff) return fail(ErrorCode::bad_content, "more than 65,535 parts in one solid");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        append(solid.mesh, parts[i]);
        solid.part.resize(solid.mesh.triangles.size(), static_cast<std::uint32_t>(i));
    }
    if (solid.mesh.triangles.empty()) return fail(ErrorCode::bad_content, "a solid without a triangle");
    for (std::uint32_t i = 0; i < solid.mesh.sharp_edges.size(); ++i) {
        const SharpEdge& edge = solid.mesh.sharp_edges[i];
        const auto end = [&](std::size_t k) { return solid.mesh.vertices[edge.vertices[k]]; };
        if (edge.convex)
            solid.ridges.push_back(
                {{end(0), end(1)}, edge.normals, edge.inward, glm::normalize(end(1) - end(0)), i});
    }
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
    BOLT_TRY(build_scenes(solid));
    return solid;
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

// A point against a surface: candidates from Embree or from a list, and the sides that they make.

namespace {

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
    const std::uint32_t* part;
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

// The square of the distance to the triangle's box.
float beside_box(const std::array<glm::vec3, 3>& t, const glm::vec3& p) {
    const glm::vec3 low = glm::min(glm::min(t[0], t[1]), t[2]);
    const glm::vec3 high = glm::max(glm::max(t[0], t[1]), t[2]);
    const glm::vec3 beside = glm::max(glm::max(low - p, p - high), glm::vec3(0.0F));
    return glm::dot(beside, beside);
}

bool gather(RTCPointQueryFunctionArguments* arguments) {
    auto& g = *static_cast<Gathering*>(arguments->userPtr);
    const auto& t = g.corners[arguments->primID];
    // Embree asks for all triangles of a leaf; most are set aside by their box.
    if (beside_box(t, g.rounded) > g.asked_in_float) return false;
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

SeparatingPlane make_plane(const ContactMesh& mesh, const Vec3& p, const Candidate& c) {
    const Vec3 pseudo = pseudonormal(mesh, c);
    const Vec3 between = p - c.point;
    SeparatingPlane side{std::sqrt(c.squared), c.point, {}, c.triangle};
    const bool inside = glm::dot(between, pseudo) < 0.0;
    // On the surface itself, or over a face, the direction is the surface's own.
    side.normal = c.region < 6 && side.distance > 1e-9 ? between / (inside ? -side.distance : side.distance)
                                                       : glm::normalize(pseudo);
    if (inside) side.distance = -side.distance;
    return side;
}

// Of several surfaces in one place the one that the point is inside of counts: where parts touch, a point in
// one of them is on the other's surface too, from outside.
SeparatingPlane nearest_plane(const Gathering& g) {
    const bool inside = g.inside.squared < Gathering::limit &&
                        std::sqrt(g.inside.squared) <= std::sqrt(g.nearest.squared) + one_place;
    return make_plane(*g.mesh, g.p, inside ? g.inside : g.nearest);
}

// Whether all of the triangle that is within the band lies behind the side's plane, but for the tolerance.
bool is_behind(const ContactMesh& mesh, const Candidate& c, const SeparatingPlane& side, double band2) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : corners(mesh, c.triangle))
        highest = std::max(highest, glm::dot(v - side.point, side.normal));
    if (highest <= plane_tolerance) return true;
    const Vec3 face(mesh.face_normals[c.triangle]);
    const double along = glm::dot(face, side.normal);
    const double slope = std::sqrt(std::max(0.0, 1.0 - along * along));
    const double height = glm::dot(c.point - side.point, side.normal);
    // Nothing of the band is further from the closest point than this, within the triangle's plane.
    const double span = std::sqrt(std::max(0.0, band2 - c.squared)) + std::sqrt(c.squared);
    return height + slope * span <= plane_tolerance;
}

// What the candidates amount to; `first` is the nearest of them.
PointQueryResult conclude(Gathering& g, const SeparatingPlane& first, double band,
                          std::span<SeparatingPlane> planes) {
    PointQueryResult near;
    near.complete = band;
    // When the room is full Embree stops looking further: whether there was more is not known.
    if (g.count == Gathering::room) near.complete = std::sqrt(g.kept[g.furthest].squared);
    std::sort(g.kept.begin(), g.kept.begin() + static_cast<std::ptrdiff_t>(g.count), nearer);
    near.distance = first.distance;
    if (first.distance > band) return near;
    if (planes.empty()) {
        near.complete = std::min(near.complete, first.distance);
        return near;
    }
    planes[near.planes++] = first;
    for (std::size_t i = 0; i < g.count; ++i) {
        const Candidate& c = g.kept[i];
        if (c.triangle == first.triangle) continue;
        const auto written = planes.first(near.planes);
        if (std::any_of(written.begin(), written.end(),
                        [&](const SeparatingPlane& side) { return is_behind(*g.mesh, c, side, g.band2); }))
            continue;
        const SeparatingPlane side = make_plane(*g.mesh, g.p, c);
        // Seen from behind: inside, where the nearest surface alone leads out.
        if (side.distance < 0.0 || glm::dot(g.p - c.point, Vec3(g.mesh->face_normals[c.triangle])) < 0.0)
            continue;
        if (near.planes == planes.size()) {
            near.complete = std::min(near.complete, side.distance);
            break;
        }
        planes[near.planes++] = side;
    }
    return near;
}

Gathering gathering(const Solid& solid, const Vec3& point, double band) {
    Gathering g;
    g.mesh = &solid.mesh;
    g.corners = solid.corners.data();
    g.part = solid.part.data();
    g.p = point;
    g.band2 = band * band;
    return g;
}

}  // namespace

PointQueryResult query_point(const Solid& solid, const Vec3& point, double radius, double band,
                             std::span<SeparatingPlane> planes) {
    Gathering g = gathering(solid, point, band);
    const double within = std::max(radius, band);
    g.radius2 = g.asked2 = within * within;
    RTCPointQuery query = make_query(point, within);
    g.rounded = glm::vec3(point);
    g.asked_in_float = query.radius < 1e18F ? query.radius * query.radius : FLT_MAX;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(solid.scene.get(), &query, &context, gather, &g);

    if (!(g.nearest.squared <= g.radius2)) {
        PointQueryResult near;
        near.complete = band;
        return near;
    }
    return conclude(g, nearest_plane(g), band, planes);
}

namespace {

using Four [[gnu::vector_size(16)]] = float;

Four four(const float* from) {
    Four v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

// The squares of the distances to boxes as a place has them; which is the least.
std::size_t beside_boxes(const float* boxes, std::size_t count, const glm::vec3& p, float* squared) {
    Four least = Four{} + FLT_MAX;
    for (std::size_t i = 0; i < count; i += 4) {
        Four sum{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Four at = Four{} + p[static_cast<int>(k)];
            const Four below = four(boxes + k * count + i) - at;
            const Four above = at - four(boxes + (k + 3) * count + i);
            const Four beside = below > above ? below : above;
            const Four clear = beside > 0.0F ? beside : Four{};
            sum += clear * clear;
        }
        std::memcpy(squared + i, &sum, sizeof sum);
        least = sum < least ? sum : least;
    }
    const float lowest = std::min({least[0], least[1], least[2], least[3]});
    std::size_t first = 0;
    while (squared[first] != lowest) ++first;
    return first;
}

bool rises(const std::array<glm::vec3, 3>& t, const Vec3& normal, double height) {
    return std::max({glm::dot(Vec3(t[0]), normal), glm::dot(Vec3(t[1]), normal),
                     glm::dot(Vec3(t[2]), normal)}) > height;
}

}  // namespace

std::optional<PointQueryResult> query_listed(const Solid& solid, const TriangleOctree& octree,
                                             const OctreeQuery& seen, const Vec3& point, double band,
                                             std::span<SeparatingPlane> planes) {
    const OctreeLeaf& leaf = *seen.leaf;
    Gathering g = gathering(solid, point, band);
    const glm::vec3 rounded(point);
    constexpr std::size_t room = max_listed;
    const std::span<const std::uint32_t> listed(&octree.triangles[leaf.begin], leaf.end - leaf.begin);
    std::array<float, room> beside;
    const std::size_t first =
        beside_boxes(&octree.boxes[leaf.boxes], (listed.size() + 3) / 4 * 4, rounded, beside.data());
    const auto compare = [&](std::size_t i) {
        const auto& t = g.corners[listed[i]];
        const auto [at, region] = closest_on_triangle(point, {Vec3(t[0]), Vec3(t[1]), Vec3(t[2])});
        const Vec3 between = point - at;
        g.add({glm::dot(between, between), listed[i], region, at});
        beside[i] = FLT_MAX;
    };
    const auto in_float = [&](double squared) {
        const float margin = with_margin(std::sqrt(squared), point);
        return margin * margin;
    };
    // Which are within can hardly be predicted: they are collected without asking.
    std::array<std::uint16_t, room> near;
    const auto collect = [&](float within) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < listed.size(); ++i) {
            near[count] = static_cast<std::uint16_t>(i);
            count += beside[i] <= within ? 1U : 0U;
        }
        return std::span(near).first(count);
    };
    compare(first);
    float within = in_float(g.nearest.squared);
    for (const std::uint16_t i : collect(within)) {
        if (beside[i] > within) continue;
        compare(i);
        within = in_float(g.nearest.squared);
    }
    if (!(g.nearest.squared <= seen.unlisted * seen.unlisted)) return std::nullopt;
    const SeparatingPlane first_side = nearest_plane(g);
    if (leaf.convex) {
        const bool told = first_side.distance <= band && !planes.empty();
        if (told) planes[0] = first_side;
        return PointQueryResult{first_side.distance, told ? 1U : 0U, band};
    }
    // Further sides are there only where something rises above the first.
    if (first_side.distance <= band) {
        const double height = glm::dot(first_side.point, first_side.normal) + plane_tolerance;
        for (const std::uint16_t i : collect(in_float(g.band2)))
            if (rises(g.corners[listed[i]], first_side.normal, height)) compare(i);
    }
    return conclude(g, first_side, band, planes);
}

}  // namespace bolt::collision
