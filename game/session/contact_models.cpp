#include "game/session/contact_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>

#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"
#include "engine/base/hash.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::session {

namespace {
// Distance of the corners of a hexagonal socket from the axis, in widths across flats: 1/√3 and up to 0.3 mm
// of play. Points at other distances belong to the drilled end of the socket or to its countersink.
constexpr double least_socket_corner = 0.56, most_socket_corner = 0.60;
constexpr double above_shank = 0.1e-3;  // m above the bearing face, beyond the shank and its fillet
}  // namespace

HexagonPose find_hexagon(const servo::NutGeometry& nut, std::span<const glm::dvec3> points) {
    std::complex<double> sixfold = 0.0;
    double low = nut.is_head ? 0.0 : 1e9;  // a head is drawn on its seat
    for (const Vec3& p : points) {
        const Vec3 d = p - nut.seat;
        const Vec3 q(glm::dot(d, nut.e1), glm::dot(d, nut.e2), glm::dot(d, nut.axis));
        if (!nut.is_head) low = std::min(low, q.z);
        const double out = std::hypot(q.x, q.y) / nut.across_flats;
        if (nut.socket_depth > 0.0 &&
            (q.z < above_shank || out < least_socket_corner || out > most_socket_corner))
            continue;
        sixfold += std::pow(out, 24.0) * std::polar(1.0, 6.0 * std::atan2(q.y, q.x));
    }
    return {glm::angleAxis(-std::arg(sixfold) / 6.0, Vec3(0, 0, 1)), low};
}

