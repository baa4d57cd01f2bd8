#include "tools/author/geometry/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <vector>

namespace bolt::geometry {

namespace {

glm::dmat4 local_matrix(const assets::Node& node) {
    return glm::translate(glm::dmat4(1.0), Vec3(node.translation)) * glm::mat4_cast(Quat(node.rotation)) *
           glm::scale(glm::dmat4(1.0), Vec3(node.scale));
}

bool is_finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Returns three indices for each triangle, for every topology.
std::vector<std::uint32_t> corners(const assets::Primitive& primitive) {
    std::vector<std::uint32_t> list = primitive.indices, result;
    if (list.empty())
        for (std::uint32_t i = 0; i < primitive.positions.size(); ++i) list.push_back(i);
    switch (primitive.topology) {
        case assets::Topology::triangles:
            list.resize(list.size() / 3 * 3);
            return list;
        case assets::Topology::triangle_strip:
            for (std::size_t i = 2; i < list.size(); ++i) {
                const bool odd = i % 2 == 1;
                result.insert(result.end(), {list[odd ? i - 1 : i - 2], list[odd ? i - 2 : i - 1], list[i]});
            }
            return result;
        case assets::Topology::triangle_fan:
            for (std::size_t i = 2; i < list.size(); ++i)
                result.insert(result.end(), {list[0], list[i - 1], list[i]});
            return result;
        default:
            return {};
    }
}

void add_mesh(ModelPart& part, const assets::Mesh& mesh, const glm::dmat4& world, std::uint32_t index) {
    for (const assets::Primitive& primitive : mesh.primitives) {
        std::vector<Vec3> points;
        points.reserve(primitive.positions.size());
        for (const glm::vec3& p : primitive.positions) points.emplace_back(world * glm::dvec4(Vec3(p), 1.0));
        const std::vector<std::uint32_t> list = corners(primitive);
        for (std::size_t i = 0; i + 2 < list.size(); i += 3) {
            if (list[i] >= points.size() || list[i + 1] >= points.size() || list[i + 2] >= points.size())
                continue;
            const Triangle t{points[list[i]], points[list[i + 1]], points[list[i + 2]], index};
            if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c)) continue;
            for (const Vec3& p : {t.a, t.b, t.c}) part.box.add(p);
            part.triangles.push_back(t);
        }
    }
}

}  // namespace

bool FlattenedModel::is_under(int node, int ancestor) const {
    while (node >= 0 && node != ancestor) node = nodes[static_cast<std::size_t>(node)].parent;
    return node >= 0;
}

std::size_t FlattenedModel::triangle_count() const {
    std::size_t count = 0;
    for (const ModelPart& part : parts) count += part.triangles.size();
    return count;
}

std::vector<std::string> FlattenedModel::names() const {
    std::vector<std::string> result;
    for (const auto& [name, found] : by_name) result.push_back(name);
    return result;
}

