#include "support.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"
#include "tests/support/folder.hpp"

namespace geometry_test {

namespace fs = std::filesystem;
using namespace bolt;

namespace {

constexpr const char* text_head = R"({
  "title": { "en": "Cover" },
  "lesson": { "en": "Tighten." },
  "model": "machine.glb",
  "tool": { "kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140 },
  "joint_types": {
    "M8x30": {
      "size": "M8", "class": "8.8", "bolt_length_mm": 30,
      "members": [{ "thickness_mm": 6, "material": "aluminium" }, { "thickness_mm": 10, "material": "steel" }],
      "washer_under_head": true, "washer_under_nut": true, "friction_thread": 0.12, "friction_bearing": 0.12,
      "spec": { "strategy": "torque", "target_torque_Nm": 20 }
    }
  },
  "passes": [{ "kind": "run_down" }, { "kind": "tighten", "percent": 100 }, { "kind": "recheck" }],
  "joints": [
)";

std::string text_for(const std::vector<Vec3>& positions) {
    std::string text = text_head;
    for (std::size_t i = 0; i < positions.size(); ++i)
        text += fmt::format(
            "    {{ \"id\": \"B{0}\", \"type\": \"M8x30\", \"node\": \"joint_B{0}\", \"position_mm\": "
            "[{1:g}, {2:g}, {3:g}] }}{4}\n",
            i + 1, positions[i].x, positions[i].y, positions[i].z, i + 1 < positions.size() ? "," : "");
    return text + "  ]\n}\n";
}

PrismMesh prism(const std::vector<glm::dvec2>& outline, double low, double high) {
    PrismMesh shape;
    shape.between(std::vector<glm::dvec2>(outline.size(), glm::dvec2(0.0)), outline, low, high);
    return shape;
}

PrismMesh ring(const std::vector<glm::dvec2>& inner, const std::vector<glm::dvec2>& outer, double low,
               double high) {
    PrismMesh shape;
    shape.between(inner, outer, low, high);
    return shape;
}

void append(PrismMesh& shape, const PrismMesh& other) {
    const auto base = static_cast<std::uint32_t>(shape.points.size());
    shape.points.insert(shape.points.end(), other.points.begin(), other.points.end());
    for (const std::uint32_t i : other.indices) shape.indices.push_back(base + i);
}

int add_node(assets::Model& model, const std::string& name, int mesh, const Vec3& place) {
    assets::Node node;
    node.name = name;
    node.mesh = mesh;
    node.translation = glm::vec3(place);
    model.nodes.push_back(node);
    return static_cast<int>(model.nodes.size()) - 1;
}

int add_mesh(assets::Model& model, const PrismMesh& shape) {
    model.meshes.push_back(mesh_of(shape));
    return static_cast<int>(model.meshes.size()) - 1;
}

struct OutlinePoint {
    double x, y;
};

void quad(std::vector<geometry::Triangle>& out, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    out.push_back({a, b, c, 0});
    out.push_back({a, c, d, 0});
}

// Appends a prism along Z over a quadrangle with counterclockwise corners.
void block(std::vector<geometry::Triangle>& out, const OutlinePoint (&base)[4], double half) {
    const auto low = [&](int i) { return Vec3{base[i].x, base[i].y, -half}; };
    const auto high = [&](int i) { return Vec3{base[i].x, base[i].y, half}; };
    quad(out, high(0), high(1), high(2), high(3));
    quad(out, low(3), low(2), low(1), low(0));
    for (int i = 0; i < 4; ++i) {
        const int k = (i + 1) % 4;
        quad(out, low(i), low(k), high(k), high(i));
    }
}

// Distance from the middle of the jaw at which a ray leaves the slot: at |y| = half_jaw or at the bottom x =
// depth.
double slot_exit(double angle, double half_jaw, double depth) {
    const double c = std::cos(angle), s = std::abs(std::sin(angle));
    const double side = s > 0.0 ? half_jaw / s : 1e9, bottom = c > 0.0 ? depth / c : 1e9;
    return std::min(side, bottom);
}

// A temporary content folder; $BOLTWRIGHT_CONTENT names it during its lifetime.
struct TemporaryContent {
    test::Folder root;
    std::string before = content::content_folder().string();
    fs::path folder = root / "assemblies" / "machine";

    TemporaryContent() {
        for (const fs::path& made : {root / "schema", root / "tools", folder}) fs::create_directories(made);
        REQUIRE(write_file(root / "schema" / "assembly.schema.json", "{}"));
        ::setenv("BOLTWRIGHT_CONTENT", root.path().c_str(), 1);
    }
    TemporaryContent(const TemporaryContent&) = delete;
    TemporaryContent& operator=(const TemporaryContent&) = delete;
    ~TemporaryContent() { ::setenv("BOLTWRIGHT_CONTENT", before.c_str(), 1); }
};

std::vector<std::string> without_file(const std::vector<Error>& errors) {
    std::vector<std::string> lines;
    for (const Error& error : errors) {
        CHECK(error.code == ErrorCode::bad_content);
        CHECK(error.line > 0);
        CHECK(error.column > 0);
        lines.push_back(error.message().substr(error.file.size() + 1));
    }
    return lines;
}

}  // namespace

void PrismMesh::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto base = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), {a, b, c, d});
    indices.insert(indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
}

