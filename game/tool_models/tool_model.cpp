#include "game/tool_models/tool_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "engine/assets/gltf.hpp"
#include "engine/base/hash.hpp"
#include "game/tool_models/parts.hpp"

namespace bolt::tool_models {

namespace {

constexpr double smooth_angle = to_radians(38.0);  // facets that meet at a smaller angle are one round face

// Coordinates and normals are multiples of a power of two, so that the last bits of a mathematical library
// change no byte.
constexpr double grid = 1.0 / (1 << 24);  // m
constexpr double normal_grid = 1.0 / (1 << 15);

glm::vec3 snapped(const Vec3& v, double step) { return glm::vec3(glm::round(v / step) * step); }

assets::Material metal(std::string name, const glm::vec3& color, float metallic, float roughness,
                       float clearcoat = 0.0F, float clearcoat_roughness = 0.0F) {
    assets::Material material;
    material.name = std::move(name);
    material.base_color = glm::vec4(color, 1.0F);
    material.metallic = metallic;
    material.roughness = roughness;
    material.clearcoat = clearcoat;
    material.clearcoat_roughness = clearcoat_roughness;
    return material;
}

// The values of content/materials.json; a test compares them.
assets::Material material_of(Finish finish) {
    switch (finish) {
        case Finish::black_oxide:
            return metal("black_oxide", {0.024157632F, 0.024157632F, 0.026241222F}, 0.7F, 0.42F, 0.15F, 0.4F);
        case Finish::rubber:
            return metal("rubber", glm::vec3(0.010329823F), 0.0F, 0.78F);
        case Finish::signal_red:
            return metal("signal_red", {0.43415365F, 0.0129830325F, 0.02121901F}, 0.0F, 0.45F, 0.3F, 0.3F);
        case Finish::screen:
            return metal("screen", {0.01F, 0.02F, 0.02F}, 0.0F, 0.08F, 1.0F, 0.02F);
        case Finish::light: {
            assets::Material light = metal("light", {0.05F, 0.4F, 0.12F}, 0.0F, 0.4F);
            light.emissive = {0.1F, 0.9F, 0.3F};
            return light;
        }
        case Finish::alarm: {
            assets::Material alarm = metal("alarm", {0.4F, 0.03F, 0.02F}, 0.0F, 0.4F);
            alarm.emissive = {1.0F, 0.06F, 0.03F};
            return alarm;
        }
        default:
            return metal("chrome_vanadium", {0.48514995F, 0.5028865F, 0.5394795F}, 1.0F, 0.22F, 0.2F, 0.15F);
    }
}

// Appends a shell with normals that are smooth across blunt edges. Vertices with different normals at one
// point are separate.
void append_smooth(const Shell& shell, assets::Primitive& out) {
    struct Corner {
        std::size_t triangle;
        double angle;
    };
    std::vector<Vec3> normals;
    std::vector<std::vector<Corner>> around(shell.points.size());
    for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
        const auto& triangle = shell.triangles[t];
        const auto at = [&](std::size_t i) { return shell.points[triangle[i % 3]]; };
        const Vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        const double length = glm::length(normal);
        normals.push_back(length > 1e-12 ? normal / length : Vec3(0.0));
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 a = at(i + 1) - at(i), b = at(i + 2) - at(i);
            around[triangle[i]].push_back({t, std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b))});
        }
    }
    const double blunt = std::cos(smooth_angle);
    std::vector<std::vector<std::uint32_t>> made(shell.points.size());
    for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
        if (normals[t] == Vec3(0.0)) continue;
        for (const std::uint32_t point : shell.triangles[t]) {
            Vec3 sum(0.0);
            for (const Corner& corner : around[point])
                if (glm::dot(normals[corner.triangle], normals[t]) > blunt)
                    sum += corner.angle * normals[corner.triangle];
            const glm::vec3 normal = snapped(glm::normalize(sum), normal_grid);
            auto& vertices = made[point];
            const auto same = std::find_if(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
                return glm::dot(out.normals[v] - normal, out.normals[v] - normal) < 1e-6F;
            });
            if (same != vertices.end()) {
                out.indices.push_back(*same);
                continue;
            }
            vertices.push_back(static_cast<std::uint32_t>(out.positions.size()));
            out.indices.push_back(vertices.back());
            out.positions.push_back(snapped(shell.points[point] * mm, grid));
            out.normals.push_back(normal);
        }
    }
}

