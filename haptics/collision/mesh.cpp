#include "haptics/collision/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <numeric>

namespace bolt::collision {
namespace {

// Edge `corner` of `triangle`. The key combines its two vertices, the smaller first.
struct HalfEdge {
    std::uint64_t key;
    std::uint32_t triangle;
    std::uint8_t corner;
    bool forward;  // from the smaller vertex to the larger
};

std::uint64_t hash_of(const glm::vec3& v) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k)  // −0 + 0 is 0: equal vertices have one hash
        hash = (hash ^ std::bit_cast<std::uint32_t>(v[k] + 0.0F)) * 0x9e3779b97f4a7c15ULL;
    return hash >> 32U;
}

// Merges vertices at the same position. Returns the new index of each vertex; the first of equal ones is
// kept.
std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> vertices, std::vector<glm::vec3>& kept) {
    constexpr std::uint32_t none = 0xffffffffU;
    std::vector<std::uint32_t> table(std::bit_ceil(2 * vertices.size() + 1), none);  // of indices in `kept`
    std::vector<std::uint32_t> welded;
    welded.reserve(vertices.size());
    for (const glm::vec3& v : vertices) {
        std::size_t slot = hash_of(v) & (table.size() - 1);
        while (table[slot] != none && kept[table[slot]] != v) slot = (slot + 1) & (table.size() - 1);
        if (table[slot] == none) {
            table[slot] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(v);
        }
        welded.push_back(table[slot]);
    }
    return welded;
}

Vec3 inward_in_face(const std::array<Vec3, 3>& face, std::size_t edge, const Vec3& normal) {
    return glm::normalize(glm::cross(normal, face[(edge + 1) % 3] - face[edge]));
}

SharpEdge make_edge(const ContactMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
    const auto face_a = corners(mesh, a.triangle);
    const auto face_b = corners(mesh, b.triangle);
    const Vec3 normal_a(mesh.face_normals[a.triangle]);
    const Vec3 normal_b(mesh.face_normals[b.triangle]);
    const Vec3 inward_b = inward_in_face(face_b, b.corner, normal_b);
    SharpEdge edge{};
    const auto& t = mesh.triangles[a.triangle];
    edge.vertices = {t[a.corner], t[(a.corner + 1U) % 3]};
    edge.triangle = a.triangle;
    edge.angle = static_cast<float>(
        std::atan2(glm::length(glm::cross(normal_a, normal_b)), glm::dot(normal_a, normal_b)));
    edge.normals = {glm::vec3(normal_a), glm::vec3(normal_b)};
    edge.inward = {glm::vec3(inward_in_face(face_a, a.corner, normal_a)), glm::vec3(inward_b)};
    edge.convex = glm::dot(normal_a, inward_b) < 0.0;
    return edge;
}

double height_above_edge(const std::array<Vec3, 3>& face, std::size_t edge) {
    const Vec3 along = face[(edge + 1) % 3] - face[edge];
    return glm::length(glm::cross(along, face[(edge + 2) % 3] - face[edge])) / glm::length(along);
}

// Records the edge between two faces as sharp, as round if it needs samples, or not at all.
void add_edge(ContactMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
    const SharpEdge edge = make_edge(mesh, a, b);
    const double width = std::min(height_above_edge(corners(mesh, a.triangle), a.corner),
                                  height_above_edge(corners(mesh, b.triangle), b.corner));
    const auto angle = static_cast<double>(edge.angle);
    if (0.5 * angle * width > edge_rise || angle > sampled_edge_angle) {
        mesh.sharp_edges.push_back(edge);
        return;
    }
    const double curvature = angle / width;
    if (!edge.convex || curvature < min_curvature) return;
    const double spacing = spacing_on_round(curvature);
    if (glm::length(Vec3(mesh.vertices[edge.vertices[1]]) - Vec3(mesh.vertices[edge.vertices[0]])) > spacing)
        mesh.round_edges.push_back({edge.vertices, edge.triangle, static_cast<float>(spacing)});
}

void classify_edges(ContactMesh& mesh) {
    std::vector<HalfEdge> halves;
    halves.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint8_t corner = 0; corner < 3; ++corner) {
            const std::uint64_t a = mesh.triangles[t][corner];
            const std::uint64_t b = mesh.triangles[t][(corner + 1U) % 3];
            halves.push_back({std::min(a, b) << 32U | std::max(a, b), t, corner, a < b});
        }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
    });
    mesh.edge_normals.assign(mesh.triangles.size(), {});
    for (std::size_t i = 0; i < halves.size();) {
        std::size_t end = i;
        Vec3 normal(0.0);
        while (end < halves.size() && halves[end].key == halves[i].key)
            normal += Vec3(mesh.face_normals[halves[end++].triangle]);
        for (std::size_t k = i; k < end; ++k)
            mesh.edge_normals[halves[k].triangle][halves[k].corner] = glm::vec3(normal);
        const HalfEdge& a = halves[i];
        const HalfEdge& b = halves[i + (end - i > 1 ? 1 : 0)];
        const bool regular = end - i == 2 && a.forward != b.forward;
        if (end - i > 2)
            ++mesh.forked_edges;
        else if (!regular)
            ++mesh.open_edges;
        if (regular) {
            add_edge(mesh, a, b);
        } else {
            mesh.sharp_edges.push_back(make_edge(mesh, a, b));
            mesh.sharp_edges.back().convex = true;
        }
        i = end;
    }
}