void PrismMesh::between(const std::vector<glm::dvec2>& inner, const std::vector<glm::dvec2>& outer,
                        double low, double high, bool closed) {
    const auto at = [](const glm::dvec2& p, double y) { return Vec3{p.x, y, p.y}; };
    const std::size_t n = inner.size(), last = closed ? n : n - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const std::size_t k = (i + 1) % n;
        quad(at(inner[i], high), at(inner[k], high), at(outer[k], high), at(outer[i], high));
        quad(at(inner[i], low), at(outer[i], low), at(outer[k], low), at(inner[k], low));
        quad(at(outer[i], low), at(outer[i], high), at(outer[k], high), at(outer[k], low));
        quad(at(inner[i], low), at(inner[k], low), at(inner[k], high), at(inner[i], high));
    }
    if (closed) return;
    quad(at(inner[0], low), at(inner[0], high), at(outer[0], high), at(outer[0], low));
    quad(at(inner[last], low), at(outer[last], low), at(outer[last], high), at(inner[last], high));
}

void PrismMesh::box(const Vec3& low, const Vec3& high) {
    between({{low.x, low.z}, {high.x, low.z}}, {{low.x, high.z}, {high.x, high.z}}, low.y, high.y, false);
}

std::vector<glm::dvec2> circle(double radius, int points, Vec3 middle) {
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < points; ++i) {
        const double angle = i * 2.0 * pi / points;
        outline.emplace_back(middle.x + radius * std::cos(angle), middle.z + radius * std::sin(angle));
    }
    return outline;
}

std::vector<glm::dvec2> hexagon(double across_flats, int points) {
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < points; ++i) {
        const double angle = i * 2.0 * pi / points;
        const double radius = 0.5 * across_flats / std::cos(wrap(angle - pi / 6.0, pi / 3.0));
        outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return outline;
}

std::vector<glm::dvec2> square(double side, int points, Vec3 middle) {
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < points; ++i) {
        const double angle = i * 2.0 * pi / points;
        const double radius = 0.5 * side / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
        outline.emplace_back(middle.x + radius * std::cos(angle), middle.z + radius * std::sin(angle));
    }
    return outline;
}

PrismMesh sector(double inner, double outer, double from_deg, double to_deg, double low, double high) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to_deg - from_deg) / 5.0)));
    std::vector<glm::dvec2> near, far;
    for (int i = 0; i <= steps; ++i) {
        // A wrench turns about +Y, from X towards -Z.
        const double angle = -to_radians(to_deg + (from_deg - to_deg) * i / steps);
        near.emplace_back(inner * std::cos(angle), inner * std::sin(angle));
        far.emplace_back(outer * std::cos(angle), outer * std::sin(angle));
    }
    PrismMesh shape;
    shape.between(near, far, low, high, false);
    return shape;
}

