// Properties of every generated tool: closed meshes, outward normals, the fit on the hexagon, and the same
// bytes every time.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "content/format/folders.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/base/file.hpp"
#include "haptics/collision/mesh.hpp"
#include "haptics/collision/tool_head.hpp"
#include "support.hpp"

namespace tool_models_tools_test {

using namespace tool_models_test;

namespace {

Shell shell_of(const ToolModelParts& parts, const std::string& name) {
    const auto part =
        std::find_if(parts.begin(), parts.end(), [&](const ToolModelPart& p) { return p.name == name; });
    REQUIRE(part != parts.end());
    return part->shells.front();
}

collision::ContactMesh contact_mesh(const assets::Mesh& mesh) {
    const assets::Primitive& primitive = mesh.primitives.front();
    const auto made = collision::make_contact_mesh(primitive.positions, primitive.indices);
    REQUIRE(made);
    return *made;
}

}  // namespace

TEST_CASE("Tools: each shell of each tool is closed and faces outwards") {
    for (const ToolParameters& p : all_tools())
        for (const Detail detail : {Detail::drawn, Detail::contact})
            for (const ToolModelPart& part : parts_of(p, detail))
                for (const Shell& shell : part.shells) {
                    CAPTURE(description(p));
                    CAPTURE(part.name);
                    CHECK(unpaired_edges(shell) == 0);
                    CHECK(volume(shell) > 0.0);
                    CHECK(all_finite(shell));
                }
}

TEST_CASE("Tools: contact accepts each mesh of each tool as a closed surface without waste") {
    for (const ToolParameters& p : all_tools()) {
        CAPTURE(description(p));
        const assets::Model model = contact_model(p);
        std::size_t triangles = 0;
        for (const assets::Mesh& mesh : model.meshes) {
            CAPTURE(mesh.name);
            const collision::ContactMesh contact = contact_mesh(mesh);
            CHECK(contact.watertight());
            CHECK(contact.without_area == 0);
            triangles += contact.triangles.size();
        }
        CHECK(triangles < 6000);
        CHECK(model.materials.empty());
    }
}

TEST_CASE("Tools: the normals of the drawn model agree with its faces") {
    for (const ToolParameters& p : all_tools()) {
        if (std::lround(p.size / mm) % 5 != 0) continue;
        CAPTURE(description(p));
        const assets::Model model = drawn_model(p);
        std::size_t triangles = 0;
        int wrong = 0;
        for (const assets::Mesh& mesh : model.meshes) {
            const assets::Primitive& primitive = mesh.primitives.front();
            triangles += primitive.indices.size() / 3;
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
                const auto at = [&](std::size_t k) {
                    return Vec3(primitive.positions[primitive.indices[i + k]]);
                };
                const Vec3 face = glm::cross(at(1) - at(0), at(2) - at(0));
                const double area = glm::length(face);
                if (area < 1e-11) continue;
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3 normal(primitive.normals[primitive.indices[i + k]]);
                    wrong += std::abs(glm::length(normal) - 1.0) > 1e-3 ? 1 : 0;
                    wrong += glm::dot(normal, face) < 0.5 * area ? 1 : 0;
                }
            }
        }
        CHECK(wrong == 0);
        CHECK(triangles < 40'000);
    }
}

TEST_CASE("Tools: the same parameters give the same bytes, and other parameters give others") {
    std::set<std::string> identities;
    std::size_t count = 0;
    for (const ToolParameters& p : all_tools()) {
        if (std::lround(p.size / mm) % 3 != 0) continue;
        CHECK(*assets::encode_glb(drawn_model(p)) == *assets::encode_glb(drawn_model(p)));
        CHECK(*assets::encode_glb(contact_model(p)) == *assets::encode_glb(contact_model(p)));
        identities.insert(*identity_of(p));
        ++count;
    }
    CHECK(identities.size() == count);
}

