#include "haptics/collision/samples.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "engine/base/random.hpp"
#include "haptics/collision/point_grid.hpp"

namespace bolt::collision {
namespace {

// Consecutive edges within this angle (8°) are joined into one piece. A vertex between them protrudes from
// the piece by at most a quarter of the angle times the piece's length.
const double straight_cosine = std::cos(to_radians(8.0));

// The convex edges as a graph, with the edges that meet at each vertex.
struct RidgeGraph {
    const ContactMesh& mesh;
    std::vector<std::vector<std::uint32_t>> at_vertex;
    std::vector<bool> used;

    RidgeGraph(const Solid& solid, double sharper_than)
        : mesh(solid.mesh), at_vertex(mesh.vertices.size()), used(mesh.sharp_edges.size(), true) {
        for (const Ridge& r : solid.ridges) {
            const std::uint32_t e = r.sharp_edge;
            if (static_cast<double>(mesh.sharp_edges[e].angle) < sharper_than) continue;
            used[e] = false;
            for (const std::uint32_t v : mesh.sharp_edges[e].vertices) at_vertex[v].push_back(e);
        }
    }
    [[nodiscard]] std::uint32_t other_end(std::uint32_t edge, std::uint32_t vertex) const {
        const auto& ends = mesh.sharp_edges[edge].vertices;
        return ends[0] == vertex ? ends[1] : ends[0];
    }
    [[nodiscard]] Vec3 direction_from(std::uint32_t edge, std::uint32_t vertex) const {
        return glm::normalize(Vec3(mesh.vertices[other_end(edge, vertex)]) - Vec3(mesh.vertices[vertex]));
    }
    [[nodiscard]] bool is_chain_end(std::uint32_t vertex) const {
        const auto& edges = at_vertex[vertex];
        if (edges.size() != 2) return !edges.empty();
        return glm::dot(direction_from(edges[0], vertex), direction_from(edges[1], vertex)) >
               -straight_cosine;
    }
};

void add_piece(SurfaceSamples& out, const Vec3& a, const Vec3& b, const SharpEdge& edge) {
    PieceExtent piece;
    piece.half = 0.5 * (b - a);
    piece.half_length = glm::length(piece.half);
    piece.inward = {Vec3(edge.inward[0]), Vec3(edge.inward[1])};
    out.samples.push_back({0.5 * (a + b), edge.triangle, static_cast<std::uint32_t>(out.pieces.size())});
    out.pieces.push_back(piece);
}

// Follows a chain of edges from a vertex and adds its pieces: a long edge is divided into equal pieces, short
// ones are joined.
void add_chain(RidgeGraph& ridges, std::uint32_t edge, std::uint32_t from, double longest,
               SurfaceSamples& out) {
    const ContactMesh& mesh = ridges.mesh;
    Vec3 begin(mesh.vertices[from]);
    Vec3 end = begin;
    std::uint32_t longest_edge = edge;
    double longest_part = 0.0;
    const auto emit_pieces = [&] {
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
        ridges.used[edge] = true;
        const std::uint32_t to = ridges.other_end(edge, from);
        const Vec3 next(mesh.vertices[to]);
        const double length = glm::length(next - end);
        const bool bends = end != begin && glm::dot(glm::normalize(end - begin), glm::normalize(next - end)) <
                                               straight_cosine;
        if (bends || glm::length(next - begin) > longest) emit_pieces();
        end = next;
        if (length > longest_part) {
            longest_part = length;
            longest_edge = edge;
        }
        from = to;
        if (ridges.is_chain_end(to)) break;
        const auto& edges = ridges.at_vertex[to];
        const std::uint32_t next_edge = edges[0] == edge ? edges[1] : edges[0];
        if (ridges.used[next_edge]) break;
        edge = next_edge;
    }
    emit_pieces();
}

void add_edges(const Solid& solid, double longest, SurfaceSamples& out) {
    RidgeGraph ridges(solid, 0.0);
    for (std::uint32_t v = 0; v < solid.mesh.vertices.size(); ++v)
        if (ridges.is_chain_end(v))
            for (const std::uint32_t e : ridges.at_vertex[v])
                if (!ridges.used[e]) add_chain(ridges, e, v, longest, out);
    for (const Ridge& r : solid.ridges) {  // the remaining edges form closed loops without a corner
        const std::uint32_t e = r.sharp_edge;
        if (!ridges.used[e]) add_chain(ridges, e, solid.mesh.sharp_edges[e].vertices[0], longest, out);
    }
}

// The permitted spacing of samples (m) at each vertex, such that the surface rises by at most `round_rise`
// between them; 0: the vertex is a corner and always a sample; infinite: it needs none.
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
        spacing[v] = curvature[v] < min_curvature ? infinite_distance : spacing_on_round(curvature[v]);
    // At a vertex on an edge sharper than `sampled_edge_angle` only the curvature of the edge itself counts.
    const RidgeGraph ridges(solid, sampled_edge_angle);
    for (std::uint32_t v = 0; v < spacing.size(); ++v) {
        const auto& edges = ridges.at_vertex[v];
        if (edges.empty()) continue;
        if (edges.size() != 2) {
            spacing[v] = 0.0;
            continue;
        }
        const double turn = std::acos(std::clamp(
            -glm::dot(ridges.direction_from(edges[0], v), ridges.direction_from(edges[1], v)), -1.0, 1.0));
        const Vec3 from(mesh.vertices[ridges.other_end(edges[0], v)]);
        const Vec3 to(mesh.vertices[ridges.other_end(edges[1], v)]);
        const double bend =
            2.0 * turn /
            (glm::length(from - Vec3(mesh.vertices[v])) + glm::length(to - Vec3(mesh.vertices[v])));
        spacing[v] = turn > to_radians(20.0) ? 0.0
                     : bend < min_curvature  ? along_edges
                                             : std::min(along_edges, spacing_on_round(bend));
    }
    return spacing;
}

struct CandidateSample {
    SurfaceSample sample;
    double spacing;  // m
};

// Calls `add` for the points that divide the segment evenly into pieces of at most `spacing`. A tolerance of
// 0.1 % prevents an additional piece by rounding.
template <class AddPoint>
void divide(const Vec3& a, const Vec3& b, double spacing, const AddPoint& add) {
    const int pieces = static_cast<int>(std::ceil(glm::length(b - a) / spacing - 1e-3));
    for (int i = 1; i < pieces; ++i) add(glm::mix(a, b, static_cast<double>(i) / pieces));
}

void add_along_edges(const Solid& solid, const SampleOptions& options, std::vector<SurfaceSample>& out) {
    for (const Ridge& r : solid.ridges) {
        const SharpEdge& edge = solid.mesh.sharp_edges[r.sharp_edge];
        if (static_cast<double>(edge.angle) < sampled_edge_angle && !options.round) continue;
        divide(Vec3(r.ends[0]), Vec3(r.ends[1]), options.along_edges,
               [&](const Vec3& at) { out.push_back({.at = at, .triangle = edge.triangle}); });
    }
}

void add_vertex_candidates(const Solid& solid, double along_edges, std::vector<CandidateSample>& out) {
    const ContactMesh& mesh = solid.mesh;
    const std::vector<double> spacing = spacings(solid, along_edges);
    std::vector<std::uint32_t> triangle(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) triangle[v] = t;
    for (std::uint32_t v = 0; v < spacing.size(); ++v)
        if (spacing[v] < infinite_distance)
            out.push_back({{.at = Vec3(mesh.vertices[v]), .triangle = triangle[v]}, spacing[v]});
}

void add_round_edge_candidates(const Solid& solid, std::vector<CandidateSample>& out) {
    const ContactMesh& mesh = solid.mesh;
    for (const RoundEdge& edge : mesh.round_edges)
        divide(Vec3(mesh.vertices[edge.vertices[0]]), Vec3(mesh.vertices[edge.vertices[1]]),
               static_cast<double>(edge.spacing), [&](const Vec3& at) {
                   out.push_back({{.at = at, .triangle = edge.triangle}, static_cast<double>(edge.spacing)});
               });
}

// Adds the candidates in the order of their spacing. Drops a candidate if a sample lies within its spacing,
// rounded down to 8 mm / 2^k with k = 0 … 7; there is one grid for each k.
void add_spaced(std::vector<CandidateSample> candidates, std::vector<SurfaceSample>& out) {
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const CandidateSample& a, const CandidateSample& b) { return a.spacing < b.spacing; });
    constexpr int grids = 8;
    std::vector<PointGrid> cells;
    for (int i = 0; i < grids; ++i) cells.emplace_back(std::ldexp(8e-3, -i));
    for (const auto& [sample, spacing] : candidates) {
        const int level =
            spacing > 0.0 ? std::max(0, static_cast<int>(std::ceil(std::log2(8e-3 / spacing)))) : grids;
        if (level < grids && cells[static_cast<std::size_t>(level)].has_near(sample.at)) continue;
        // Grids of smaller spacing are not queried again.
        for (int i = 0; i <= std::min(level, grids - 1); ++i) {
            PointGrid& c = cells[static_cast<std::size_t>(i)];
            if (i == level || !c.has_near(sample.at)) c.add(sample.at);
        }
        out.push_back(sample);
    }
}