assets::Mesh mesh_of(const PrismMesh& shape) {
    assets::Primitive primitive;
    for (const Vec3& p : shape.points) primitive.positions.emplace_back(p * mm);
    primitive.indices = shape.indices;
    assets::Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    return mesh;
}

std::vector<geometry::Triangle> triangles_of(const PrismMesh& shape) {
    std::vector<geometry::Triangle> triangles;
    for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3)
        triangles.push_back({shape.points[shape.indices[i]] * mm, shape.points[shape.indices[i + 1]] * mm,
                             shape.points[shape.indices[i + 2]] * mm, 0});
    return triangles;
}

Machine::Machine(std::vector<Vec3> positions, const NutAndBolt& sizes) {
    PrismMesh cover, base, bolt = prism(circle(sizes.bolt_diameter / 2.0), 0.0, sizes.bolt_length);
    append(bolt, prism(hexagon(13.0), -5.3, 0.0));
    const int bolt_mesh = add_mesh(model, bolt);
    const int washer = add_mesh(model, ring(circle(4.2), circle(8.0), 0.0, 1.6));
    const int nut = add_mesh(model, ring(circle(4.0), hexagon(sizes.nut_flats), 0.0, 6.8));
    int index = 0;
    for (const Vec3& place : positions) {
        const Vec3 hole = place + Vec3{sizes.hole_shift, 0.0, sizes.hole_shift};
        append(base, ring(circle(sizes.hole / 2.0, 48, hole), square(sizes.side, 48, place), place.y - 10.0,
                          place.y + sizes.plate_low));
        append(cover, ring(circle(4.5, 48, place), square(sizes.side, 48, place), place.y - sizes.grip,
                           place.y - 10.0));
        const std::string id = "B" + std::to_string(++index);
        const int joint = add_node(model, "joint_" + id, -1, place * mm);
        model.roots.push_back(joint);
        const double head = -sizes.grip - 1.6;
        for (const auto& [name, mesh, shift] : {std::tuple{"_bolt", bolt_mesh, Vec3{0.0, head, 0.0}},
                                                {"_washer_head", washer, {0.0, head, 0.0}},
                                                {"_washer_nut", washer, {0.0, sizes.washer_low, 0.0}},
                                                {"_nut", nut, {sizes.nut_shift, sizes.nut_low, 0.0}}}) {
            const int child = add_node(model, id + name, mesh, shift * mm);
            model.nodes[static_cast<std::size_t>(joint)].children.push_back(child);
        }
    }
    add("cover", cover);
    add("base", base);
}

int Machine::node(const std::string& name) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (model.nodes[i].name == name) return static_cast<int>(i);
    FAIL("no node " << name);
    return -1;
}

void Machine::add(const std::string& name, const PrismMesh& shape) {
    const int mesh = add_mesh(model, shape);
    model.roots.push_back(add_node(model, name, mesh, Vec3{0.0}));
}

std::string all(const std::vector<std::string>& messages) {
    return fmt::format("{}", fmt::join(messages, "\n"));
}

void replace(std::string& text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, std::string(from));
    text.replace(at, from.size(), to);
}

geometry::ToolGeometry plain_wrench(const content::WrenchDesign& design) {
    geometry::ToolGeometry wrench;
    const double s = design.jaw, radius = 0.5 * head_width_ratio * s, depth = jaw_depth_ratio * s;
    wrench.head_angle = design.head_angle;
    wrench.head_size = radius;
    wrench.half_thickness = 0.5 * thickness_ratio * s;
    wrench.reach = std::max(handle_beyond_grip * design.handle_length, radius);
    // The head is a disc without the slot, built of wedges from the edge of the slot to the rim.
    constexpr int wedges = 72;
    const double prong = std::asin(0.5 * s / radius);  // half angle of the mouth
    const double first = -pi + prong, step = 2.0 * (pi - prong) / wedges;
    for (int i = 0; i < wedges; ++i) {
        const double a = first + i * step, b = a + step;
        const auto point = [&](double angle, double r) {
            const double turned = angle + design.head_angle;
            return OutlinePoint{r * std::cos(turned), r * std::sin(turned)};
        };
        const double inner_a = std::min(radius, slot_exit(a, 0.5 * s, depth));
        const double inner_b = std::min(radius, slot_exit(b, 0.5 * s, depth));
        block(wrench.triangles, {point(a, inner_a), point(a, radius), point(b, radius), point(b, inner_b)},
              wrench.half_thickness);
    }
    const double half = 0.5 * handle_width_ratio * s;
    block(wrench.triangles, {{0.8 * s, -half}, {wrench.reach, -half}, {wrench.reach, half}, {0.8 * s, half}},
          wrench.half_thickness);
    return wrench;
}

