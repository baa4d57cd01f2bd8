#include "tools/assets/sculpt/hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numeric>
#include <tuple>

#include "tools/assets/sculpt/glove.hpp"
#include "tools/assets/sculpt/hand_shape.hpp"
#include "tools/assets/sculpt/mesh.hpp"
#include "tools/assets/sculpt/quantise.hpp"

namespace bolt::sculpt {

namespace {

// Skinning weights: at most four joints; the weights are multiples of 1/256 and their sum is exactly one.
// Joints without weight are 0.
struct SkinWeights {
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};
};

using JointWeights = std::array<double, joint_count>;

Vec3 forward(const Skeleton& hand, std::size_t joint) { return hand.rotation[joint] * Vec3(0.0, 0.0, -1.0); }

// Returns 0 for points before joint k of a digit, 1 for points beyond it, with a smooth step across the plane
// that bisects the angle between the bones.
double fraction_past_joint(const HandShape& shape, std::size_t digit, std::size_t k, const Vec3& p) {
    const Skeleton& hand = shape.skeleton();
    const std::size_t joint = digits[digit].first + k;
    const Vec3 axis = glm::normalize(forward(hand, joint - 1) + forward(hand, joint));
    double distance = glm::dot(p - hand.position[joint], axis);
    const double height = glm::dot(p - hand.position[joint], hand.rotation[joint] * Vec3(0.0, 1.0, 0.0));
    double reach = k == 1 ? 13.5 * mm : (k == 2 ? 11.5 * mm : 8.5 * mm);
    if (digit == 0) reach = k == 1 ? 10 * mm : 8 * mm;
    // The skin of the web moves with the palm, so on the palm side the finger begins further out than on the
    // back.
    if (digit != 0 && k == 1) distance -= 6 * mm * smooth_step(2 * mm, -10 * mm, height);
    return smooth_step(-reach, reach, distance);
}

void add_digit(const HandShape& shape, std::size_t digit, const Vec3& p, double share, JointWeights& out) {
    if (share <= 0.0) return;
    double assigned = 0.0;  // weight of the joints further out
    for (std::size_t k = digits[digit].count - 2; k > 0; --k) {
        const double own = std::max(0.0, share * fraction_past_joint(shape, digit, k, p) - assigned);
        out[digits[digit].first + k] += own;
        assigned += own;
    }
    out[digits[digit].first] += share - assigned;
}

// Keeps the four greatest weights and quantises them.
SkinWeights quantise_weights(const JointWeights& weights) {
    std::array<std::size_t, joint_count> order{};
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sum += weights[order[i]];
    SkinWeights out;
    int left = 256;
    for (std::size_t i = 3; i > 0; --i) {
        const int part = static_cast<int>(std::lround(256.0 * weights[order[i]] / sum));
        if (part == 0) continue;
        out.joints[i] = static_cast<std::uint16_t>(order[i]);
        out.weights[i] = static_cast<float>(part) / 256.0F;
        left -= part;
    }
    out.joints[0] = static_cast<std::uint16_t>(order[0]);
    out.weights[0] = static_cast<float>(left) / 256.0F;
    return out;
}

// Returns the skinning weights of a point. They are smooth over the hand. Beyond the web, only the joints of
// its own finger move a point.
SkinWeights skin_weights(const HandShape& shape, const Vec3& p) {
    const Skeleton& hand = shape.skeleton();
    JointWeights weights{};

    std::array<double, 5> depth{};
    std::size_t nearest = 1;
    for (std::size_t d = 0; d < 5; ++d) {
        depth[d] = shape.locate(d, p).depth;
        if (d > 1 && depth[d] < depth[nearest]) nearest = d;
    }
    // The thumb's weight increases where the thumb is the nearest digit.
    const double thumb_distance =
        glm::dot(p - hand.position[thumb_metacarpal], forward(hand, thumb_metacarpal));
    const double thumb = smooth_step(-10 * mm, 13 * mm, depth[nearest] - depth[0]) *
                         smooth_step(-12 * mm, 18 * mm, thumb_distance);
    add_digit(shape, 0, p, thumb, weights);

    const double arm = smooth_step(-46 * mm, -12 * mm, p.z) * (1.0 - thumb);
    weights[wrist] += arm;

    // In the palm all fingers contribute; beyond the web only the nearest finger does.
    const std::size_t knuckle = digits[nearest].first + 1;
    const double distance = glm::dot(p - hand.position[knuckle], forward(hand, knuckle));
    const double parted = smooth_step(2 * mm, 19 * mm, distance);
    const double width = 14 * mm + parted * (0.3 * mm - 14 * mm);
    std::array<double, 5> finger_distance = depth;
    if (parted > 0.0) {
        for (std::size_t d = 1; d < 5; ++d)
            finger_distance[d] += parted * (shape.digit_distance(d, p) - finger_distance[d]);
    }
    const double first = *std::min_element(finger_distance.begin() + 1, finger_distance.end());
    std::array<double, 5> finger_weight{};
    double total = 0.0;
    for (std::size_t d = 1; d < 5; ++d) {
        finger_weight[d] = square(std::max(0.0, 1.0 - (finger_distance[d] - first) / width));
        total += finger_weight[d];
    }
    for (std::size_t d = 1; d < 5; ++d) {
        add_digit(shape, d, p, (1.0 - thumb - arm) * finger_weight[d] / total, weights);
    }
    return quantise_weights(weights);
}

LabelledMesh sculpt_glove(const HandShape& shape) {
    LabelledMesh hand;
    hand.mesh = extract(std::cref(shape), shape.bounds(), 0.85 * mm);
    cut(hand.mesh, [](const Vec3& p) { return p.z - (HandShape::cuff_end - HandShape::hem); });
    cut(hand.mesh, [](const Vec3& p) { return p.z - cuff_begin; });
    cut(hand.mesh, [&](const Vec3& p) { return p.z > cuff_begin ? -1.0 : coating(shape, p); });
    for (Vec3& p : hand.mesh.positions) p = rounded(project(std::cref(shape), p, 0.1 * mm, 1), micron);
    hand.mesh = weld(hand.mesh);
    for (const IndexTriangle& t : hand.mesh.triangles) {
        const Vec3 centre =
            (hand.mesh.positions[t[0]] + hand.mesh.positions[t[1]] + hand.mesh.positions[t[2]]) / 3.0;
        hand.labels.push_back(glove_part(shape, centre));
    }
    return simplify(hand, hand_triangles);
}

// Assigns each triangle to a patch by its normal, then assigns isolated triangles to the patch of their
// neighbours.
std::vector<TexturePatch> patches(const HandShape& shape, const LabelledMesh& hand) {
    std::vector<TexturePatch> out;
    for (std::size_t i = 0; i < hand.mesh.triangles.size(); ++i) {
        const IndexTriangle& t = hand.mesh.triangles[i];
        const Vec3 centre =
            (hand.mesh.positions[t[0]] + hand.mesh.positions[t[1]] + hand.mesh.positions[t[2]]) / 3.0;
        out.push_back(patch_of(shape, centre, glm::normalize(area_vector(hand.mesh, t)),
                               static_cast<GlovePart>(hand.labels[i])));
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> owner;
    for (std::size_t i = 0; i < hand.mesh.triangles.size(); ++i) {
        const IndexTriangle& t = hand.mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) owner[{t[k], t[(k + 1) % 3]}] = i;
    }
    for (int round = 0; round < 3; ++round) {
        for (std::size_t i = 0; i < out.size(); ++i) {
            const IndexTriangle& t = hand.mesh.triangles[i];
            std::array<const TexturePatch*, 3> next{};
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

struct TriangleCorner {
    std::uint32_t vertex = 0;
    PatchPoint mapped;
};

// Moves the corners of a triangle that crosses the cuff's seam to one side of the seam.
void unwrap(std::array<TriangleCorner, 3>& corners) {
    for (std::size_t k = 1; k < 3; ++k) {
        double& u = corners[k].mapped.uv.x;
        if (u - corners[0].mapped.uv.x > 0.5 * cuff_round) u -= cuff_round;
        if (u - corners[0].mapped.uv.x < -0.5 * cuff_round) u += cuff_round;
    }
}

struct HandMeshBuilder {
    const HandShape& shape;
    const TriMesh& mesh;
    std::vector<Vec3> normals;
    std::vector<float> shades;
    std::vector<SkinWeights> skin;

    HandMeshBuilder(const HandShape& s, const TriMesh& m) : shape(s), mesh(m) {
        for (const Vec3& p : mesh.positions) {
            normals.push_back(glm::normalize(gradient(std::cref(shape), p, 0.5 * mm)));
            shades.push_back(
                static_cast<float>(rounded(ambient_shade(shape, p, normals.back()), 1.0 / 256.0)));
            skin.push_back(skin_weights(shape, p));
        }
    }

    std::uint32_t add(assets::Primitive& out, const TriangleCorner& corner) const {
        const std::uint32_t v = corner.vertex;
        const Vec3& n = normals[v];
        const Vec3 tangent = glm::normalize(corner.mapped.along_u - n * glm::dot(n, corner.mapped.along_u));
        const bool straight = glm::dot(glm::cross(n, tangent), corner.mapped.against_v) >= 0.0;
        out.positions.emplace_back(mesh.positions[v]);
        out.normals.emplace_back(rounded(n, fine));
        out.tangents.emplace_back(glm::vec3(rounded(tangent, fine)), straight ? 1.0F : -1.0F);
        out.texcoords[0].emplace_back(glm::dvec2(rounded(corner.mapped.uv.x / tile_length, fine),
                                                 rounded(corner.mapped.uv.y / tile_length, fine)));
        out.colors.emplace_back(shades[v], shades[v], shades[v], 1.0F);
        out.joints.emplace_back(skin[v].joints[0], skin[v].joints[1], skin[v].joints[2], skin[v].joints[3]);
        out.weights.emplace_back(skin[v].weights[0], skin[v].weights[1], skin[v].weights[2],
                                 skin[v].weights[3]);
        return static_cast<std::uint32_t>(out.positions.size()) - 1;
    }
};

assets::Mesh right_mesh(const HandShape& shape) {
    const LabelledMesh hand = sculpt_glove(shape);
    const std::vector<TexturePatch> patch = patches(shape, hand);
    const HandMeshBuilder builder(shape, hand.mesh);
    assets::Mesh out;
    out.name = "hand";
    for (int part = 0; part < glove_parts; ++part) {
        assets::Primitive primitive;
        primitive.material = part;
        std::map<std::tuple<std::uint32_t, double, double, int>, std::uint32_t> known;
        for (std::size_t i = 0; i < hand.mesh.triangles.size(); ++i) {
            if (hand.labels[i] != part) continue;
            std::array<TriangleCorner, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k].vertex = hand.mesh.triangles[i][k];
                corners[k].mapped = map_to_patch(shape, patch[i], hand.mesh.positions[corners[k].vertex]);
            }
            if (part == cuff || part == hem) unwrap(corners);
            for (const TriangleCorner& corner : corners) {
                const int patch_id = patch[i].digit * 6 + patch[i].face;
                const auto [entry, is_new] = known.try_emplace(
                    {corner.vertex, corner.mapped.uv.x, corner.mapped.uv.y, patch_id}, std::uint32_t{0});
                if (is_new) entry->second = builder.add(primitive, corner);
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
    // Compute the global transforms from the rounded values that are written, so that skin and nodes agree.
    std::array<glm::dmat4, joint_count> global{};
    std::array<bool, joint_count> known{};
    const auto global_of = [&](const auto& self, std::size_t i) -> const glm::dmat4& {
        if (known[i]) return global[i];
        const assets::Node& node = model.nodes[static_cast<std::size_t>(first) + i];
        glm::dmat4 local = glm::mat4_cast(Quat(node.rotation));
        local[3] = glm::dvec4(Vec3(node.translation), 1.0);
        global[i] = parent_of(i) == joint_count ? local : self(self, parent_of(i)) * local;
        known[i] = true;
        return global[i];
    };
    for (std::size_t i = 0; i < joint_count; ++i) {
        glm::dmat4 inverse = glm::inverse(global_of(global_of, i));
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

// Assembles the glTF model of a hand from its mesh and skeleton.
Result<assets::Model> make_hand_model(const Skeleton& skeleton, assets::Mesh mesh, const std::string& name) {
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

Result<HandModels> make_hands() {
    const HandShape shape;
    const assets::Mesh mesh = right_mesh(shape);
    HandModels hands;
    Result<assets::Model> right = make_hand_model(shape.skeleton(), mesh, "hand_right");
    if (!right) return tl::unexpected(right.error());
    hands.right = std::move(*right);
    Result<assets::Model> left = make_hand_model(mirrored(shape.skeleton()), mirrored(mesh), "hand_left");
    if (!left) return tl::unexpected(left.error());
    hands.left = std::move(*left);
    return hands;
}

}  // namespace bolt::sculpt