// Points spread over the surface with a minimum distance (Poisson disk sampling by dart throwing): random
// points are accepted if no accepted one is within `spacing`, which shrinks until there are `count`.
class PoissonSamples {
  public:
    PoissonSamples(const ContactMesh& mesh, std::size_t count) {
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
            random_.push_back({.at = a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v),
                               .triangle = static_cast<std::uint32_t>(t)});
        }
        for (double spacing = std::sqrt(area / static_cast<double>(count)); accepted_.size() < count;
             spacing *= 0.9)
            add(spacing, count);
    }
    [[nodiscard]] const std::vector<SurfaceSample>& accepted() const { return accepted_; }

  private:
    void add(double spacing, std::size_t count) {
        PointGrid cells(spacing);
        for (const SurfaceSample& s : accepted_) cells.add(s.at);
        for (const SurfaceSample& s : random_) {
            if (accepted_.size() == count) return;
            if (cells.has_near(s.at)) continue;
            accepted_.push_back(s);
            cells.add(s.at);
        }
    }

    std::vector<SurfaceSample> random_, accepted_;
};

// Builds the clusters of level 0 by recursive bisection: orders the samples along the longest side of their
// box and splits them at a whole number of clusters.
class ClusterBuilder {
  public:
    explicit ClusterBuilder(SurfaceSamples& result) : result_(result), order_(result.samples.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
    }

