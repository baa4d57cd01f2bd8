#include "haptics/collision/samples.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

#include "engine/base/random.hpp"

namespace bolt::collision {
namespace {

// Edges that follow each other within this angle go on straight; a corner that is missed between them sticks
// out by a quarter of it times the length of a piece at most.
const double straight = std::cos(to_radians(8.0));

// The convex edges as a graph: which of them meet at each vertex.
struct RidgeGraph {
    const ContactMesh& mesh;
    std::vector<std::vector<std::uint32_t>> at_vertex;
    std::vector<bool> done;

    RidgeGraph(const Solid& solid, double sharper_than)
        : mesh(solid.mesh), at_vertex(mesh.vertices.size()), done(mesh.sharp_edges.size(), true) {
        for (const Ridge& r : solid.ridges) {
            const std::uint32_t e = r.sharp_edge;
            if (static_cast<double>(mesh.sharp_edges[e].angle) < sharper_than) continue;
            done[e] = false;
            for (const std::uint32_t v : mesh.sharp_edges[e].vertices) at_vertex[v].push_back(e);
        }
    }
    [[nodiscard]] std::uint32_t other_end(std::uint32_t edge, std::uint32_t vertex) const {
        const auto& ends = mesh.sharp_edges[edge].vertices;
        return ends[0] == vertex ? ends[1] : ends[0];
    }
    [[nodiscard]] Vec3 leaving(std::uint32_t edge, std::uint32_t vertex) const {
        return glm::normalize(Vec3(mesh.vertices[other_end(edge, vertex)]) - Vec3(mesh.vertices[vertex]));
    }
    [[nodiscard]] bool is_corner(std::uint32_t vertex) const {
        const auto& edges = at_vertex[vertex];
        if (edges.size() != 2) return !edges.empty();
        return glm::dot(leaving(edges[0], vertex), leaving(edges[1], vertex)) > -straight;
    }
};

void add_piece(Samples& out, const Vec3& a, const Vec3& b, const SharpEdge& edge) {
    Piece piece;
    piece.half = 0.5 * (b - a);
    piece.half_length = glm::length(piece.half);
    piece.inward = {Vec3(edge.inward[0]), Vec3(edge.inward[1])};
    out.samples.push_back({0.5 * (a + b), edge.triangle, static_cast<std::uint32_t>(out.pieces.size())});
    out.pieces.push_back(piece);
}

// One edge in equal pieces, or several short ones of a chain in one.
void follow(RidgeGraph& ridges, std::uint32_t edge, std::uint32_t from, double longest, Samples& out) {
    const ContactMesh& mesh = ridges.mesh;
    Vec3 begin(mesh.vertices[from]);
    Vec3 end = begin;
    std::uint32_t longest_edge = edge;
    double longest_part = 0.0;
    const auto flush = [&] {
        const double length = glm::length(end - begin);
        if (length <= 0.0) return;
        const int pieces = std::max(1, static_cast<int>(std::ceil(length / longest)));
        for (int i = 0; i < pieces; ++i)
            add_piece(out, glm::mix(begin, end, double(i) / pieces),
                      glm::mix(begin, end, double(i + 1) / pieces), mesh.sharp_edges[longest_edge]);
        begin = end;
        longest_part = 0.0;
    };
    for (;;) {
        ridges.done[edge] = true;
        const std::uint32_t to = ridges.other_end(edge, from);
        const Vec3 next(mesh.vertices[to]);
        const double length = glm::length(next - end);
        const bool bends =
            end != begin && glm::dot(glm::normalize(end - begin), glm::normalize(next - end)) < straight;
        if (bends || glm::length(next - begin) > longest) flush();
        end = next;
        if (length > longest_part) {
            longest_part = length;
            longest_edge = edge;
        }
        from = to;
        if (ridges.is_corner(to)) break;
        const auto& edges = ridges.at_vertex[to];
        const std::uint32_t following = edges[0] == edge ? edges[1] : edges[0];
        if (ridges.done[following]) break;
        edge = following;
    }
    flush();
}

void add_edges(const Solid& solid, double longest, Samples& out) {
    RidgeGraph ridges(solid, 0.0);
    for (std::uint32_t v = 0; v < solid.mesh.vertices.size(); ++v)
        if (ridges.is_corner(v))
            for (const std::uint32_t e : ridges.at_vertex[v])
                if (!ridges.done[e]) follow(ridges, e, v, longest, out);
    for (const Ridge& r : solid.ridges) {  // what is left goes round without a corner
        const std::uint32_t e = r.sharp_edge;
        if (!ridges.done[e]) follow(ridges, e, solid.mesh.sharp_edges[e].vertices[0], longest, out);
    }
}

// Points in cells, to tell whether one is near.
class Cells {
  public:
    explicit Cells(double size) : size_(size) {}