assets::Primitive bare(const Shell& shell) {
    assets::Primitive primitive;
    for (const Vec3& p : shell.points) primitive.positions.push_back(snapped(p * mm, grid));
    for (const auto& triangle : shell.triangles)
        primitive.indices.insert(primitive.indices.end(), triangle.begin(), triangle.end());
    return primitive;
}

// An empty model with one root node.
assets::Model rooted_model(const ToolParameters& p) {
    assets::Model model;
    model.generator = "Boltwright";
    model.nodes.emplace_back();
    model.nodes.front().name = fmt::format("{}_{}", info_of(p.kind).name, size_text(p.size / mm));
    model.roots = {0};
    return model;
}

void add_node(assets::Model& model, const std::string& name, assets::Primitive primitive) {
    assets::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model.meshes.size());
    assets::Mesh mesh;
    mesh.name = name;
    mesh.primitives.push_back(std::move(primitive));
    model.nodes.front().children.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(node));
    model.meshes.push_back(std::move(mesh));
}

}  // namespace

ToolModelParts parts_of(const ToolParameters& p, Detail detail) {
    switch (p.kind) {
        case ModelKind::open_end_wrench:
            return open_end_parts(p, detail);
        case ModelKind::ring_wrench:
            return ring_parts(p, detail);
        case ModelKind::combination_wrench:
            return combination_parts(p, detail);
        case ModelKind::hex_key:
            return hex_key_parts(p, detail);
        case ModelKind::ratchet:
            return ratchet_parts(p, detail);
        case ModelKind::extension_bar:
            return extension_bar_parts(p, detail);
        case ModelKind::adaptor:
            return adaptor_parts(p, detail);
        case ModelKind::hex_bit:
            return hex_bit_parts(p, detail);
        case ModelKind::click_torque_wrench:
        case ModelKind::electronic_torque_wrench:
            break;
    }
    return torque_wrench_parts(p, detail);
}

assets::Model drawn_model(const ToolParameters& completed) {
    assets::Model model = rooted_model(completed);
    std::vector<Finish> used;
    for (const ToolModelPart& part : parts_of(completed, Detail::drawn)) {
        assets::Primitive primitive;
        for (const Shell& shell : part.shells) append_smooth(shell, primitive);
        const auto found = std::find(used.begin(), used.end(), part.finish);
        primitive.material = static_cast<int>(found - used.begin());
        if (found == used.end()) {
            used.push_back(part.finish);
            model.materials.push_back(material_of(part.finish));
        }
        add_node(model, part.name, std::move(primitive));
    }
    return model;
}

assets::Model contact_model(const ToolParameters& completed) {
    assets::Model model = rooted_model(completed);
    for (const ToolModelPart& part : parts_of(completed, Detail::contact))
        for (std::size_t i = 0; i < part.shells.size(); ++i)
            add_node(model, i == 0 ? part.name : fmt::format("{}_{}", part.name, i + 1),
                     bare(part.shells[i]));
    return model;
}

