#include "haptics/collision/solid.hpp"

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
        return fail(ErrorCode::failed,
                    fmt::format("Embree cannot build a contact scene (error {})", static_cast<int>(error)),
                    "enough memory for the contact mesh");
    return scene;
}

Status build_scenes(Solid& solid) {
    const std::unique_ptr<RTCDeviceTy, DeviceRelease> device(rtcNewDevice("threads=1"));
    if (!device)
        return fail(ErrorCode::failed, "Embree cannot create a device", "a processor that Embree supports");
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
        return fail(ErrorCode::failed, "Embree has no memory for a contact mesh",
                    "free memory for its vertices and triangles");
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
    if (parts.size() > 0xffff)
        return fail(ErrorCode::bad_content, fmt::format("a solid has {} parts", parts.size()),
                    "at most 65535");
    for (std::size_t i = 0; i < parts.size(); ++i) {
        append(solid.mesh, parts[i]);
        solid.part.resize(solid.mesh.triangles.size(), static_cast<std::uint32_t>(i));
    }
    if (solid.mesh.triangles.empty())
        return fail(ErrorCode::bad_content, "a solid has no triangles", "at least one part with triangles");
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
        solid.origin_radius = std::max(solid.origin_radius, glm::length(Vec3(v)));
    }
    BOLT_TRY(build_scenes(solid));
    return solid;
}

bool occluded(const Solid& solid, const Vec3& from, const Vec3& to) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(from.x);
    ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(to.x - from.x);
    ray.dir_y = static_cast<float>(to.y - from.y);
    ray.dir_z = static_cast<float>(to.z - from.z);
    ray.tfar = 1.0F;
    ray.mask = 0xffffffffU;
    return embree::occluded(solid.scene.get(), ray);
}