    void add(const Vec3& p) { cells_[cell(p)].push_back(p); }
    [[nodiscard]] bool has_near(const Vec3& p) const {  // within `size`
        const Cell middle = cell(p);
        for (int i = 0; i < 27; ++i) {
            const auto found =
                cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
            if (found == cells_.end()) continue;
            for (const Vec3& other : found->second)
                if (glm::dot(p - other, p - other) < size_ * size_) return true;
        }
        return false;
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    struct Hash {
        std::size_t operator()(const Cell& c) const {
            return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
        }
    };
    [[nodiscard]] Cell cell(const Vec3& p) const {
        return {std::llround(p.x / size_), std::llround(p.y / size_), std::llround(p.z / size_)};
    }
    double size_;
    std::unordered_map<Cell, std::vector<Vec3>, Hash> cells_;
};

// How far apart points may be at each vertex so that the surface rises by `round_rise` between them; 0: the
// vertex is a corner, infinite: it needs none.
std::vector<double> spacings(const Solid& solid, double along_edges) {
    const ContactMesh& mesh = solid.mesh;
    std::vector<double> curvature(mesh.vertices.size(), 0.0);
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 6; ++i) {
            const std::uint32_t v = t[i % 3];
            const Vec3 to(Vec3(mesh.vertices[t[(i + 1 + i / 3) % 3]]) - Vec3(mesh.vertices[v]));
            const double below = -glm::dot(glm::normalize(Vec3(mesh.vertex_normals[v])), to);
            if (below > 1e-6) curvature[v] = std::max(curvature[v], 2.0 * below / glm::dot(to, to));
        }
    std::vector<double> spacing(mesh.vertices.size());
    for (std::size_t v = 0; v < spacing.size(); ++v)
        spacing[v] = curvature[v] < least_curvature ? infinite_distance : spacing_on_round(curvature[v]);
    // On an edge counts only how the edge itself turns.
    const RidgeGraph ridges(solid, keen_angle);
    for (std::uint32_t v = 0; v < spacing.size(); ++v) {
        const auto& edges = ridges.at_vertex[v];
        if (edges.empty()) continue;
        if (edges.size() != 2) {
            spacing[v] = 0.0;
            continue;
        }
        const double turn = std::acos(
            std::clamp(-glm::dot(ridges.leaving(edges[0], v), ridges.leaving(edges[1], v)), -1.0, 1.0));
        const Vec3 from(mesh.vertices[ridges.other_end(edges[0], v)]);
        const Vec3 to(mesh.vertices[ridges.other_end(edges[1], v)]);
        const double bend =
            2.0 * turn /
            (glm::length(from - Vec3(mesh.vertices[v])) + glm::length(to - Vec3(mesh.vertices[v])));
        spacing[v] = turn > to_radians(20.0)  ? 0.0
                     : bend < least_curvature ? along_edges
                                              : std::min(along_edges, spacing_on_round(bend));
    }
    return spacing;
}

struct Offer {
    Sample sample;
    double spacing;  // m
};

// The points that divide the way evenly in pieces of at most `spacing`, and a hair: of a length that is a
// whole number of them rounding must not make one more.
template <class Take>
void between(const Vec3& a, const Vec3& b, double spacing, const Take& take) {
    const int pieces = static_cast<int>(std::ceil(glm::length(b - a) / spacing - 1e-3));
    for (int i = 1; i < pieces; ++i) take(glm::mix(a, b, static_cast<double>(i) / pieces));
}

void add_along_edges(const Solid& solid, const SampleOptions& options, std::vector<Sample>& out) {
    for (const Ridge& r : solid.ridges) {
        const SharpEdge& edge = solid.mesh.sharp_edges[r.sharp_edge];
        if (static_cast<double>(edge.angle) < keen_angle && !options.round) continue;
        between(Vec3(r.ends[0]), Vec3(r.ends[1]), options.along_edges,
                [&](const Vec3& at) { out.push_back({.at = at, .triangle = edge.triangle}); });
    }
}

void offer_vertices(const Solid& solid, double along_edges, std::vector<Offer>& out) {
    const ContactMesh& mesh = solid.mesh;
    const std::vector<double> spacing = spacings(solid, along_edges);
    std::vector<std::uint32_t> triangle(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) triangle[v] = t;
    for (std::uint32_t v = 0; v < spacing.size(); ++v)
        if (spacing[v] < infinite_distance)
            out.push_back({{.at = Vec3(mesh.vertices[v]), .triangle = triangle[v]}, spacing[v]});
}

void offer_along_round_edges(const Solid& solid, std::vector<Offer>& out) {
    const ContactMesh& mesh = solid.mesh;
    for (const RoundEdge& edge : mesh.round_edges)
        between(Vec3(mesh.vertices[edge.vertices[0]]), Vec3(mesh.vertices[edge.vertices[1]]),
                static_cast<double>(edge.spacing), [&](const Vec3& at) {
                    out.push_back({{.at = at, .triangle = edge.triangle}, static_cast<double>(edge.spacing)});
                });
}

// The closest first; one is left out where there is one within its own spacing, to the next power of two
// below. Each spacing looks in cells of its size.
void add_thinned(std::vector<Offer> offers, std::vector<Sample>& out) {
    std::stable_sort(offers.begin(), offers.end(),
                     [](const Offer& a, const Offer& b) { return a.spacing < b.spacing; });
    constexpr int levels = 8;
    std::vector<Cells> cells;
    for (int i = 0; i < levels; ++i) cells.emplace_back(std::ldexp(8e-3, -i));
    for (const auto& [sample, spacing] : offers) {
        const int level =
            spacing > 0.0 ? std::max(0, static_cast<int>(std::ceil(std::log2(8e-3 / spacing)))) : levels;
        if (level < levels && cells[static_cast<std::size_t>(level)].has_near(sample.at)) continue;
        // Smaller ones will not be asked any more.
        for (int i = 0; i <= std::min(level, levels - 1); ++i) {
            Cells& c = cells[static_cast<std::size_t>(i)];
            if (!c.has_near(sample.at)) c.add(sample.at);
        }
        out.push_back(sample);
    }
}

// Points that keep their distance from each other: of many random ones each is taken that is not within
// `spacing` of one taken before, and spacing shrinks until there are enough.
class Spreading {
  public:
    Spreading(const ContactMesh& mesh, std::size_t count) {
        std::vector<double> sums;
        double area = 0.0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto [a, b, c] = corners(mesh, t);
            sums.push_back(area += 0.5 * glm::length(glm::cross(b - a, c - a)));
        }
        Random random(1);
        for (std::size_t i = 0; i < 12 * count; ++i) {
            const auto above = std::upper_bound(sums.begin(), sums.end(), random.uniform() * area);
            const auto t =
                std::min(mesh.triangles.size() - 1, static_cast<std::size_t>(above - sums.begin()));
            const auto [a, b, c] = corners(mesh, t);
            const double u = std::sqrt(random.uniform());
            const double v = random.uniform();
            offered_.push_back({.at = a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v),
                                .triangle = static_cast<std::uint32_t>(t)});
        }
        for (double spacing = std::sqrt(area / static_cast<double>(count)); taken_.size() < count;
             spacing *= 0.9)
            take(spacing, count);
    }
    [[nodiscard]] const std::vector<Sample>& taken() const { return taken_; }