    // Builds the clusters and puts the samples into their order.
    void build() {
        split(0, order_.size());
        std::vector<SurfaceSample> ordered;
        ordered.reserve(order_.size());
        for (const std::uint32_t i : order_) ordered.push_back(result_.samples[i]);
        result_.samples = std::move(ordered);
    }

  private:
    [[nodiscard]] const SurfaceSample& sample(std::size_t place) const {
        return result_.samples[order_[place]];
    }
    [[nodiscard]] Vec3 half(const SurfaceSample& s) const {
        return s.piece == SurfaceSample::no_piece ? Vec3(0.0) : result_.pieces[s.piece].half;
    }
    // The order that a stable sort along each axis in turn would produce: by the last axis, then by the one
    // before it, and so on, and at last by index. It is total, so a split need not sort its halves.
    [[nodiscard]] bool before(std::uint32_t a, std::uint32_t b) const {
        const Vec3& at_a = result_.samples[a].at;
        const Vec3& at_b = result_.samples[b].at;
        for (std::size_t i = axes_.size(); i-- > 0;)
            if (at_a[axes_[i]] != at_b[axes_[i]]) return at_a[axes_[i]] < at_b[axes_[i]];
        return a < b;
    }
    void add_cluster(std::size_t begin, std::size_t end, const Vec3& middle) {
        const auto first = order_.begin();
        std::sort(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end),
                  [&](std::uint32_t a, std::uint32_t b) { return before(a, b); });
        SampleCluster one{middle, 0.0, 0.0, static_cast<std::uint32_t>(begin),
                          static_cast<std::uint32_t>(end)};
        for (std::size_t i = begin; i < end; ++i)
            for (const Vec3& p : {sample(i).at - half(sample(i)), sample(i).at + half(sample(i))}) {
                one.radius = std::max(one.radius, glm::length(p - one.middle));
                one.origin_radius = std::max(one.origin_radius, glm::length(p));
            }
        result_.levels[0].push_back(one);
    }
    void split(std::size_t begin, std::size_t end) {
        if (begin == end) return;
        Vec3 low(std::numeric_limits<double>::infinity());
        Vec3 high = -low;
        for (std::size_t i = begin; i < end; ++i) {
            low = glm::min(low, sample(i).at - glm::abs(half(sample(i))));
            high = glm::max(high, sample(i).at + glm::abs(half(sample(i))));
        }
        if (end - begin <= cluster_size) {
            add_cluster(begin, end, 0.5 * (low + high));
            return;
        }
        const Vec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t clusters = (end - begin + cluster_size - 1) / cluster_size;
        // The range is split at a multiple of `unit` samples: the size of a full cluster of the highest level
        // whose clusters are smaller than the range. The clusters of all levels then follow the bisection.
        std::size_t unit = cluster_size;
        while (clusters * cluster_size > unit * cluster_size) unit *= cluster_size;
        const std::size_t units = (end - begin + unit - 1) / unit;
        const std::size_t middle = begin + units / 2 * unit;
        axes_.push_back(axis);
        const auto first = order_.begin();
        std::nth_element(first + static_cast<std::ptrdiff_t>(begin),
                         first + static_cast<std::ptrdiff_t>(middle),
                         first + static_cast<std::ptrdiff_t>(end),
                         [&](std::uint32_t a, std::uint32_t b) { return before(a, b); });
        split(begin, middle);
        split(middle, end);
        axes_.pop_back();
    }

    SurfaceSamples& result_;
    std::vector<std::uint32_t> order_;  // of the samples
    std::vector<int> axes_;             // of the splits above the current range, the first split first
};