namespace {

struct Candidate {
    double squared;
    std::uint32_t triangle;
    Region region;
    Vec3 point;
};

bool nearer_candidate(const Candidate& a, const Candidate& b) {
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

// Candidates of one point query. The kept set does not depend on the order of arrival: it holds the nearest
// candidates, ordered by distance and triangle.
struct PointGathering {
    static constexpr std::size_t capacity = 64;
    const ContactMesh* mesh;
    const std::array<glm::vec3, 3>* corners;
    const std::uint32_t* part;
    Vec3 p;
    double band2, radius2;
    double query_radius2;  // square of the current search radius
    glm::vec3 point_float;
    float query_radius2_float;  // square of Embree's search radius
    static constexpr double limit = std::numeric_limits<double>::infinity();
    Candidate nearest{limit, 0xffffffffU, 6, {}};
    // Among coincident surfaces of several parts, the nearest with the point on its inner side.
    Candidate inside = nearest;
    std::array<Candidate, capacity> kept;
    std::size_t count = 0;
    std::size_t furthest = 0;  // index in `kept`; valid when it is full

    [[nodiscard]] double limit2() const { return count < capacity ? band2 : kept[furthest].squared; }

    void consider_inside(const Candidate& c) {
        if (nearer_candidate(c, inside) && is_behind_surface(*mesh, p, c)) inside = c;
    }
    void find_furthest() {
        furthest = 0;
        for (std::size_t i = 1; i < count; ++i)
            if (nearer_candidate(kept[furthest], kept[i])) furthest = i;
    }
    void add(const Candidate& found) {
        if (nearest.squared < limit && part[found.triangle] != part[nearest.triangle] &&
            std::sqrt(found.squared) <= std::sqrt(nearest.squared) + coincidence_tolerance) {
            consider_inside(found);
            consider_inside(nearest);
        }
        if (nearer_candidate(found, nearest)) nearest = found;
        if (found.squared > band2) return;
        if (count < capacity) {
            kept[count++] = found;
            if (count == capacity) find_furthest();
            return;
        }
        if (!nearer_candidate(found, kept[furthest])) return;
        kept[furthest] = found;
        find_furthest();
    }
};

// Square of the distance to the triangle's bounding box.
float squared_box_distance(const std::array<glm::vec3, 3>& t, const glm::vec3& p) {
    const glm::vec3 low = glm::min(glm::min(t[0], t[1]), t[2]);
    const glm::vec3 high = glm::max(glm::max(t[0], t[1]), t[2]);
    const glm::vec3 gap = glm::max(glm::max(low - p, p - high), glm::vec3(0.0F));
    return glm::dot(gap, gap);
}

bool gather_triangle(RTCPointQueryFunctionArguments* arguments) {
    auto& g = *static_cast<PointGathering*>(arguments->userPtr);
    const auto& t = g.corners[arguments->primID];
    // Embree calls this for all triangles of a leaf; the box test rejects most of them.
    if (squared_box_distance(t, g.point_float) > g.query_radius2_float) return false;
    const auto [point, region] = closest_on_triangle(g.p, {Vec3(t[0]), Vec3(t[1]), Vec3(t[2])});
    const Vec3 between = g.p - point;
    g.add({glm::dot(between, between), arguments->primID, region, point});
    const double needed2 = std::max(g.limit2(), std::min(g.nearest.squared, g.radius2));
    if (!(needed2 < g.query_radius2)) return false;
    g.query_radius2 = needed2;
    const float radius = std::min(arguments->query->radius, with_margin(std::sqrt(needed2), g.p));
    arguments->query->radius = radius;
    g.query_radius2_float = radius * radius;
    return true;
}

SeparatingPlane make_plane(const ContactMesh& mesh, const Vec3& p, const Candidate& c) {
    const Vec3 pseudo = pseudonormal(mesh, c);
    const Vec3 between = p - c.point;
    SeparatingPlane plane{std::sqrt(c.squared), c.point, {}, c.triangle};
    const bool inside = glm::dot(between, pseudo) < 0.0;
    // On the surface itself and over the interior of a face, the direction is the surface's normal.
    plane.normal = c.region < 6 && plane.distance > 1e-9
                       ? between / (inside ? -plane.distance : plane.distance)
                       : glm::normalize(pseudo);
    if (inside) plane.distance = -plane.distance;
    return plane;
}

// The plane of the nearest surface. Where two parts touch, their surfaces coincide: a point is then inside
// one part and, at the same distance, outside the other. The part that contains the point takes precedence.
SeparatingPlane nearest_plane(const PointGathering& g) {
    const bool inside = g.inside.squared < PointGathering::limit &&
                        std::sqrt(g.inside.squared) <= std::sqrt(g.nearest.squared) + coincidence_tolerance;
    return make_plane(*g.mesh, g.p, inside ? g.inside : g.nearest);
}

// Returns true if the part of the triangle within the band lies behind the plane, up to plane_tolerance.
bool is_behind_plane(const ContactMesh& mesh, const Candidate& c, const SeparatingPlane& plane,
                     double band2) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : corners(mesh, c.triangle))
        highest = std::max(highest, glm::dot(v - plane.point, plane.normal));
    if (highest <= plane_tolerance) return true;
    const Vec3 face(mesh.face_normals[c.triangle]);
    const double along = glm::dot(face, plane.normal);
    const double slope = std::sqrt(std::max(0.0, 1.0 - along * along));
    const double height = glm::dot(c.point - plane.point, plane.normal);
    // Upper bound of the distance, within the triangle's plane, from the closest point to any point within
    // the band.
    const double span = std::sqrt(std::max(0.0, band2 - c.squared)) + std::sqrt(c.squared);
    return height + slope * span <= plane_tolerance;
}

// Selects the separating planes among the candidates; `first` is the nearest.
PointQueryResult select_planes(PointGathering& g, const SeparatingPlane& first, double band,
                               std::span<SeparatingPlane> planes) {
    PointQueryResult result;
    result.complete_within = band;
    // When `kept` is full the search radius shrinks, so completeness beyond its furthest entry is unknown.
    if (g.count == PointGathering::capacity) result.complete_within = std::sqrt(g.kept[g.furthest].squared);
    std::sort(g.kept.begin(), g.kept.begin() + static_cast<std::ptrdiff_t>(g.count), nearer_candidate);
    result.distance = first.distance;
    if (first.distance > band) return result;
    if (planes.empty()) {
        result.complete_within = std::min(result.complete_within, first.distance);
        return result;
    }
    planes[result.planes++] = first;
    for (std::size_t i = 0; i < g.count; ++i) {
        const Candidate& c = g.kept[i];
        if (c.triangle == first.triangle) continue;
        const auto written = planes.first(result.planes);
        if (std::any_of(written.begin(), written.end(), [&](const SeparatingPlane& plane) {
                return is_behind_plane(*g.mesh, c, plane, g.band2);
            }))
            continue;
        const SeparatingPlane plane = make_plane(*g.mesh, g.p, c);
        // A face seen from behind: the point is inside, and only the nearest surface leads out.
        if (plane.distance < 0.0 || glm::dot(g.p - c.point, Vec3(g.mesh->face_normals[c.triangle])) < 0.0)
            continue;
        if (result.planes == planes.size()) {
            result.complete_within = std::min(result.complete_within, plane.distance);
            break;
        }
        planes[result.planes++] = plane;
    }
    return result;
}