TEST_CASE("Tools: the jaw is exactly as wide as the size and the play, at the head's angle") {
    for (const double size : nut_sizes()) {
        CAPTURE(size);
        const ToolParameters p = standard(ModelKind::open_end_wrench, size);
        const std::vector<Shell> wrench{shell_of(open_end_parts(p, Detail::drawn), "head"),
                                        shell_of(open_end_parts(p, Detail::drawn), "handle")};
        const double angle = to_radians(15.0);
        const Vec3 across(-std::sin(angle), std::cos(angle), 0.0),
            throat(std::cos(angle), std::sin(angle), 0.0);
        const Vec3 inside(1e-4, 1e-4, 1e-4);
        CHECK(first_hit(wrench, inside, across) + first_hit(wrench, inside, -across) ==
              doctest::Approx(size + 0.2).epsilon(1e-6));
        CHECK(first_hit(wrench, inside, -throat) > 1e6);
        CHECK(first_hit(wrench, inside, throat) == doctest::Approx(0.6 * (size + 0.2)).epsilon(1e-3));
        // The flats of a hexagon of the size have half the play as their gap, and its corners are free.
        for (int corner = 0; corner < 6; ++corner) {
            const double at = angle + corner * pi / 3.0;
            const Vec3 out(std::cos(at), std::sin(at), 0.0);
            const double hit = first_hit(wrench, inside, out);
            CHECK(hit > size / std::sqrt(3.0));
        }
    }
}

TEST_CASE("Tools: the closed forms of rings, sockets and keys agree with the generated heads") {
    const auto points_of = [](const ToolModelParts& parts, std::string_view name) {
        return shell_of(parts, std::string(name)).points;
    };
    for (const double size : {8.0, 13.0, 24.0, 46.0}) {
        CAPTURE(size);
        const ToolParameters ring = standard(ModelKind::ring_wrench, size),
                             socket = standard(ModelKind::ratchet, size);
        for (const ToolParameters& p : {ring, socket}) {
            CAPTURE(info_of(p.kind).name);
            const auto gripping = gripping_head(p);
            REQUIRE(gripping);
            const auto& head = std::get<collision::Ring>(gripping->head);
            const auto solids = collision::head_solids(gripping->head);
            REQUIRE(solids);
            const double corner = 0.5 * head.opening / std::cos(pi / 6.0);
            std::size_t inside = 0, wall = 0;
            const ToolModelParts drawn = parts_of(p, Detail::drawn);
            for (const Vec3& point : points_of(drawn, p.kind == ModelKind::ring_wrench ? "ring" : "socket")) {
                const Vec3 at = point * mm;
                const double out = std::hypot(at.x, at.y);
                if (at.z < head.low + 1e-6 || at.z > head.high - 1e-6) continue;
                inside += out < 0.5 * head.opening - 1e-6 ? 1U : 0U;
                if (out < corner + 1e-6 && at.z > head.low + head.lead_in - 1e-6) {
                    ++wall;
                    CHECK(collision::covered(*solids, at));
                }
            }
            CHECK(inside == 0);
            CHECK(wall > 90);
            for (const Vec3& point : points_of(parts_of(p, Detail::contact),
                                               p.kind == ModelKind::ring_wrench ? "ring" : "socket"))
                CHECK(point.z * mm > head.low - 1e-6);
        }
    }
    for (const double size : {3.0, 6.0, 14.0, 22.0}) {
        CAPTURE(size);
        const ToolParameters p = standard(ModelKind::hex_key, size);
        const auto gripping = gripping_head(p);
        REQUIRE(gripping);
        const auto& key = std::get<collision::HexKey>(gripping->head);
        double lowest = 1.0, widest = 0.0;
        for (const Vec3& point : points_of(parts_of(p, Detail::drawn), "key")) {
            lowest = std::min(lowest, point.z * mm);
            if (point.z * mm < key.tip + key.length && std::hypot(point.x, point.y) < size)
                widest = std::max(widest, std::abs(point.x) * mm);
        }
        CHECK(lowest == doctest::Approx(key.tip).epsilon(1e-6));
        CHECK(widest == doctest::Approx(0.5 * key.width).epsilon(1e-6));  // a flat faces the handle
    }
    CHECK_FALSE(gripping_head(standard(ModelKind::extension_bar, 12.5)));
}

TEST_CASE("Tools: the closed form of the jaw covers the generated jaw") {
    for (const double size : nut_sizes()) {
        CAPTURE(size);
        const ToolParameters p = standard(ModelKind::open_end_wrench, size);
        const collision::Jaw jaw = collision::make_jaw(p.opening, *p.head_angle);
        const auto parts = collision::jaw_parts(jaw);
        REQUIRE(parts);
        const Shell head = shell_of(open_end_parts(p, Detail::contact), "head");
        std::size_t flats = 0;
        for (const Vec3& point : head.points) {
            // In the jaw's frame.
            const double c = std::cos(jaw.head_angle), s = std::sin(jaw.head_angle);
            const double x = c * point.x + s * point.y, y = -s * point.x + c * point.y,
                         half = 0.5 * (size + 0.2);
            if (std::abs(y) > 1.05 * half || x > 0.3 * half || x < -0.69 * 2.0 * half) continue;
            ++flats;
            CHECK(collision::covered(*parts, point * mm));
        }
        CHECK(flats > 20);
    }
}