  private:
    void take(double spacing, std::size_t count) {
        Cells cells(spacing);
        for (const Sample& s : taken_) cells.add(s.at);
        for (const Sample& s : offered_) {
            if (taken_.size() == count) return;
            if (cells.has_near(s.at)) continue;
            taken_.push_back(s);
            cells.add(s.at);
        }
    }

    std::vector<Sample> offered_, taken_;
};

// Halves along the longest side of their box, at a whole number of clusters, until one is left.
void cluster(Samples& made, std::size_t begin, std::size_t end) {
    std::vector<Sample>& samples = made.samples;
    const auto half = [&](const Sample& s) {
        return s.piece == Sample::no_piece ? Vec3(0.0) : made.pieces[s.piece].half;
    };
    if (begin == end) return;
    Vec3 low(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (std::size_t i = begin; i < end; ++i) {
        low = glm::min(low, samples[i].at - glm::abs(half(samples[i])));
        high = glm::max(high, samples[i].at + glm::abs(half(samples[i])));
    }
    if (end - begin <= cluster_size) {
        Cluster one{0.5 * (low + high), 0.0, 0.0, static_cast<std::uint32_t>(begin),
                    static_cast<std::uint32_t>(end)};
        for (std::size_t i = begin; i < end; ++i)
            for (const Vec3& p : {samples[i].at - half(samples[i]), samples[i].at + half(samples[i])}) {
                one.radius = std::max(one.radius, glm::length(p - one.middle));
                one.reach = std::max(one.reach, glm::length(p));
            }
        made.levels[0].push_back(one);
        return;
    }
    const Vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t clusters = (end - begin + cluster_size - 1) / cluster_size;
    // Whole clusters of the highest level of which there are several.
    std::size_t unit = cluster_size;
    while (clusters * cluster_size > unit * cluster_size) unit *= cluster_size;
    const std::size_t units = (end - begin + unit - 1) / unit;
    const std::size_t middle = begin + units / 2 * unit;
    std::stable_sort(samples.begin() + static_cast<std::ptrdiff_t>(begin),
                     samples.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](const Sample& a, const Sample& b) { return a.at[axis] < b.at[axis]; });
    cluster(made, begin, middle);
    cluster(made, middle, end);
}

