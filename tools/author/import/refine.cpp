#include "tools/author/import/refine.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace bolt::step_import {

namespace {

using Side = std::pair<std::uint32_t, std::uint32_t>;
using Triangle = std::array<std::uint32_t, 3>;

constexpr int most_passes = 6;  // each takes three quarters of the deviation away

Side side(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

class Refiner {
  public:
    Refiner(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection)
        : surface_(surface), corners_(corners), triangles_(triangles), deflection_(deflection) {}

    bool pass() {
        uses_.clear();
        split_.clear();
        for (const Triangle& t : triangles_)
            for (std::size_t k = 0; k < 3; ++k) ++uses_[side(t[k], t[(k + 1) % 3])];
        for (const auto& [ab, count] : uses_)
            if (count == 2 && side_is_off(ab)) mark(ab);
        std::vector<bool> centre(triangles_.size(), false);
        bool any = !split_.empty();
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const Triangle t = triangles_[i];
            if (is_marked(t) || !middle_is_off(t)) continue;
            any = true;
            if (!mark_longest(t)) centre[i] = true;
        }
        if (any) rebuild(centre);
        return any;
    }

  private:
    FaceSurface& surface_;
    std::vector<Vec3>& corners_;
    Triangles& triangles_;
    double deflection_;
    std::map<Side, int> uses_;
    std::map<Side, std::uint32_t> split_;  // the new corner in the middle

    bool side_is_off(const Side& ab) const {
        const Vec3 chord = 0.5 * (corners_[ab.first] + corners_[ab.second]);
        return surface_.distance(surface_.middle(ab.first, ab.second), chord) > deflection_;
    }

    bool middle_is_off(const Triangle& t) const {
        const Vec3 middle = (corners_[t[0]] + corners_[t[1]] + corners_[t[2]]) / 3.0;
        return surface_.distance(surface_.middle(t[0], t[1], t[2]), middle) > deflection_;
    }

    bool is_marked(const Triangle& t) const {
        return split_.contains(side(t[0], t[1])) || split_.contains(side(t[1], t[2])) ||
               split_.contains(side(t[2], t[0]));
    }

    std::uint32_t add(const gp_XY& uv) {
        surface_.add(uv);
        corners_.push_back(surface_.point(uv));
        return static_cast<std::uint32_t>(corners_.size() - 1);
    }

    void mark(const Side& ab) { split_[ab] = add(surface_.middle(ab.first, ab.second)); }

    bool mark_longest(const Triangle& t) {
        Side longest{0, 0};
        double most = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Side ab = side(t[k], t[(k + 1) % 3]);
            const double length = glm::length(corners_[ab.first] - corners_[ab.second]);
            if (uses_[ab] != 2 || length <= most) continue;
            longest = ab;
            most = length;
        }
        if (most > 0.0) mark(longest);
        return most > 0.0;
    }

    void rebuild(const std::vector<bool>& centre) {
        const Triangles old = std::exchange(triangles_, {});
        for (std::size_t i = 0; i < old.size(); ++i) {
            const Triangle& t = old[i];
            if (centre[i]) {
                const std::uint32_t m = add(surface_.middle(t[0], t[1], t[2]));
                for (std::size_t k = 0; k < 3; ++k) triangles_.push_back({t[k], t[(k + 1) % 3], m});
            } else {
                divide(t);
            }
        }
    }

    // Cuts off one split side after the other; what is left is split no more.
    void divide(const Triangle& t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
            const auto found = split_.find(side(a, b));
            if (found == split_.end()) continue;
            divide({a, found->second, c});
            divide({found->second, b, c});
            return;
        }
        triangles_.push_back(t);
    }
};

}  // namespace

void refine(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection) {
    if (surface.flat()) return;
    Refiner refiner(surface, corners, triangles, deflection);
    for (int i = 0; i < most_passes && refiner.pass(); ++i) {
    }
}

double deviation(const FaceSurface& surface, const std::vector<Vec3>& corners, const Triangles& triangles) {
    if (surface.flat()) return 0.0;
    double largest = 0.0;
    for (const auto& [a, b, c] : triangles) {
        const Vec3 middle = (corners[a] + corners[b] + corners[c]) / 3.0;
        largest = std::max(largest, surface.distance(surface.middle(a, b, c), middle));
        for (const auto& [i, k] : {Side{a, b}, Side{b, c}, Side{c, a}})
            largest =
                std::max(largest, surface.distance(surface.middle(i, k), 0.5 * (corners[i] + corners[k])));
    }
    return largest;
}

}  // namespace bolt::step_import