PointGathering make_gathering(const Solid& solid, const Vec3& point, double band) {
    PointGathering g;
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
    PointGathering g = make_gathering(solid, point, band);
    const double within = std::max(radius, band);
    g.radius2 = g.query_radius2 = within * within;
    RTCPointQuery query = make_query(point, within);
    g.point_float = glm::vec3(point);
    g.query_radius2_float = query.radius < 1e18F ? query.radius * query.radius : FLT_MAX;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(solid.scene.get(), &query, &context, gather_triangle, &g);

    if (!(g.nearest.squared <= g.radius2)) {
        PointQueryResult result;
        result.complete_within = band;
        return result;
    }
    return select_planes(g, nearest_plane(g), band, planes);
}

namespace {

using Float4 [[gnu::vector_size(16)]] = float;

Float4 load4(const float* from) {
    Float4 v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

// Writes the squared distances to the boxes of an OctreeLeaf. Returns the index of the least.
std::size_t squared_box_distances(const float* boxes, std::size_t count, const glm::vec3& p, float* squared) {
    Float4 least = Float4{} + FLT_MAX;
    for (std::size_t i = 0; i < count; i += 4) {
        Float4 sum{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Float4 at = Float4{} + p[static_cast<int>(k)];
            const Float4 below = load4(boxes + k * count + i) - at;
            const Float4 above = at - load4(boxes + (k + 3) * count + i);
            const Float4 gap = below > above ? below : above;
            const Float4 clear = gap > 0.0F ? gap : Float4{};
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

bool rises_above(const std::array<glm::vec3, 3>& t, const Vec3& normal, double height) {
    return std::max({glm::dot(Vec3(t[0]), normal), glm::dot(Vec3(t[1]), normal),
                     glm::dot(Vec3(t[2]), normal)}) > height;
}

}  // namespace

std::optional<PointQueryResult> query_listed(const Solid& solid, const TriangleOctree& octree,
                                             const OctreeQuery& found, const Vec3& point, double band,
                                             std::span<SeparatingPlane> planes) {
    const OctreeLeaf& leaf = *found.leaf;
    PointGathering g = make_gathering(solid, point, band);
    const glm::vec3 point_float(point);
    constexpr std::size_t capacity = max_listed;
    const std::span<const std::uint32_t> listed(&octree.triangles[leaf.begin], leaf.end - leaf.begin);
    std::array<float, capacity> gap;
    const std::size_t first = squared_box_distances(&octree.boxes[leaf.boxes], (listed.size() + 3) / 4 * 4,
                                                    point_float, gap.data());
    const auto compare = [&](std::size_t i) {
        const auto& t = g.corners[listed[i]];
        const auto [at, region] = closest_on_triangle(point, {Vec3(t[0]), Vec3(t[1]), Vec3(t[2])});
        const Vec3 between = point - at;
        g.add({glm::dot(between, between), listed[i], region, at});
        gap[i] = FLT_MAX;
    };
    const auto in_float = [&](double squared) {
        const float margin = with_margin(std::sqrt(squared), point);
        return margin * margin;
    };
    // Branch-free, because the outcome of the comparison is unpredictable.
    std::array<std::uint16_t, capacity> in_radius;
    const auto collect = [&](float within) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < listed.size(); ++i) {
            in_radius[count] = static_cast<std::uint16_t>(i);
            count += gap[i] <= within ? 1U : 0U;
        }
        return std::span(in_radius).first(count);
    };
    compare(first);
    float within = in_float(g.nearest.squared);
    for (const std::uint16_t i : collect(within)) {
        if (gap[i] > within) continue;
        compare(i);
        within = in_float(g.nearest.squared);
    }
    if (!(g.nearest.squared <= found.unlisted_distance * found.unlisted_distance)) return std::nullopt;
    const SeparatingPlane first_plane = nearest_plane(g);
    if (leaf.convex) {
        const bool writes_plane = first_plane.distance <= band && !planes.empty();
        if (writes_plane) planes[0] = first_plane;
        return PointQueryResult{first_plane.distance, writes_plane ? 1U : 0U, band};
    }
    // Further planes exist only where something rises above the first.
    if (first_plane.distance <= band) {
        const double height = glm::dot(first_plane.point, first_plane.normal) + plane_tolerance;
        for (const std::uint16_t i : collect(in_float(g.band2)))
            if (rises_above(g.corners[listed[i]], first_plane.normal, height)) compare(i);
    }
    return select_planes(g, first_plane, band, planes);
}

}  // namespace bolt::collision