std::vector<Cluster> group(const std::vector<Cluster>& clusters) {
    std::vector<Cluster> groups;
    for (std::size_t begin = 0; begin < clusters.size(); begin += cluster_size) {
        const std::size_t end = std::min(clusters.size(), begin + cluster_size);
        Vec3 low(std::numeric_limits<double>::infinity());
        Vec3 high = -low;
        for (std::size_t i = begin; i < end; ++i) {
            low = glm::min(low, clusters[i].middle - clusters[i].radius);
            high = glm::max(high, clusters[i].middle + clusters[i].radius);
        }
        Cluster made{0.5 * (low + high), 0.0, 0.0, static_cast<std::uint32_t>(begin),
                     static_cast<std::uint32_t>(end)};
        for (std::size_t i = begin; i < end; ++i) {
            made.radius =
                std::max(made.radius, glm::length(clusters[i].middle - made.middle) + clusters[i].radius);
            made.reach = std::max(made.reach, clusters[i].reach);
        }
        groups.push_back(made);
    }
    return groups;
}

}  // namespace

Samples make_samples(const Solid& solid, const SampleOptions& options) {
    Samples made;
    std::vector<Offer> offers;
    offer_vertices(solid, options.along_edges, offers);
    if (options.round) offer_along_round_edges(solid, offers);
    add_thinned(std::move(offers), made.samples);
    add_along_edges(solid, options, made.samples);
    if (options.on_faces > 0) {
        const Spreading points(solid.mesh, options.on_faces);
        made.samples.insert(made.samples.end(), points.taken().begin(), points.taken().end());
    }
    if (options.edges) add_edges(solid, options.longest_piece, made);
    made.levels.emplace_back();
    cluster(made, 0, made.samples.size());
    while (made.levels.back().size() > cluster_size) made.levels.push_back(group(made.levels.back()));
    return made;
}

}  // namespace bolt::collision
