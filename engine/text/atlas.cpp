#include "engine/text/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

namespace bolt::text {

namespace {

struct Edge {
    glm::dvec2 a{0.0}, b{0.0};
};

std::vector<Edge> edges_of(const GlyphOutline& outline) {
    std::vector<Edge> edges;
    for (const auto& ring : outline)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2& next = ring[(i + 1) % ring.size()];
            if (ring[i] != next) edges.push_back({ring[i], next});
        }
    return edges;
}

// Returns the direction in which an edge crosses height y: 1 up, -1 down, 0 not at all. Sets `x` to the
// position of the crossing. The edge is half-open, so that a vertex that two edges share counts once.
int crossing(const Edge& edge, double y, double& x) {
    if ((edge.a.y <= y) == (edge.b.y <= y)) return 0;
    x = edge.a.x + (y - edge.a.y) / (edge.b.y - edge.a.y) * (edge.b.x - edge.a.x);
    return edge.b.y > edge.a.y ? 1 : -1;
}

// Edges sorted into rows of height `step`, so that a query visits only those that may cross its height.
class EdgesByHeight {
  public:
    EdgesByHeight(const std::vector<Edge>& edges, double low, double high, double step)
        : low_(low), step_(step), rows_(static_cast<std::size_t>((high - low) / step) + 1) {
        for (const Edge& edge : edges) {
            const std::size_t last = row(std::max(edge.a.y, edge.b.y));
            for (std::size_t i = row(std::min(edge.a.y, edge.b.y)); i <= last; ++i) rows_[i].push_back(edge);
        }
    }

    [[nodiscard]] const std::vector<Edge>& near(double y) const { return rows_[row(y)]; }

    // Returns the winding number of the outline around a point.
    [[nodiscard]] int winding(const glm::dvec2& p) const {
        int sum = 0;
        double x = 0.0;
        for (const Edge& edge : near(p.y))
            if (const int direction = crossing(edge, p.y, x); direction != 0 && x > p.x) sum += direction;
        return sum;
    }

  private:
    [[nodiscard]] std::size_t row(double y) const {
        return static_cast<std::size_t>(
            std::clamp((y - low_) / step_, 0.0, static_cast<double>(rows_.size() - 1)));
    }

    double low_, step_;
    std::vector<std::vector<Edge>> rows_;
};

// Cuts edges into pieces of at most `step` and keeps the pieces that have exactly one side filled. Strokes of
// a glyph may overlap, as in Chinese fonts, and edges inside their union are not part of the boundary.
std::vector<Edge> boundary_pieces(const std::vector<Edge>& edges, const EdgesByHeight& by_height,
                                  double step) {
    std::vector<Edge> pieces;
    for (const Edge& edge : edges) {
        const double length = glm::distance(edge.a, edge.b);
        const int n = std::max(1, static_cast<int>(std::ceil(length / step)));
        const glm::dvec2 along = (edge.b - edge.a) / length;
        const glm::dvec2 aside = 0.02 * step * glm::dvec2(-along.y, along.x);
        for (int i = 0; i < n; ++i) {
            const Edge piece{glm::mix(edge.a, edge.b, static_cast<double>(i) / n),
                             glm::mix(edge.a, edge.b, (i + 1.0) / n)};
            const glm::dvec2 middle = 0.5 * (piece.a + piece.b);
            if ((by_height.winding(middle + aside) != 0) != (by_height.winding(middle - aside) != 0))
                pieces.push_back(piece);
        }
    }
    return pieces;
}

double distance_squared(const Edge& edge, const glm::dvec2& p) {
    const glm::dvec2 along = edge.b - edge.a;
    const double t = std::clamp(glm::dot(p - edge.a, along) / glm::dot(along, along), 0.0, 1.0);
    const glm::dvec2 d = p - (edge.a + t * along);
    return glm::dot(d, d);
}

// Returns the indices of the first and the last of `count` rows or columns whose centres are between `low`
// and `high`.
std::pair<int, int> centres_between(double low, double high, int count) {
    return {std::max(0, static_cast<int>(std::ceil(low - 0.5))),
            std::min(count - 1, static_cast<int>(std::floor(high - 0.5)))};
}

}  // namespace

