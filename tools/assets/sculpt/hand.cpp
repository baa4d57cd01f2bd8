#include "tools/assets/sculpt/hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <tuple>

#include "tools/assets/sculpt/cut.hpp"
#include "tools/assets/sculpt/glove.hpp"
#include "tools/assets/sculpt/hand_skin.hpp"
#include "tools/assets/sculpt/quantise.hpp"
#include "tools/assets/sculpt/simplify.hpp"

namespace bolt::sculpt {
namespace {

LabelledMesh sculpt_glove(const HandShape& shape) {
    LabelledMesh hand;
    hand.mesh = extract(std::cref(shape), shape.box(), 0.85 * mm);
    cut(hand.mesh, [](const Vec3& p) { return p.z - (HandShape::cuff_end - HandShape::hem); });
    cut(hand.mesh, [](const Vec3& p) { return p.z - cuff_begin; });
    cut(hand.mesh, [&](const Vec3& p) { return p.z > cuff_begin ? -1.0 : dipped(shape, p); });
    for (Vec3& p : hand.mesh.positions) p = rounded(project(std::cref(shape), p, 0.1 * mm, 1), micron);
    hand.mesh = weld(hand.mesh);
    for (const Triangle& t : hand.mesh.triangles) {
        const Vec3 centre =
            (hand.mesh.positions[t[0]] + hand.mesh.positions[t[1]] + hand.mesh.positions[t[2]]) / 3.0;
        hand.labels.push_back(glove_part(shape, centre));
    }
    return simplify(hand, hand_triangles);
}

// Patches follow the normals of single triangles; a triangle that stands alone joins its neighbours.
std::vector<Patch> patches(const HandShape& shape, const LabelledMesh& hand) {
    std::vector<Patch> out;
    for (std::size_t i = 0; i < hand.mesh.triangles.size(); ++i) {
        const Triangle& t = hand.mesh.triangles[i];
        const Vec3 centre =
            (hand.mesh.positions[t[0]] + hand.mesh.positions[t[1]] + hand.mesh.positions[t[2]]) / 3.0;
        out.push_back(patch_of(shape, centre, glm::normalize(area_vector(hand.mesh, t)),
                               static_cast<GlovePart>(hand.labels[i])));
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> owner;
    for (std::size_t i = 0; i < hand.mesh.triangles.size(); ++i) {
        const Triangle& t = hand.mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) owner[{t[k], t[(k + 1) % 3]}] = i;
    }
    for (int round = 0; round < 3; ++round) {
        for (std::size_t i = 0; i < out.size(); ++i) {
            const Triangle& t = hand.mesh.triangles[i];
            std::array<const Patch*, 3> next{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto other = owner.find({t[(k + 1) % 3], t[k]});
                next[k] = other == owner.end() ? &out[i] : &out[other->second];
            }
            for (std::size_t k = 0; k < 3; ++k) {
                if (*next[k] == *next[(k + 1) % 3] && !(*next[k] == out[i])) out[i] = *next[k];
            }
        }
    }
    return out;
}

struct Corner {
    std::uint32_t vertex = 0;
    Laid laid;
};

// A triangle across the cuff's seam is laid on one side of it.
void unwrap(std::array<Corner, 3>& corners) {
    for (std::size_t k = 1; k < 3; ++k) {
        double& u = corners[k].laid.uv.x;
        if (u - corners[0].laid.uv.x > 0.5 * cuff_round) u -= cuff_round;
        if (u - corners[0].laid.uv.x < -0.5 * cuff_round) u += cuff_round;
    }
}

struct Builder {
    const HandShape& shape;
    const TriMesh& mesh;
    std::vector<Vec3> normals;
    std::vector<float> shades;
    std::vector<Influences> skin;

    Builder(const HandShape& s, const TriMesh& m) : shape(s), mesh(m) {
        for (const Vec3& p : mesh.positions) {
            normals.push_back(glm::normalize(gradient(std::cref(shape), p, 0.5 * mm)));
            shades.push_back(static_cast<float>(rounded(shading(shape, p, normals.back()), 1.0 / 256.0)));
            skin.push_back(influences(shape, p));
        }
    }