void compute_vertex_normals(ContactMesh& mesh) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3(0.0));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto face = corners(mesh, t);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 a = glm::normalize(face[(i + 1) % 3] - face[i]);
            const Vec3 b = glm::normalize(face[(i + 2) % 3] - face[i]);
            const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            normals[mesh.triangles[t][i]] += angle * Vec3(mesh.face_normals[t]);
        }
    }
    mesh.vertex_normals.assign(normals.begin(), normals.end());
}

// The triangle corners at each vertex, in the order of triangles (CSR).
struct VertexCorners {
    std::vector<std::uint32_t> first;    // by vertex; size vertices + 1
    std::vector<std::uint32_t> corners;  // triangle × 3 + corner
};

VertexCorners corners_by_vertex(const ContactMesh& mesh) {
    VertexCorners by_vertex;
    by_vertex.first.assign(mesh.vertices.size() + 1, 0);
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) ++by_vertex.first[v + 1];
    std::partial_sum(by_vertex.first.begin(), by_vertex.first.end(), by_vertex.first.begin());
    by_vertex.corners.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next(by_vertex.first.begin(), by_vertex.first.end() - 1);
    for (std::uint32_t i = 0; i < by_vertex.corners.size(); ++i)
        by_vertex.corners[next[mesh.triangles[i / 3][i % 3]]++] = i;
    return by_vertex;
}

bool is_creased(const glm::vec3& a, const glm::vec3& b) {
    static const double least = std::cos(crease_angle);
    return glm::dot(Vec3(a), Vec3(b)) < least;
}

// Groups the corners of a vertex into smooth surfaces (union-find) and computes the normal of each.
class Smoother {
  public:
    explicit Smoother(ContactMesh& mesh) : mesh_(mesh) {}

    void process_vertex(std::span<const std::uint32_t> corners_here) {
        group_.resize(corners_here.size());
        std::iota(group_.begin(), group_.end(), 0U);
        bool ends_crease = false;
        for (std::uint32_t i = 0; i < corners_here.size(); ++i) {
            // The edge that leaves the vertex in this triangle arrives at it in the next triangle around the
            // vertex.
            const std::uint32_t t = corners_here[i] / 3, leaving = corners_here[i] % 3;
            const std::uint32_t to = mesh_.triangles[t][(leaving + 1) % 3];
            std::size_t neighbours = 0;
            std::uint32_t other = 0;
            for (std::uint32_t k = 0; k < corners_here.size(); ++k) {
                const std::uint32_t coming = corners_here[k] % 3;
                if (mesh_.triangles[corners_here[k] / 3][(coming + 2) % 3] != to) continue;
                ++neighbours;
                other = k;
            }
            const bool crease_here =
                neighbours != 1 ||
                is_creased(mesh_.face_normals[t], mesh_.face_normals[corners_here[other] / 3]);
            if (crease_here) {
                ends_crease = true;
                mark_creased(t, 3 + leaving);
                if (neighbours == 1) mark_creased(corners_here[other] / 3, 3 + (corners_here[other] + 2) % 3);
            } else {
                join(i, other);
            }
        }
        sums_.assign(corners_here.size(), Vec3(0.0));
        for (std::uint32_t i = 0; i < corners_here.size(); ++i)
            sums_[root(i)] += weighted_normal(corners_here[i]);
        for (std::uint32_t i = 0; i < corners_here.size(); ++i) {
            const std::uint32_t t = corners_here[i] / 3, corner = corners_here[i] % 3;
            if (ends_crease) mark_creased(t, corner);
            const Vec3& sum = sums_[root(i)];
            const double length = glm::length(sum);
            mesh_.smooth_normals[t][corner] = length > 0.0 ? glm::vec3(sum / length) : mesh_.face_normals[t];
        }
    }

  private:
    void mark_creased(std::uint32_t triangle, std::uint32_t region) {
        mesh_.creased[triangle] = static_cast<std::uint8_t>(mesh_.creased[triangle] | 1U << region);
    }
    [[nodiscard]] std::uint32_t root(std::uint32_t i) const {
        while (group_[i] != i) i = group_[i];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t of_a = root(a), of_b = root(b);
        group_[std::max(of_a, of_b)] = std::min(of_a, of_b);
    }
    [[nodiscard]] Vec3 weighted_normal(std::uint32_t corner) const {
        const auto face = corners(mesh_, corner / 3);
        const std::size_t i = corner % 3;
        const Vec3 a = face[(i + 1) % 3] - face[i], b = face[(i + 2) % 3] - face[i];
        const double across = glm::length(glm::cross(a, b));
        return std::atan2(across, glm::dot(a, b)) * across * Vec3(mesh_.face_normals[corner / 3]);
    }