DistanceField distance_field(const GlyphOutline& outline, double texels_per_em, double reach) {
    const std::vector<Edge> edges = edges_of(outline);
    if (edges.empty()) return {};
    glm::dvec2 low = edges.front().a, high = low;
    for (const Edge& edge : edges) {
        low = glm::min(low, edge.a);
        high = glm::max(high, edge.a);
    }
    DistanceField field;
    const double texel = 1.0 / texels_per_em;
    field.low = glm::floor((low - reach) * texels_per_em) * texel;
    field.width = static_cast<int>(std::ceil((high.x + reach - field.low.x) * texels_per_em));
    field.height = static_cast<int>(std::ceil((high.y + reach - field.low.y) * texels_per_em));
    const auto width = static_cast<std::size_t>(field.width);
    std::vector<double> nearest(width * static_cast<std::size_t>(field.height), reach * reach);
    const EdgesByHeight by_height(edges, low.y, high.y, texel);
    for (const Edge& piece : boundary_pieces(edges, by_height, texel)) {
        const glm::dvec2 from = (glm::min(piece.a, piece.b) - reach - field.low) * texels_per_em,
                         to = (glm::max(piece.a, piece.b) + reach - field.low) * texels_per_em;
        const auto [left, right] = centres_between(from.x, to.x, field.width);
        const auto [below, above] = centres_between(from.y, to.y, field.height);
        for (int y = below; y <= above; ++y)
            for (int x = left; x <= right; ++x) {
                double& least = nearest[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
                least = std::min(least,
                                 distance_squared(piece, field.low + texel * glm::dvec2(x + 0.5, y + 0.5)));
            }
    }
    field.distances.resize(nearest.size());
    std::vector<std::pair<double, int>> crossings;  // in one row
    for (int y = 0; y < field.height; ++y) {
        crossings.clear();
        double x = 0.0;
        const double height = field.low.y + texel * (y + 0.5);
        for (const Edge& edge : by_height.near(height))
            if (const int direction = crossing(edge, height, x); direction != 0)
                crossings.emplace_back(x, direction);
        std::sort(crossings.begin(), crossings.end());
        auto next = crossings.begin();
        int inside = 0;
        for (std::size_t column = 0; column < width; ++column) {
            const double middle = field.low.x + texel * (static_cast<double>(column) + 0.5);
            for (; next != crossings.end() && next->first <= middle; ++next) inside += next->second;
            const std::size_t at = static_cast<std::size_t>(y) * width + column;
            const double distance = std::sqrt(nearest[at]);
            field.distances[at] = static_cast<float>(inside != 0 ? distance : -distance);
        }
    }
    return field;
}

namespace {

// Tolerance for flattened curves, em: well below the size of a texel.
constexpr double tolerance = 0.02 / Atlas::texels_per_em;

}  // namespace

// Texels without a glyph get the largest outside distance, because small text samples slightly beyond its
// glyphs.
Atlas::Atlas(int size)
    : size_(size),
      texels_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size),
              glm::packHalf1x16(static_cast<float>(-reach))),
      changed_high_(size) {}

const AtlasGlyph* Atlas::glyph(const Fonts& fonts, const GlyphId& id) {
    if (const auto known = glyphs_.find(id); known != glyphs_.end()) return &known->second;
    const FontFace& face = fonts.faces.at(static_cast<std::size_t>(id.face));
    const DistanceField field = distance_field(face.outline(id.glyph, tolerance), texels_per_em, reach);
    if (field.width == 0) return &glyphs_.emplace(id, AtlasGlyph{}).first->second;
    if (next_ + field.width > size_) {
        shelf_ += shelf_height_;
        shelf_height_ = next_ = 0;
    }
    if (field.width > size_ || shelf_ + field.height > size_) return nullptr;
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x)
            texels_[static_cast<std::size_t>((shelf_ + y) * size_ + next_ + x)] =
                glm::packHalf1x16(field.distances[static_cast<std::size_t>(y * field.width + x)]);
    // Neighbouring fields touch, so the sampled area ends half a texel inside.
    const auto uv = [&](double x, double y) { return glm::vec2((next_ + x) / size_, (shelf_ + y) / size_); };
    const auto em = [&](double x, double y) {
        return glm::vec2(field.low + glm::dvec2(x, y) / texels_per_em);
    };
    const AtlasGlyph glyph{em(0.5, 0.5), em(field.width - 0.5, field.height - 0.5), uv(0.5, 0.5),
                           uv(field.width - 0.5, field.height - 0.5)};
    changed_low_ = changed_high_ == 0 ? shelf_ : std::min(changed_low_, shelf_);
    changed_high_ = std::max(changed_high_, shelf_ + field.height);
    next_ += field.width;
    shelf_height_ = std::max(shelf_height_, field.height);
    return &glyphs_.emplace(id, glyph).first->second;
}

Atlas::RowRange Atlas::take_changed_rows() {
    const RowRange rows{changed_low_, changed_high_ - changed_low_};
    changed_low_ = changed_high_ = 0;
    return rows;
}

}  // namespace bolt::text