    std::uint32_t add(assets::Primitive& out, const Corner& corner) const {
        const std::uint32_t v = corner.vertex;
        const Vec3& n = normals[v];
        const Vec3 tangent = glm::normalize(corner.laid.along_u - n * glm::dot(n, corner.laid.along_u));
        const bool straight = glm::dot(glm::cross(n, tangent), corner.laid.against_v) >= 0.0;
        out.positions.emplace_back(mesh.positions[v]);
        out.normals.emplace_back(rounded(n, fine));
        out.tangents.emplace_back(glm::vec3(rounded(tangent, fine)), straight ? 1.0F : -1.0F);
        out.texcoords[0].emplace_back(glm::dvec2(rounded(corner.laid.uv.x / tile_length, fine),
                                                 rounded(corner.laid.uv.y / tile_length, fine)));
        out.colors.emplace_back(shades[v], shades[v], shades[v], 1.0F);
        out.joints.emplace_back(skin[v].joints[0], skin[v].joints[1], skin[v].joints[2], skin[v].joints[3]);
        out.weights.emplace_back(skin[v].weights[0], skin[v].weights[1], skin[v].weights[2],
                                 skin[v].weights[3]);
        return static_cast<std::uint32_t>(out.positions.size()) - 1;
    }
};

assets::Mesh right_mesh(const HandShape& shape) {
    const LabelledMesh hand = sculpt_glove(shape);
    const std::vector<Patch> patch = patches(shape, hand);
    const Builder builder(shape, hand.mesh);
    assets::Mesh out;
    out.name = "hand";
    for (int part = 0; part < glove_parts; ++part) {
        assets::Primitive primitive;
        primitive.material = part;
        std::map<std::tuple<std::uint32_t, double, double, int>, std::uint32_t> known;
        for (std::size_t i = 0; i < hand.mesh.triangles.size(); ++i) {
            if (hand.labels[i] != part) continue;
            std::array<Corner, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k].vertex = hand.mesh.triangles[i][k];
                corners[k].laid = lay(shape, patch[i], hand.mesh.positions[corners[k].vertex]);
            }
            if (part == cuff || part == hem) unwrap(corners);
            for (const Corner& corner : corners) {
                const int name = patch[i].digit * 6 + patch[i].face;
                const auto [entry, fresh] = known.try_emplace(
                    {corner.vertex, corner.laid.uv.x, corner.laid.uv.y, name}, std::uint32_t{0});
                if (fresh) entry->second = builder.add(primitive, corner);
                primitive.indices.push_back(entry->second);
            }
        }
        out.primitives.push_back(std::move(primitive));
    }
    return out;
}

assets::Mesh mirrored(const assets::Mesh& mesh) {
    assets::Mesh out = mesh;
    for (assets::Primitive& primitive : out.primitives) {
        for (glm::vec3& p : primitive.positions) p.x = -p.x;
        for (glm::vec3& n : primitive.normals) n.x = -n.x;
        for (glm::vec4& t : primitive.tangents) t = {-t.x, t.y, t.z, -t.w};
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
        }
    }
    return out;
}

void add_skeleton(assets::Model& model, const Skeleton& hand) {
    assets::Skin skin;
    skin.name = "hand";
    const int first = static_cast<int>(model.nodes.size());
    for (std::size_t i = 0; i < joint_count; ++i) {
        assets::Node node;
        node.name = joint_names[i];
        const std::size_t parent = parent_of(i);
        Vec3 at = hand.position[i];
        Quat turn = hand.rotation[i];
        if (parent != joint_count) {
            const Quat back = glm::conjugate(hand.rotation[parent]);
            at = back * (at - hand.position[parent]);
            turn = back * turn;
        }
        node.translation = glm::vec3(rounded(at, 1e-7));
        if (turn.w < 0.0) turn = -turn;
        node.rotation = glm::quat(
            Quat(rounded(turn.w, 1e-7), rounded(turn.x, 1e-7), rounded(turn.y, 1e-7), rounded(turn.z, 1e-7)));
        model.nodes.push_back(node);
        skin.joints.push_back(first + static_cast<int>(i));
    }
    // Global places from the very numbers that are written, so that skin and nodes agree.
    std::array<glm::dmat4, joint_count> global{};
    std::array<bool, joint_count> known{};
    const auto place = [&](const auto& self, std::size_t i) -> const glm::dmat4& {
        if (known[i]) return global[i];
        const assets::Node& node = model.nodes[static_cast<std::size_t>(first) + i];
        glm::dmat4 local = glm::mat4_cast(Quat(node.rotation));
        local[3] = glm::dvec4(Vec3(node.translation), 1.0);
        global[i] = parent_of(i) == joint_count ? local : self(self, parent_of(i)) * local;
        known[i] = true;
        return global[i];
    };
    for (std::size_t i = 0; i < joint_count; ++i) {
        glm::dmat4 inverse = glm::inverse(place(place, i));
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 4; ++r) inverse[c][r] = rounded(inverse[c][r], 1e-8);
        }
        skin.inverse_bind.emplace_back(inverse);
        if (parent_of(i) != joint_count) {
            model.nodes[static_cast<std::size_t>(first) + parent_of(i)].children.push_back(
                first + static_cast<int>(i));
        }
    }
    skin.skeleton = first + static_cast<int>(wrist);
    model.roots.push_back(skin.skeleton);
    model.skins.push_back(std::move(skin));
}

Result<assets::Model> dress(const Skeleton& skeleton, assets::Mesh mesh, const std::string& name) {
    assets::Model model;
    model.generator = "bolt-sculpt";
    mesh.name = name;
    model.meshes.push_back(std::move(mesh));
    assets::Node node;
    node.name = name;
    node.mesh = 0;
    node.skin = 0;
    model.nodes.push_back(node);
    model.roots.push_back(0);
    add_skeleton(model, skeleton);
    if (Status s = add_glove_materials(model); !s) return tl::unexpected(s.error());
    return model;
}

}  // namespace

Result<Hands> make_hands() {
    const HandShape shape;
    const assets::Mesh mesh = right_mesh(shape);
    Hands hands;
    Result<assets::Model> right = dress(shape.skeleton(), mesh, "hand_right");
    if (!right) return tl::unexpected(right.error());
    hands.right = std::move(*right);
    Result<assets::Model> left = dress(mirrored(shape.skeleton()), mirrored(mesh), "hand_left");
    if (!left) return tl::unexpected(left.error());
    hands.left = std::move(*left);
    return hands;
}

}  // namespace bolt::sculpt