namespace {

struct MeshNode {
    std::string node;
    std::vector<glm::dvec3> points;  // three for each triangle, in the model's frame
};

Error content_error(const std::filesystem::path& file, std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.what = std::move(what);
    error.expected = std::move(expected);
    error.file = file.string();
    return error;
}

// `file`: for messages.
Result<std::vector<MeshNode>> mesh_nodes_of(const assets::Model& model, const std::filesystem::path& file) {
    std::vector<MeshNode> nodes;
    const std::function<Status(int, const glm::dmat4&)> visit = [&](int index,
                                                                    const glm::dmat4& above) -> Status {
        const assets::Node& node = model.nodes[static_cast<std::size_t>(index)];
        const glm::dmat4 world = above * glm::translate(glm::dmat4(1.0), Vec3(node.translation)) *
                                 glm::mat4_cast(Quat(node.rotation)) *
                                 glm::scale(glm::dmat4(1.0), Vec3(node.scale));
        if (node.mesh >= 0) {
            MeshNode mesh_node{node.name, {}};
            for (const assets::Primitive& p : model.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                if (p.topology != assets::Topology::triangles || p.indices.empty())
                    return fail(content_error(file,
                                              fmt::format("node \"{}\" has other primitives", node.name),
                                              "indexed triangles"));
                for (const std::uint32_t i : p.indices)
                    mesh_node.points.emplace_back(world * glm::dvec4(Vec3(p.positions[i]), 1.0));
            }
            nodes.push_back(std::move(mesh_node));
        }
        for (const int child : node.children) {
            BOLT_TRY(visit(child, world));
        }
        return {};
    };
    for (const int root : model.roots) {
        BOLT_TRY(visit(root, glm::dmat4(1.0)));
    }
    return nodes;
}

Result<std::vector<MeshNode>> read_mesh_nodes(const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(const auto model, assets::read_gltf(file));
    return mesh_nodes_of(model, file);
}

Result<collision::ContactMesh> mesh_of(const MeshNode& mesh_node, const std::filesystem::path& file,
                                       const std::function<Vec3(const Vec3&)>& move) {
    std::vector<glm::vec3> vertices;
    std::vector<std::uint32_t> indices;
    for (const Vec3& p : mesh_node.points) {
        indices.push_back(static_cast<std::uint32_t>(vertices.size()));
        vertices.emplace_back(move(p));
    }
    Result<collision::ContactMesh> mesh = collision::make_contact_mesh(vertices, indices);
    if (!mesh)
        return fail(content_error(file, fmt::format("node \"{}\": {}", mesh_node.node, mesh.error().what),
                                  mesh.error().expected));
    return mesh;
}

std::function<Vec3(const Vec3&)> to_nut(const servo::NutGeometry& nut, const MeshNode& mesh_node) {
    return [nut, hexagon = find_hexagon(nut, mesh_node.points)](const Vec3& p) {
        return to_nut_frame(nut, hexagon, p);
    };
}

// Smallest distance to the wrench along the line from the jaw's centre out of its mouth, m.
double mouth_clearance(const collision::Solid& wrench, double head_angle, double jaw) {
    double least = jaw;
    for (int i = 0; i <= 20; ++i) {
        const double r = jaw * static_cast<double>(i) / 20.0;
        const Vec3 p(-r * std::cos(head_angle), -r * std::sin(head_angle), 0.0);
        collision::SeparatingPlane side;
        least = std::min(least, collision::query_point(wrench, p, jaw, 0.0, {&side, 1}).distance);
    }
    return least;
}

std::filesystem::path wrench_file(const content::WrenchDesign& design) {
    std::filesystem::path own = design.model;
    own.replace_extension(".contact.glb");
    return std::filesystem::exists(own) ? own : std::filesystem::path(design.model);
}

// Names the wrench in messages: its file, or the description of a generated wrench.
std::filesystem::path wrench_name(const content::WrenchDesign& design) {
    if (!design.model.empty()) return wrench_file(design);
    return "generated " + tool_models::description(tool_models::parameters_of(design));
}

// Rotates a point of the wrench's model, with bounds low…high, into the tool's frame. `side` = −1 also turns
// the wrench over, for a head that points to the other side.
Vec3 to_tool_frame(const glm::dvec3& low, const glm::dvec3& high, double side, const Vec3& p) {
    const bool flat = high.y - low.y < high.z - low.z;
    const Vec3 q = flat ? Vec3(p.x, -p.z, p.y) : p;
    return {q.x, side * q.y, side * q.z};
}

struct WrenchModel {
    std::vector<collision::ContactMesh> meshes;
    Quat rotation;  // from the model's frame to the tool's
};

// Returns "NAME SIZE bytes, fnv1a SUM", which identifies the file's content (64-bit FNV-1a of Fowler, Noll
// and Vo).
Result<std::string> identity_of(const std::filesystem::path& file) {
    const Result<std::string> bytes = read_file(file, std::size_t{1} << 30U, ErrorCode::bad_content);
    if (!bytes) return fail(bytes.error());
    Fnv1a hash;
    hash.add(*bytes);
    return fmt::format("{} {} bytes, fnv1a {:016x}", file.filename().string(), bytes->size(), hash.value());
}

Result<std::string> wrench_identity(const content::WrenchDesign& design) {
    if (design.model.empty()) return tool_models::identity_of(tool_models::parameters_of(design));
    return identity_of(wrench_file(design));
}

// The generated wrench of a design that names no model. It is made in the tool's frame.
Result<WrenchModel> generate_wrench(const content::WrenchDesign& design) {
    const std::filesystem::path name = wrench_name(design);
    BOLT_TRY_ASSIGN(const auto nodes,
                    mesh_nodes_of(tool_models::contact_model(tool_models::parameters_of(design)), name));
    WrenchModel wrench{{}, Quat(1.0, 0.0, 0.0, 0.0)};
    for (const MeshNode& mesh_node : nodes) {
        BOLT_TRY_ASSIGN(auto mesh, mesh_of(mesh_node, name, [](const Vec3& p) { return p; }));
        wrench.meshes.push_back(std::move(mesh));
    }
    return wrench;
}

Result<WrenchModel> read_wrench(const content::WrenchDesign& design) {
    if (design.model.empty()) return generate_wrench(design);
    const std::filesystem::path file = wrench_file(design);
    BOLT_TRY_ASSIGN(const auto nodes, read_mesh_nodes(file));
    glm::dvec3 low(1e9), high(-1e9);
    for (const MeshNode& mesh_node : nodes)
        for (const glm::dvec3& p : mesh_node.points) low = glm::min(low, p), high = glm::max(high, p);
    // A model may lie flat, as import-step rotates it, or stand upright. Its head may point to either side of
    // the handle.
    for (const double side : {1.0, -1.0}) {
        std::vector<collision::ContactMesh> meshes;
        for (const MeshNode& mesh_node : nodes) {
            BOLT_TRY_ASSIGN(auto mesh, mesh_of(mesh_node, file, [&](const Vec3& p) {
                                return to_tool_frame(low, high, side, p);
                            }));
            meshes.push_back(std::move(mesh));
        }
        const Result<collision::Solid> solid = collision::make_solid(meshes);
        if (!solid) return fail(content_error(file, solid.error().what, solid.error().expected));
        if (side < 0.0 || design.head != content::ToolHeadKind::open_end ||
            mouth_clearance(*solid, design.head_angle, design.jaw) >=
                mouth_clearance(*solid, -design.head_angle, design.jaw))
            return WrenchModel{std::move(meshes),
                               glm::quat_cast(glm::dmat3(to_tool_frame(low, high, side, Vec3(1, 0, 0)),
                                                         to_tool_frame(low, high, side, Vec3(0, 1, 0)),
                                                         to_tool_frame(low, high, side, Vec3(0, 0, 1))))};
    }
    return fail(content_error(file, "the wrench has no triangles", "a closed mesh"));
}

}  // namespace