FlattenedModel flatten(const assets::Model& model) {
    FlattenedModel scene;
    struct PendingNode {
        int node, parent;
    };
    std::vector<PendingNode> stack;
    for (auto root = model.roots.rbegin(); root != model.roots.rend(); ++root) stack.push_back({*root, -1});
    // Each node is visited once, even if the file has a loop.
    std::vector<bool> seen(model.nodes.size(), false);
    while (!stack.empty()) {
        const PendingNode pending = stack.back();
        stack.pop_back();
        const auto index = static_cast<std::size_t>(pending.node);
        if (pending.node < 0 || index >= model.nodes.size() || seen[index]) continue;
        seen[index] = true;
        const assets::Node& node = model.nodes[index];
        const auto above = static_cast<std::size_t>(pending.parent);
        const int own = static_cast<int>(scene.nodes.size());
        const glm::dmat4 parent = pending.parent >= 0 ? scene.nodes[above].world : glm::dmat4(1.0);
        scene.nodes.push_back({node.name, pending.parent, parent * local_matrix(node)});
        if (!node.name.empty()) scene.by_name[node.name].push_back(own);
        if (node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model.meshes.size()) {
            ModelPart part;
            part.node = own;
            for (int at = own; at >= 0 && part.name.empty();
                 at = scene.nodes[static_cast<std::size_t>(at)].parent)
                part.name = scene.nodes[static_cast<std::size_t>(at)].name;
            add_mesh(part, model.meshes[static_cast<std::size_t>(node.mesh)],
                     scene.nodes[static_cast<std::size_t>(own)].world,
                     static_cast<std::uint32_t>(scene.parts.size()));
            scene.parts.push_back(std::move(part));
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            stack.push_back({*child, own});
    }
    return scene;
}

namespace {

Vec3 transform_to(const glm::dmat4& m, const Vec3& p) { return Vec3(m * glm::dvec4(p, 1.0)); }

Fastener find_fastener(const FlattenedModel& scene, int joint_node, std::string name,
                       const glm::dmat4& to_joint) {
    Fastener fastener;
    fastener.name = std::move(name);
    const auto found = scene.by_name.find(fastener.name);
    if (found == scene.by_name.end()) return fastener;
    for (const int node : found->second) {
        if (!scene.is_under(node, joint_node)) continue;
        for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
            if (!scene.is_under(scene.parts[i].node, node)) continue;
            fastener.parts.insert(i);
            for (const Triangle& t : scene.parts[i].triangles) {
                fastener.triangles.push_back({transform_to(to_joint, t.a), transform_to(to_joint, t.b),
                                              transform_to(to_joint, t.c), i});
                const Triangle& own = fastener.triangles.back();
                for (const Vec3& p : {own.a, own.b, own.c}) fastener.box.add(p);
            }
        }
    }
    return fastener;
}

// The head of a bolt: the triangles above its bearing face, at the height `face` (m), and the fillet there,
// and those that reach further out than shank and fillet.
Fastener head_of(const Fastener& bolt, double diameter, double face) {
    const double shank = 0.62 * diameter, fillet = 0.12 * diameter;
    const auto is_wide = [&](const Vec3& p) { return std::hypot(p.x, p.z) > shank; };
    Fastener head{bolt.name, {}, {}, bolt.parts};
    for (const Triangle& t : bolt.triangles) {
        const bool above = std::min({t.a.y, t.b.y, t.c.y}) > face + fillet;
        if (!above && !is_wide(t.a) && !is_wide(t.b) && !is_wide(t.c)) continue;
        head.triangles.push_back(t);
        for (const Vec3& p : {t.a, t.b, t.c}) head.box.add(p);
    }
    return head;
}

}  // namespace

bool JointParts::owns(std::uint32_t part) const {
    return bolt.parts.contains(part) || washer_head.parts.contains(part) || washer_nut.parts.contains(part) ||
           nut.parts.contains(part);
}

Aabb transform_to(const glm::dmat4& m, const Aabb& box) {
    const Vec3 middle = transform_to(m, box.middle()), half = box.half();
    const Vec3 reach =
        glm::abs(Vec3(m[0])) * half.x + glm::abs(Vec3(m[1])) * half.y + glm::abs(Vec3(m[2])) * half.z;
    return {middle - reach, middle + reach};
}

namespace {

bool is_screw(const FlattenedModel& scene, int joint_node, const joint::JointDesign& design) {
    return design.turned == joint::TurnedPart::head &&
           std::any_of(scene.parts.begin(), scene.parts.end(),
                       [&](const ModelPart& part) { return part.node == joint_node; });
}

}  // namespace

glm::dmat4 joint_frame(const FlattenedModel& scene, int joint_node, const joint::JointDesign& design) {
    const glm::dmat4& world = scene.nodes[static_cast<std::size_t>(joint_node)].world;
    if (!is_screw(scene, joint_node, design) || glm::dot(Vec3(world[1]), design.axis) >= 0.0) return world;
    return world * glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, -1, 0),
                              glm::dvec4(0, 0, 0, 1));
}