    ContactMesh& mesh_;
    std::vector<std::uint32_t> group_;
    std::vector<Vec3> sums_;
};

void compute_smooth_normals(ContactMesh& mesh) {
    mesh.smooth_normals.resize(mesh.triangles.size());
    mesh.creased.assign(mesh.triangles.size(), 0);
    const VertexCorners by_vertex = corners_by_vertex(mesh);
    Smoother smoother(mesh);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        smoother.process_vertex(
            std::span(by_vertex.corners)
                .subspan(by_vertex.first[v], by_vertex.first[v + 1] - by_vertex.first[v]));
}

}  // namespace

Result<ContactMesh> make_contact_mesh(std::span<const glm::vec3> vertices,
                                      std::span<const std::uint32_t> indices) {
    if (vertices.size() > 0xffffffffULL || indices.size() > 0xffffffffULL)
        return fail(ErrorCode::bad_content, "the contact mesh has more than 2^32 vertices or indices",
                    "at most 4294967295 of each");
    if (indices.size() % 3 != 0)
        return fail(ErrorCode::bad_content, fmt::format("the contact mesh has {} indices", indices.size()),
                    "three per triangle");
    for (std::size_t i = 0; i < vertices.size(); ++i)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(vertices[i][k]) <= 1e3F))
                return fail(ErrorCode::bad_content,
                            fmt::format("vertex {} of the contact mesh is at {}", i, vertices[i][k]),
                            "a finite coordinate within 1 km");
    for (const std::uint32_t i : indices)
        if (i >= vertices.size())
            return fail(ErrorCode::bad_content, fmt::format("the contact mesh has the triangle index {}", i),
                        fmt::format("an index below {}", vertices.size()));

    ContactMesh mesh;
    const std::vector<std::uint32_t> welded = weld_vertices(vertices, mesh.vertices);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        mesh.triangles.push_back({welded[indices[i]], welded[indices[i + 1]], welded[indices[i + 2]]});
        const auto [a, b, c] = corners(mesh, mesh.triangles.size() - 1);
        const Vec3 normal = glm::cross(b - a, c - a);
        const double longest =
            std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
        // A triangle thinner than a millionth of its length has no reliable normal in float.
        if (!(glm::length(normal) > 1e-6 * longest)) {
            mesh.triangles.pop_back();
            ++mesh.without_area;
            continue;
        }
        mesh.face_normals.emplace_back(glm::normalize(normal));
    }
    if (mesh.triangles.empty())
        return fail(ErrorCode::bad_content, "the contact mesh has no triangle with an area",
                    "at least one triangle with an area");
    classify_edges(mesh);
    compute_vertex_normals(mesh);
    compute_smooth_normals(mesh);
    return mesh;
}

ContactMesh transformed(ContactMesh mesh, const Pose& pose) {
    const auto turn = [&](glm::vec3& v) { v = glm::vec3(pose.orientation * Vec3(v)); };
    for (glm::vec3& v : mesh.vertices) v = glm::vec3(pose * Vec3(v));
    for (glm::vec3& v : mesh.face_normals) turn(v);
    for (auto& edges : mesh.edge_normals) std::for_each(edges.begin(), edges.end(), turn);
    for (glm::vec3& v : mesh.vertex_normals) turn(v);
    for (auto& corners : mesh.smooth_normals) std::for_each(corners.begin(), corners.end(), turn);
    for (SharpEdge& edge : mesh.sharp_edges) {
        std::for_each(edge.normals.begin(), edge.normals.end(), turn);
        std::for_each(edge.inward.begin(), edge.inward.end(), turn);
    }
    return mesh;
}

void append(ContactMesh& whole, const ContactMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(whole.vertices.size());
    const auto first_triangle = static_cast<std::uint32_t>(whole.triangles.size());
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(whole.vertices, mesh.vertices);
    add(whole.face_normals, mesh.face_normals);
    add(whole.edge_normals, mesh.edge_normals);
    add(whole.vertex_normals, mesh.vertex_normals);
    add(whole.smooth_normals, mesh.smooth_normals);
    add(whole.creased, mesh.creased);
    for (const auto& t : mesh.triangles)
        whole.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (SharpEdge edge : mesh.sharp_edges) {
        edge.vertices = {edge.vertices[0] + first, edge.vertices[1] + first};
        edge.triangle += first_triangle;
        whole.sharp_edges.push_back(edge);
    }
    for (RoundEdge edge : mesh.round_edges) {
        edge.vertices = {edge.vertices[0] + first, edge.vertices[1] + first};
        edge.triangle += first_triangle;
        whole.round_edges.push_back(edge);
    }
    whole.without_area += mesh.without_area;
    whole.open_edges += mesh.open_edges;
    whole.forked_edges += mesh.forked_edges;
}

}  // namespace bolt::collision