TEST_CASE("Tools: rings and sockets grip a hexagon every 30 degrees with half the play at each flat") {
    for (const double size : nut_sizes()) {
        CAPTURE(size);
        for (const ModelKind kind : {ModelKind::ring_wrench, ModelKind::ratchet}) {
            const std::string name(info_of(kind).name);
            CAPTURE(name);
            const std::vector<Shell> bore{shell_of(parts_of(standard(kind, size), Detail::drawn), name)};
            for (int i = 0; i < 12; ++i) {
                // Valleys between the points bear on the flats; the points leave room for the corners.
                const double valley = (i + 0.5) * pi / 6.0, point = i * pi / 6.0;
                const Vec3 middle(1e-5, 1e-5, 0.01);
                const double half = 0.5 * (size + 0.2);
                CHECK(first_hit(bore, middle, {std::cos(valley), std::sin(valley), 0.0}) ==
                      doctest::Approx(half / std::cos(pi / 12.0)).epsilon(1e-4));
                CHECK(first_hit(bore, middle, {std::cos(point), std::sin(point), 0.0}) ==
                      doctest::Approx(half / std::cos(pi / 6.0)).epsilon(1e-4));
            }
        }
        const RingHead ring = ring_head(standard(ModelKind::ring_wrench, size));
        CHECK(ring.outside == doctest::Approx(1.55 * size));
        CHECK(ring.thickness == doctest::Approx(0.72 * size));
    }
}

TEST_CASE("Tools: a hexagon key has the volume of its hexagon along its arms") {
    for (const double size : standard_sizes(SizeMeasure::socket_screw)) {
        CAPTURE(size);
        const ToolParameters p = standard(ModelKind::hex_key, size);
        const KeyArms arms = key_arms(p.size);
        CHECK(arms.tabulated);
        const double bend = std::max(1.5 * size, 3.0), area = 0.5 * std::sqrt(3.0) * size * size;
        const double path = arms.arm / mm - 0.5 * size - bend + arms.handle / mm - bend + 0.5 * pi * bend;
        CHECK(volume(shell_of(parts_of(p, Detail::drawn), "key")) ==
              doctest::Approx(area * path).epsilon(0.01));
    }
}

TEST_CASE("Tools: a tool reaches as far as its length says") {
    for (const ToolParameters& p : all_tools()) {
        CAPTURE(description(p));
        double x = 0.0, z = 0.0;
        for (const ToolModelPart& part : parts_of(p, Detail::contact))
            for (const Shell& shell : part.shells)
                for (const Vec3& point : shell.points) x = std::max(x, point.x), z = std::max(z, point.z);
        const bool upright = p.kind == ModelKind::extension_bar || p.kind == ModelKind::adaptor ||
                             p.kind == ModelKind::hex_bit;
        CHECK(upright * z + !upright * x == doctest::Approx(p.length / mm).epsilon(0.012));
    }
}

TEST_CASE("Tools: materials are those of materials.json") {
    const auto text = read_file(content::content_folder() / "materials.json", 1 << 20, ErrorCode::failed);
    REQUIRE(text);
    const nlohmann::json materials = nlohmann::json::parse(*text)["materials"];
    std::set<std::string> compared;
    for (const ToolParameters& p :
         {standard(ModelKind::click_torque_wrench, 24), standard(ModelKind::hex_key, 8),
          standard(ModelKind::electronic_torque_wrench, 24)})
        for (const assets::Material& made : drawn_model(p).materials) {
            CAPTURE(made.name);
            if (made.name == "screen" || made.name == "light" || made.name == "alarm") continue;
            REQUIRE(materials.contains(made.name));
            const nlohmann::json& listed = materials[made.name];
            CHECK(made.metallic == doctest::Approx(listed.value("metallic", 1.0)));
            CHECK(made.roughness == doctest::Approx(listed.value("roughness", 1.0)));
            CHECK(made.clearcoat == doctest::Approx(listed.value("clearcoat", 0.0)));
            const unsigned long color =
                std::stoul(listed["base_color"].get<std::string>().substr(1), nullptr, 16);
            for (int i = 0; i < 3; ++i) {
                const double encoded = static_cast<double>((color >> (16 - 8 * i)) & 255) / 255.0;
                const double linear =
                    encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
                CHECK(static_cast<double>(made.base_color[i]) == doctest::Approx(linear).epsilon(1e-4));
            }
            compared.insert(made.name);
        }
    CHECK(compared.size() == 4);
}

}  // namespace tool_models_tools_test