namespace {

constexpr double beyond_grip = 50.0 * mm;  // half the width of a hand

std::optional<ModelKind> torque_wrench_model(content::ToolKind kind) {
    if (kind == content::ToolKind::click_torque_wrench) return ModelKind::click_torque_wrench;
    if (kind == content::ToolKind::electronic_torque_wrench) return ModelKind::electronic_torque_wrench;
    return std::nullopt;
}

ToolParameters open_end_parameters(const content::WrenchDesign& design) {
    constexpr double click_beyond_grip = 73.5 * mm, click_parts = 330.0 * mm;  // as in torque_wrenches.cpp
    ToolParameters p;
    p.kind = torque_wrench_model(design.kind).value_or(ModelKind::open_end_wrench);
    p.opening = design.jaw;
    // The nominal size: the greatest whole millimetre if it is at most 0.61 mm below the jaw's width, else
    // the greatest half millimetre that leaves play.
    p.size = std::floor(2.0 * (design.jaw / mm - 0.05)) / 2.0 * mm;
    if (std::floor(design.jaw / mm + 1e-6) >= design.jaw / mm - 0.61)
        p.size = std::floor(design.jaw / mm + 1e-6) * mm;
    p.head_angle = design.head_angle;
    p.head_thickness = design.head_thickness;
    p.jaw_depth = design.jaw_depth;
    p.jaw_tip = design.jaw_tip;
    p.adaptor_length = design.adaptor_length;
    const OpenEndHead head = open_end_head(p);
    const double reach = (head.middle + head.radius) * mm;
    if (p.kind == ModelKind::open_end_wrench) {
        p.length = std::max(design.handle_length + beyond_grip, 1.6 * reach + 30.0 * mm);
        return p;
    }
    const double insert = std::max(62.0 * mm, reach + 12.0 * mm) + design.adaptor_length;
    const double whole = design.handle_length + click_beyond_grip, share = click_beyond_grip / click_parts;
    p.length =
        whole - insert >= click_parts ? whole : (design.handle_length - share * insert) / (1.0 - share);
    p.length = std::max(p.length, insert + 60.0 * mm);
    return p;
}

double adjusted_length(const ToolParameters& p, double handle_length) {
    return std::clamp(handle_length + (is_torque_wrench(p.kind) ? 73.5 * mm : beyond_grip),
                      shortest_length(p), longest_tool);
}

}  // namespace

ToolParameters parameters_of(const content::WrenchDesign& design) {
    if (design.head == content::ToolHeadKind::open_end) return open_end_parameters(design);
    ToolParameters p;
    p.size = design.size;
    p.teeth = design.teeth;
    p.extension = design.extension;
    if (design.head == content::ToolHeadKind::hex_bit) p.head = ModelHead::hex_bit;
    switch (design.kind) {
        case content::ToolKind::ring_wrench:
            p.kind = ModelKind::ring_wrench;
            break;
        case content::ToolKind::hex_key:
            p.kind = ModelKind::hex_key;
            break;
        case content::ToolKind::ratchet:
            p.kind = ModelKind::ratchet;
            break;
        default:
            p.kind = torque_wrench_model(design.kind).value_or(ModelKind::click_torque_wrench);
            if (p.head == ModelHead::standard) p.head = ModelHead::socket;
            break;
    }
    const auto sizes = standard_sizes(measure_of(p));
    p.size = std::clamp(p.size, sizes.front() * mm, sizes.back() * mm);
    p.length = longest_tool;
    p = completed(p).value_or(p);
    p.length = adjusted_length(p, design.handle_length);
    return p;
}