JointParts find_joint_parts(const FlattenedModel& scene, int joint_node, const joint::JointDesign& design) {
    JointParts parts;
    parts.to_assembly = joint_frame(scene, joint_node, design);
    parts.to_joint = glm::inverse(parts.to_assembly);
    const auto find = [&](const char* what) {
        return find_fastener(scene, joint_node, design.id + what, parts.to_joint);
    };
    parts.bolt = is_screw(scene, joint_node, design)
                     ? find_fastener(scene, joint_node,
                                     scene.nodes[static_cast<std::size_t>(joint_node)].name, parts.to_joint)
                     : find("_bolt");
    parts.washer_head = find("_washer_head");
    parts.washer_nut = find("_washer_nut");
    parts.nut = find("_nut");
    const bool head = design.turned == joint::TurnedPart::head;
    parts.turned_washer = head ? parts.washer_head : parts.washer_nut;
    const double face = parts.turned_washer.exists() ? parts.turned_washer.box.high.y : 0.0;
    parts.turned = head ? head_of(parts.bolt, design.thread.size.d, face) : parts.nut;
    return parts;
}

namespace {

struct HexagonFlat {
    double angle, distance, area;  // of the outward normal about Y, rad; from the axis, m; m²
};

// Returns the triangles parallel to the axis at the distance of a flat, which excludes the bore, the chamfers
// and a collar. `corner`: largest radius of the part, m.
std::vector<HexagonFlat> find_hexagon_flats(std::span<const Triangle> triangles, double corner) {
    std::vector<HexagonFlat> flats;
    for (const Triangle& t : triangles) {
        Vec3 n = normal_of(t);
        const double twice = std::sqrt(glm::dot(n, n));
        if (twice <= 0.0) continue;
        n /= twice;
        if (std::abs(n.y) > 0.02) continue;
        const double distance = glm::dot(n, t.a);
        if (std::abs(distance) < 0.8 * corner || std::abs(distance) > 0.95 * corner) continue;
        // The sign makes the result independent of the winding.
        const double side = distance < 0.0 ? -1.0 : 1.0;
        flats.push_back({std::atan2(side * n.z, side * n.x), std::abs(distance), 0.5 * twice});
    }
    return flats;
}

}  // namespace

std::optional<MeasuredHexagon> measure_hexagon(std::span<const Triangle> triangles) {
    MeasuredHexagon hexagon;
    double corner = 0.0;
    for (const Triangle& t : triangles)
        for (const Vec3& p : {t.a, t.b, t.c}) corner = std::max(corner, std::hypot(p.x, p.z));
    const std::vector<HexagonFlat> flats = find_hexagon_flats(triangles, corner);
    // Six directions 60° apart coincide when their angles are multiplied by six.
    std::complex<double> sum;
    for (const HexagonFlat& flat : flats) sum += std::polar(flat.area, 6.0 * flat.angle);
    if (flats.empty()) return std::nullopt;
    const double phase = std::arg(sum) / 6.0;
    constexpr double window = to_radians(2.0);
    std::array<double, 6> support{};
    for (std::size_t k = 0; k < 6; ++k)
        for (const HexagonFlat& flat : flats)
            if (std::abs(wrap(flat.angle - phase - static_cast<double>(k) * pi / 3.0, 2.0 * pi)) < window)
                support[k] = std::max(support[k], flat.distance);
    if (*std::min_element(support.begin(), support.end()) <= 0.0) return std::nullopt;
    const std::array<double, 3> widths = {support[0] + support[3], support[1] + support[4],
                                          support[2] + support[5]};
    const auto [least, most] = std::minmax_element(widths.begin(), widths.end());
    hexagon.across_flats = (widths[0] + widths[1] + widths[2]) / 3.0;
    hexagon.unevenness = *most - *least;
    hexagon.flat_angle = phase;
    for (std::size_t k = 0; k < 6; ++k) {
        const double angle = phase + static_cast<double>(k) * pi / 3.0;
        hexagon.centre += support[k] / 3.0 * Vec3{std::cos(angle), 0.0, std::sin(angle)};
    }
    return hexagon;
}

}  // namespace bolt::geometry