Result<Quat> wrench_rotation(const content::WrenchDesign& design) {
    BOLT_TRY_ASSIGN(const auto wrench, read_wrench(design));
    return wrench.rotation;
}

std::optional<Error> missing_contact_model(const content::Assembly& assembly) {
    if (!assembly.models.contact.empty()) return std::nullopt;
    return content_error(assembly.file, "the assembly has no contact model",
                         "\"contact_model\": a .glb of the obstacles as closed meshes");
}

Result<std::optional<ContactModels>> load_contact_models(const content::Assembly& assembly,
                                                         const servo::Setup& setup) {
    if (missing_contact_model(assembly)) return std::nullopt;
    const std::filesystem::path file = assembly.models.contact;
    ContactModels models;
    std::vector<MeshNode> nodes;
    for (const std::filesystem::path part : content::model_paths(assembly, &content::ModelFiles::contact)) {
        BOLT_TRY_ASSIGN(auto part_nodes, read_mesh_nodes(part));
        BOLT_TRY_ASSIGN(const auto identity, identity_of(part));
        models.files += (models.files.empty() ? "" : "; ") + identity;
        nodes.insert(nodes.end(), std::make_move_iterator(part_nodes.begin()),
                     std::make_move_iterator(part_nodes.end()));
    }
    std::vector<std::vector<collision::ContactMesh>> tools;
    for (const content::WrenchDesign* design :
         content::designs_of(assembly, content::lesson_tools(assembly))) {
        BOLT_TRY_ASSIGN(auto wrench, read_wrench(*design));
        BOLT_TRY_ASSIGN(const auto identity, wrench_identity(*design));
        models.files += "; " + identity;
        tools.push_back(std::move(wrench.meshes));
    }
    std::vector<collision::ContactMesh> fixed, nuts(setup.nuts.size());
    for (const MeshNode& mesh_node : nodes) {
        std::size_t joint = 0;
        while (joint < assembly.joints.size() &&
               !content::is_turned_node(assembly.joints[joint], mesh_node.node))
            ++joint;
        const bool is_nut = joint < setup.nuts.size() && joint < assembly.joints.size();
        BOLT_TRY_ASSIGN(auto mesh,
                        mesh_of(mesh_node, file,
                                is_nut ? to_nut(setup.nuts[joint], mesh_node)
                                       : std::function<Vec3(const Vec3&)>([](const Vec3& p) { return p; })));
        if (is_nut && !nuts[joint].vertices.empty())
            return fail(content_error(
                file,
                fmt::format("node \"{}\": joint {} has a second mesh of the part that is turned",
                            mesh_node.node, assembly.joints[joint].design.id),
                "one node with the mesh of its nut or screw"));
        const auto id =
            is_nut ? collision::ObstacleId::nut(joint) : collision::ObstacleId::fixed(fixed.size());
        if (!file_number(id))
            return fail(
                content_error(file, "has more parts than a session can number",
                              fmt::format("at most {} fixed parts and {} nuts", max_fixed, max_nuts)));
        models.names.push_back({id, mesh_node.node});
        if (is_nut)
            nuts[joint] = std::move(mesh);
        else
            fixed.push_back(std::move(mesh));
    }
    Result<servo::ToolContact> contact = servo::make_tool_contact(setup, {fixed, nuts, tools});
    if (!contact) return fail(content_error(file, contact.error().what, contact.error().expected));
    models.tool_contact = std::move(*contact);
    return std::optional<ContactModels>(std::move(models));
}