assets::Model model_of(const geometry::ToolGeometry& wrench, double shift_mm, double scale, bool lies) {
    PrismMesh shape;
    for (const geometry::Triangle& t : wrench.triangles) {
        const auto base = static_cast<std::uint32_t>(shape.points.size());
        shape.indices.insert(shape.indices.end(), {base, base + 1, base + 2});
        for (const Vec3& p : {t.a, t.b, t.c}) {
            const Vec3 q = (p + Vec3{0.0, shift_mm * mm, 0.0}) * scale / mm;
            shape.points.push_back(lies ? Vec3{q.x, q.z, -q.y} : q);
        }
    }
    assets::Model model;
    model.meshes.push_back(mesh_of(shape));
    model.nodes.emplace_back().mesh = 0;
    model.nodes[0].name = "wrench";
    model.roots = {0};
    return model;
}

namespace {

CheckOutput check_with(const Machine& machine, const Edit& edit, const Machine* far,
                       const assets::Model* contact, const assets::Model* tool, bool generated) {
    const TemporaryContent world;
    std::vector<Vec3> positions;
    for (const assets::Node& node : machine.model.nodes)
        if (node.name.starts_with("joint_")) positions.push_back(Vec3(node.translation) / mm);
    for (Vec3& p : positions) p = Vec3{std::round(p.x), std::round(p.y), std::round(p.z)};
    std::string text = text_for(positions);
    if (far != nullptr) replace(text, "\"machine.glb\",", "\"machine.glb\", \"model_far\": \"far.glb\",");
    if (contact != nullptr)
        replace(text, "\"machine.glb\",", "\"machine.glb\", \"contact_model\": \"contact.glb\",");
    if (tool != nullptr) replace(text, "\"jaw_mm\"", "\"model\": \"wrench.glb\", \"jaw_mm\"");
    if (edit) edit(text);
    REQUIRE(write_file(world.folder / "assembly.json", text));
    REQUIRE(assets::write_glb(world.folder / "machine.glb", machine.model));
    if (far != nullptr) REQUIRE(assets::write_glb(world.folder / "far.glb", far->model));
    if (contact != nullptr) REQUIRE(assets::write_glb(world.folder / "contact.glb", *contact));
    if (tool != nullptr) REQUIRE(assets::write_glb(world.root / "tools" / "wrench.glb", *tool));
    auto loaded = content::load_assembly(world.folder);
    for (const Error& error : loaded.errors) FAIL(error.message());
    for (content::Tool& other : loaded.assembly.tools) {
        if (generated || !other.wrench.model.empty() || other.wrench.head != content::ToolHeadKind::open_end)
            continue;
        const fs::path file = world.root / "tools" / (other.name + ".glb");
        REQUIRE(assets::write_glb(file, model_of(plain_wrench(other.wrench))));
        other.wrench.model = file.string();
    }
    CheckOutput output;
    const auto findings = geometry::check_geometry(loaded.assembly, &output.rooms);
    output.errors = without_file(findings.errors);
    output.notes = without_file(findings.notes);
    return output;
}

}  // namespace

CheckOutput check(const Machine& machine, const Edit& edit, const Machine* far, const assets::Model* contact,
                  const assets::Model* tool) {
    return check_with(machine, edit, far, contact, tool, false);
}

CheckOutput check_generated(const Machine& machine, const Edit& edit) {
    return check_with(machine, edit, nullptr, nullptr, nullptr, true);
}

}  // namespace geometry_test