std::vector<SampleCluster> group_clusters(const std::vector<SampleCluster>& clusters) {
    std::vector<SampleCluster> groups;
    for (std::size_t begin = 0; begin < clusters.size(); begin += cluster_size) {
        const std::size_t end = std::min(clusters.size(), begin + cluster_size);
        Vec3 low(std::numeric_limits<double>::infinity());
        Vec3 high = -low;
        for (std::size_t i = begin; i < end; ++i) {
            low = glm::min(low, clusters[i].middle - clusters[i].radius);
            high = glm::max(high, clusters[i].middle + clusters[i].radius);
        }
        SampleCluster result{0.5 * (low + high), 0.0, 0.0, static_cast<std::uint32_t>(begin),
                             static_cast<std::uint32_t>(end)};
        for (std::size_t i = begin; i < end; ++i) {
            result.radius =
                std::max(result.radius, glm::length(clusters[i].middle - result.middle) + clusters[i].radius);
            result.origin_radius = std::max(result.origin_radius, clusters[i].origin_radius);
        }
        groups.push_back(result);
    }
    return groups;
}

}  // namespace

SurfaceSamples make_samples(const Solid& solid, const SampleOptions& options) {
    SurfaceSamples result;
    std::vector<CandidateSample> candidates;
    add_vertex_candidates(solid, options.along_edges, candidates);
    if (options.round) add_round_edge_candidates(solid, candidates);
    add_spaced(std::move(candidates), result.samples);
    add_along_edges(solid, options, result.samples);
    if (options.on_faces > 0) {
        const PoissonSamples points(solid.mesh, options.on_faces);
        result.samples.insert(result.samples.end(), points.accepted().begin(), points.accepted().end());
    }
    if (options.edges) add_edges(solid, options.max_piece, result);
    result.levels.emplace_back();
    ClusterBuilder(result).build();
    while (result.levels.back().size() > cluster_size)
        result.levels.push_back(group_clusters(result.levels.back()));
    return result;
}

}  // namespace bolt::collision