Result<collision::ToolShape> load_wrench(const content::Assembly& assembly) {
    BOLT_TRY_ASSIGN(const auto parts, read_wrench(assembly.wrench));
    Result<collision::ToolShape> tool = collision::make_tool(parts.meshes);
    if (!tool)
        return fail(content_error(wrench_name(assembly.wrench), tool.error().what, tool.error().expected));
    return tool;
}

Result<std::optional<servo::ToolContact>> load_tool_contact(const content::Assembly& assembly,
                                                            const servo::Setup& setup) {
    BOLT_TRY_ASSIGN(auto models, load_contact_models(assembly, setup));
    if (!models.has_value()) return std::nullopt;
    return std::optional<servo::ToolContact>(std::move(models->tool_contact));
}

namespace {

constexpr std::size_t nut_samples = 400;  // visibility within 5 %, enough to choose a view
constexpr double narrowest = 4.0 / 3.0;   // aspect ratio of a picture

bool in_picture(const content::NamedView& view, const Vec3& point) {
    const Vec3 ahead = glm::normalize(view.target - view.eye);
    const Vec3 right = glm::normalize(glm::cross(ahead, Vec3(0.0, 1.0, 0.0)));
    const Vec3 to = point - view.eye;
    const double depth = glm::dot(to, ahead), half_height = depth * std::tan(0.5 * view.field_of_view);
    return depth > 0.0 && std::abs(glm::dot(to, right)) < narrowest * half_height &&
           std::abs(glm::dot(to, glm::cross(right, ahead))) < half_height;
}

}  // namespace

void seat_nuts(const servo::Setup& setup, servo::ToolContact& contact) {
    for (std::size_t i = 0; i < contact.nut_bodies.size(); ++i)
        if (contact.nut_bodies[i])
            contact.world.bodies[*contact.nut_bodies[i]].pose =
                servo::nut_pose(setup.nuts[i], setup.nuts[i].start_gap / setup.nuts[i].lead);
}

std::vector<NutView> nut_views(const content::Assembly& assembly, const servo::ToolContact& contact,
                               std::size_t joint) {
    std::vector<NutView> views;
    if (joint >= contact.nut_bodies.size() || !contact.nut_bodies[joint]) return views;
    const std::size_t body = *contact.nut_bodies[joint];
    const std::vector<collision::SurfacePoint> samples =
        servo::turned_part_samples(contact, joint, nut_samples);
    for (const content::NamedView& view : assembly.views) {
        const collision::Visibility seen = collision::visibility_of(contact.world, body, samples, view.eye);
        views.push_back({seen.share, seen.angle / square(2.0 * std::tan(0.5 * view.field_of_view)),
                         in_picture(view, contact.world.bodies[body].pose.position)});
    }
    return views;
}

std::optional<std::size_t> best_view(std::span<const NutView> views) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (views[i].framed && views[i].size > 0.0 && (!best || views[i].size > views[*best].size)) best = i;
    return best;
}

}  // namespace bolt::session