Result<GrippingHead> gripping_head(const ToolParameters& p) {
    using namespace collision;
    const double tooth = p.teeth > 0 ? 2.0 * pi / p.teeth : 0.0;
    GrippingHead gripping;
    if (p.extension > 0.0) {
        // A round bar with 1.2 times the width of its drive: G π r⁴ / (2 L). G of steel 79.3 GPa.
        const double r = 0.6 * p.drive;
        gripping.twist_stiffness = 79.3e9 * 0.5 * pi * square(square(r)) / p.extension;
    }
    if (p.kind == ModelKind::ring_wrench) {
        const RingHead ring = ring_head(p);
        const double half = 0.5 * ring.thickness * mm, lead = 0.05 * p.opening;
        gripping.head = Ring{p.opening, 12, -half, half, lead, ring.outside * mm, false, 0.0};
        return gripping;
    }
    if (p.kind == ModelKind::hex_key || measure_of(p) == SizeMeasure::socket_screw) {
        const KeyGrip key = key_grip(p);
        gripping.head = HexKey{p.opening, key.tip * mm, key.chamfer * mm, key.length * mm, tooth};
        gripping.head_angle = pi / 6.0;
        return gripping;
    }
    if (has_ratchet(p)) {
        const SocketGrip socket = socket_grip(p);
        gripping.head = Ring{
            p.opening, 12,   socket.low * mm, socket.shoulder * mm, socket.lead * mm, socket.outside * mm,
            true,      tooth};
        return gripping;
    }
    if (!p.head_angle)
        return fail(ErrorCode::usage, fmt::format("{} turns nothing by itself", info_of(p.kind).name),
                    "a wrench, a key, or a socket on a ratchet");
    gripping.head_angle = *p.head_angle;
    gripping.head = make_jaw(p.opening, *p.head_angle, p.head_thickness, p.jaw_depth, p.jaw_tip);
    return gripping;
}

GrippingHead gripping_head(const content::WrenchDesign& design) {
    if (design.head != content::ToolHeadKind::open_end)
        return gripping_head(parameters_of(design)).value_or(GrippingHead{});
    // An author's model has its own dimensions, so those of the file count.
    return {collision::make_jaw(design.jaw, design.head_angle, design.head_thickness, design.jaw_depth,
                                design.jaw_tip),
            design.head_angle, 0.0};
}

ToolStrength strength_of(const ToolParameters& tool) {
    const ModelKind gripping = has_ratchet(tool)
                                   ? tool.head == ModelHead::hex_bit ? ModelKind::hex_bit : ModelKind::ratchet
                               : is_torque_wrench(tool.kind) ? ModelKind::open_end_wrench
                                                             : tool.kind;
    ToolStrength strength{test_torque(gripping, tool.size), false, 0.0};
    if (!has_ratchet(tool)) return strength;
    const ToolParameters whole = completed(tool).value_or(tool);
    const TestTorque drive = test_torque(ModelKind::extension_bar, whole.drive);
    const bool is_weaker =
        strength.limit.source == TorqueSource::none || drive.torque < strength.limit.torque;
    if (drive.source != TorqueSource::none && is_weaker) strength = {drive, true, whole.drive};
    return strength;
}

ToolStrength strength_of(const content::WrenchDesign& design) { return strength_of(parameters_of(design)); }

double key_yield_torque(double across_flats, KeyStrength keys) {
    const double s = across_flats;
    return keys == KeyStrength::measured ? 0.857 * 0.2 * 1.47e9 * s * square(s)
                                         : 0.188 * s * square(s) * 750e6;
}

double yield_torque(const content::WrenchDesign& design, KeyStrength keys) {
    constexpr double surplus = 1.2;
    const ToolStrength strength = strength_of(design);
    double torque = strength.limit.source == TorqueSource::none ? 0.0 : surplus * strength.limit.torque;
    if (design.head == content::ToolHeadKind::hex_key || design.head == content::ToolHeadKind::hex_bit) {
        const double key = key_yield_torque(parameters_of(design).size, keys);
        torque = torque > 0.0 ? std::min(torque, key) : key;
    }
    return torque;
}

double bearable_torque(const content::WrenchDesign& design) {
    const TestTorque limit = strength_of(design).limit;
    const double yields = yield_torque(design);
    return limit.source == TorqueSource::none ? yields : std::min(limit.torque, yields);
}

Result<std::string> identity_of(const ToolParameters& completed) {
    BOLT_TRY_ASSIGN(const auto bytes, assets::encode_glb(contact_model(completed)));
    Fnv1a hash;
    hash.add(bytes);
    return fmt::format("generated {}, {} bytes, fnv1a {:016x}", description(completed), bytes.size(),
                       hash.value());
}

}  // namespace bolt::tool_models
