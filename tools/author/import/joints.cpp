#include "tools/author/import/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "tools/author/import/metric_size.hpp"
#include "tools/author/import/placed_fasteners.hpp"

namespace bolt::step_import {

namespace {

constexpr double least_grip = 0.5 * mm;  // the least thickness of a member in an assembly file

// The nut on a bolt, or the part that the bolt is screwed into; a stud has both.
struct BoltEnd {
    std::optional<PlacedFastener> nut;
    std::optional<TappedPart> tapped;
    explicit operator bool() const { return nut || tapped; }
};

bool has_two_hexagons(const JointCandidate& joint) {
    return joint.nut >= 0 && joint.tapped < 0 && joint.head == joint::HeadShape::hexagon;
}

// Returns the seat of the head. The joint must be turned at its nut.
Vec3 head_seat(const JointCandidate& joint) { return joint.seat - joint.grip * joint.axis; }

void turn_at_head(JointCandidate& joint) {
    joint.seat = head_seat(joint);
    joint.axis = -joint.axis;
    joint.turned_at_head = true;
}

class JointFinder {
  public:
    JointFinder(const Tree& tree, const std::vector<PartGeometry>& parts) : tree_(tree), parts_(parts) {
        for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
            const int node = static_cast<int>(n);
            poses_.push_back(world(tree, node));
            const PartGeometry* part = part_of(node);
            if (part == nullptr || part->fastener.kind == FastenerKind::none) continue;
            of_kind_[part->fastener.kind].push_back(place(node, part->fastener, poses_.back()));
        }
    }

    JointSearchResult run() {
        for (const PlacedFastener& bolt : of_kind_[FastenerKind::bolt]) {
            BoltEnd end{nut_on(bolt), {}};
            if (!end.nut) end.tapped = tapped_part_of(bolt, bolt.low);
            const joint::FastenerSize* size = end ? metric_size_of(bolt) : nullptr;
            if (size == nullptr) {
                unused_bolts_.push_back({bolt, std::move(end)});
                continue;
            }
            if (end.nut) bolt_of_nut_[end.nut->node] = bolt.node;
            if (auto joint = make(bolt, end, *size)) search_.joints.push_back(std::move(*joint));
        }
        for (const PlacedFastener& stud : placed_of(FastenerKind::stud)) add_stud(stud);
        explain_unused();
        assign_ids();
        turn_at_head_where_groups_are();
        return std::move(search_);
    }

  private:
    const Tree& tree_;
    const std::vector<PartGeometry>& parts_;
    std::vector<ScaledPose> poses_;
    std::map<FastenerKind, std::vector<PlacedFastener>> of_kind_;
    JointSearchResult search_;
    std::map<int, int> bolt_of_nut_;  // nodes
    struct UnusedBolt {
        PlacedFastener bolt;
        // A bolt without an end is in no joint for that reason; one with an end, because its size is not
        // metric. For a stud: its nut, if any.
        BoltEnd end;
    };
    std::vector<UnusedBolt> unused_bolts_;

    const PartGeometry* part_of(int node) const {
        const int shape = tree_.nodes[static_cast<std::size_t>(node)].shape;
        if (shape < 0) return nullptr;
        return &parts_[static_cast<std::size_t>(tree_.shapes[static_cast<std::size_t>(shape)].part)];
    }

    std::optional<PlacedFastener> nut_on(const PlacedFastener& bolt) const {
        std::optional<PlacedFastener> best;
        double nearest = 0.0;
        for (const PlacedFastener& nut : placed_of(FastenerKind::nut)) {
            if (bolt_of_nut_.contains(nut.node) || !coaxial(bolt.origin, bolt.axis, nut.origin, nut.axis))
                continue;
            if (!nut_fits(bolt, nut)) continue;
            const auto [seat, top] = along(nut, bolt.origin, bolt.axis);
            if (seat < bolt.low || seat > bolt.high) continue;
            if (!best || seat < nearest) {  // of two locked nuts, the one at the members
                best = nut;
                nearest = seat;
            }
        }
        return best;
    }

    // Adds the joint of a stud, whose nut may be at either end.
    void add_stud(const PlacedFastener& stud) {
        const joint::FastenerSize* size = metric_size_of(stud);
        if (size == nullptr) return;  // an instance that CAD has scaled
        std::optional<PlacedFastener> nut;
        for (const PlacedFastener& towards_nut : {stud, reversed(stud)}) {
            const auto found = nut_on(towards_nut);
            if (!found) continue;
            nut = found;
            PlacedFastener from_nut = reversed(towards_nut);
            const double face = along(*nut, from_nut.origin, from_nut.axis).second;
            const BoltEnd ends{nut, tapped_part_of(from_nut, face)};
            if (!ends.tapped) continue;
            bolt_of_nut_[nut->node] = stud.node;
            if (auto joint = make(from_nut, ends, *size)) search_.joints.push_back(std::move(*joint));
            return;
        }
        // Pins and shafts look like studs too.
        if (nut || named_like_fastener(name_of(stud.node))) unused_bolts_.push_back({stud, {nut, {}}});
    }

    const std::vector<PlacedFastener>& placed_of(FastenerKind kind) const {
        static const std::vector<PlacedFastener> no_fasteners;
        const auto found = of_kind_.find(kind);
        return found == of_kind_.end() ? no_fasteners : found->second;
    }

    const std::string& name_of(int node) const { return tree_.nodes[static_cast<std::size_t>(node)].name; }

    // Adds a remark for each part that is or resembles a bolt or a nut and is in no joint.
    void explain_unused() {
        const std::size_t before = search_.remarks.size();
        std::set<int> explained;  // nuts
        for (const UnusedBolt& unused : unused_bolts_) {
            const PlacedFastener& bolt = unused.bolt;
            search_.remarks.push_back(fmt::format("{}: {}, but {}", name_of(bolt.node), describe(bolt),
                                                  bolt.kind == FastenerKind::stud ? explain_stud(unused.end)
                                                  : unused.end                    ? explain_metric_size(bolt)
                                                               : explain_missing_nut(bolt)));
            if (unused.end.nut) explained.insert(unused.end.nut->node);
        }
        for (const PlacedFastener& nut : placed_of(FastenerKind::nut))
            if (!bolt_of_nut_.contains(nut.node) && !explained.contains(nut.node))
                search_.remarks.push_back(fmt::format(
                    "{}: looks like a nut (hole {:.2f} mm, hexagon {:.2f} mm across flats), but {}",
                    name_of(nut.node), nut.diameter / mm, nut.across_flats / mm, explain_missing_bolt(nut)));
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) explain_rejected(static_cast<int>(n));
        if (search_.joints.empty() && search_.remarks.size() == before)
            search_.remarks.push_back(
                "no part resembles a bolt or a nut; expected parts with a hexagon 5 to 65 mm across flats, "
                "or a head with a hexagonal socket, each bolt and nut a part of its own");
        else if (search_.remarks.size() > before)
            search_.remarks.push_back(
                "correct the parts above in CAD and import again, or write their joints into assembly.json "
                "by hand (content/AUTHORING.md)");
    }

    std::string explain_stud(const BoltEnd& end) const {
        if (!end.nut)
            return "no nut is on it; expected a nut of its size, coaxial with it, and a tapped hole around "
                   "its other end";
        return fmt::format(
            "its end without the nut {} is in no tapped hole; expected a hole as wide as its thread or its "
            "core around it. A rod with a nut at each end is no joint form: draw a bolt with a head",
            name_of(end.nut->node));
    }

    std::string explain_missing_nut(const PlacedFastener& bolt) const {
        const PlacedFastener* nearest = nullptr;
        double distance = 0.0;
        for (const PlacedFastener& nut : placed_of(FastenerKind::nut)) {
            const double off = distance_from_axis(bolt, nut.origin);
            if (nearest == nullptr || off < distance) {
                nearest = &nut;
                distance = off;
            }
        }
        if (nearest == nullptr)
            return "the file has no part with the shape of a nut, and no part has a tapped hole around its "
                   "end; expected a nut (a hexagon with a hole) on its axis, or a hole as wide as its thread "
                   "or its core in the part that it is screwed into";
        const std::string& name = name_of(nearest->node);
        const double cosine = std::min(std::abs(glm::dot(bolt.axis, nearest->axis)), 1.0);
        if (!coaxial(bolt.origin, bolt.axis, nearest->origin, nearest->axis))
            return fmt::format(
                "no nut is coaxial with it: the nearest one, {}, is {:.2f} mm off its axis and {:.2f} "
                "degrees turned from it; expected at most {:g} mm and 0.5 degrees",
                name, distance / mm, to_degrees(std::acos(cosine)), coaxial_distance / mm);
        if (const auto used = bolt_of_nut_.find(nearest->node); used != bolt_of_nut_.end())
            return fmt::format(
                "the nut on its axis, {}, is already that of the bolt {}; expected a nut of its own", name,
                name_of(used->second));
        if (!nut_fits(bolt, *nearest) && bolt.cap)
            return fmt::format(
                "the nut on its axis, {}, is {:.2f} mm across flats; expected a nut for its thread", name,
                nearest->across_flats / mm);
        if (!nut_fits(bolt, *nearest))
            return fmt::format(
                "the nut on its axis, {}, is {:.2f} mm across flats; expected the bolt's width within {:g} "
                "mm",
                name, nearest->across_flats / mm, width_tolerance / mm);
        const double seat = along(*nearest, bolt.origin, bolt.axis).first;
        return fmt::format(
            "the nut on its axis, {}, begins {:.2f} mm from the bearing face of the head, and the shank is "
            "{:.2f} mm long; expected the nut on the shank",
            name, (seat - bolt.low) / mm, (bolt.high - bolt.low) / mm);
    }

    std::string explain_missing_bolt(const PlacedFastener& nut) const {
        const PlacedFastener* nearest = nullptr;
        double distance = 0.0;
        for (const PlacedFastener& bolt : placed_of(FastenerKind::bolt)) {
            const double off = distance_from_axis(bolt, nut.origin);
            if (nearest == nullptr || off < distance) {
                nearest = &bolt;
                distance = off;
            }
        }
        if (nearest == nullptr)
            return "the file has no part with the shape of a bolt; expected a bolt (a hexagon, or a head "
                   "with a socket, and a cylinder) on its axis";
        return fmt::format(
            "no bolt is paired with it: the nearest one, {}, has its axis {:.2f} mm away; expected a bolt of "
            "the same width across flats, or a cap screw of its thread, within {:g} mm of its axis",
            name_of(nearest->node), distance / mm, coaxial_distance / mm);
    }

    void explain_rejected(int node) {
        const PartGeometry* part = part_of(node);
        if (part == nullptr || part->fastener.kind != FastenerKind::none) return;
        const FastenerShape& shape = part->fastener;
        if (!shape.rejection.empty())
            search_.remarks.push_back(fmt::format("{}: {}", name_of(node), shape.rejection));
        else if (!shape.without_hexagon.empty() && named_like_fastener(name_of(node)))
            search_.remarks.push_back(fmt::format("{}: is named like a bolt or a nut, but {}", name_of(node),
                                                  shape.without_hexagon));
    }

    // Returns the washers stacked from the height `face` in `direction` (+1: along the axis, −1: against it).
    // Moves `face` to the far side of the last one.
    std::vector<int> washers_from(const PlacedFastener& bolt, double& face, double direction) {
        std::vector<int> found;
        for (bool more = true; more;) {
            more = false;
            for (const PlacedFastener& washer : of_kind_[FastenerKind::washer]) {
                if (std::find(found.begin(), found.end(), washer.node) != found.end()) continue;
                if (!coaxial(bolt.origin, bolt.axis, washer.origin, washer.axis)) continue;
                if (washer.diameter < 0.98 * bolt.diameter || washer.diameter > 1.3 * bolt.diameter) continue;
                const auto [low, high] = along(washer, bolt.origin, bolt.axis);
                const double near = direction > 0.0 ? low : high;
                if (std::abs(near - face) > touching) continue;
                face = direction > 0.0 ? high : low;
                found.push_back(washer.node);
                more = true;
                break;
            }
        }
        return found;
    }

    // Returns nullopt after a remark if the bolt clamps nothing.
    std::optional<JointCandidate> make(const PlacedFastener& bolt, const BoltEnd& end,
                                       const joint::FastenerSize& size) {
        JointCandidate joint;
        joint.bolt = bolt.node;
        joint.head = bolt.cap ? joint::HeadShape::socket : joint::HeadShape::hexagon;
        joint.thread_direction = bolt.drawn_thread.value_or(joint::ThreadDirection::right);
        if (end.nut) joint.nut = end.nut->node;
        if (end.tapped) joint.tapped = end.tapped->node;
        joint.size = thread_name(size, end.nut ? end.nut->diameter : end.tapped->hole);
        const auto nut_faces = end.nut ? along(*end.nut, bolt.origin, bolt.axis) : std::pair(0.0, 0.0);
        double head = joint.is_stud() ? nut_faces.second : bolt.low;
        double far = end.tapped ? end.tapped->face : nut_faces.first;
        (joint.is_stud() ? joint.nut_washers : joint.head_washers) = washers_from(bolt, head, 1.0);
        if (!end.tapped) joint.nut_washers = washers_from(bolt, far, -1.0);
        joint.bolt_length = (joint.is_stud() ? far : bolt.high) - bolt.low;
        // A screw that does not reach through the part engages with its whole end.
        if (end.tapped && (joint.is_stud() || bolt.high > end.tapped->bottom))
            joint.engagement = std::min(bolt.high, end.tapped->bottom) - far;
        joint.grip = far - head;
        const bool turned_at_head = joint.turns_head() || joint.is_stud();  // of a stud: its nut is there
        joint.axis = turned_at_head ? -bolt.axis : bolt.axis;
        joint.seat = bolt.origin + (turned_at_head ? head : far) * bolt.axis;
        if (joint.grip < least_grip) {
            add_remark(joint, fmt::format(
                                  "clamps nothing: {:.2f} mm are between its {} and {}; expected parts of at "
                                  "least {:g} mm between them",
                                  joint.grip / mm, joint.is_stud() ? "nut" : "head",
                                  name_of(end.tapped ? joint.tapped : joint.nut), least_grip / mm));
            return std::nullopt;
        }
        find_members_of(bolt, joint, head, far);
        if (joint.is_stud()) std::reverse(joint.members.begin(), joint.members.end());
        joint.group = group_of(joint);
        if (end.tapped && end.tapped->nominal)
            add_remark(joint,
                       fmt::format("the hole in {} is as wide as the thread; it is taken for a tapped hole",
                                   name_of(joint.tapped)));
        return joint;
    }

    // `head`: height under the head, or under the nut of a stud.
    std::optional<TappedPart> tapped_part_of(const PlacedFastener& bolt, double head) const {
        std::vector<const PartGeometry*> parts;
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) {
            parts.push_back(part_of(static_cast<int>(n)));
            if (parts.back() != nullptr && parts.back()->fastener.kind != FastenerKind::none)
                parts.back() = nullptr;
        }
        return find_tapped_part(parts, poses_, {bolt.origin, bolt.axis, bolt.diameter, head, bolt.high});
    }

    // Finds the members between the heights `head` and `far`, and remarks on a gap.
    void find_members_of(const PlacedFastener& bolt, JointCandidate& joint, double head, double far) {
        const char* const end = joint.tapped >= 0 ? "tapped part" : "nut";
        const char* const head_name = joint.is_stud() ? "nut" : "head";
        joint.members = members_of(bolt, joint, head, far);
        double sum = 0.0;
        for (const ClampedMember& member : joint.members) sum += member.thickness;
        if (joint.members.empty()) {
            joint.members.push_back({-1, joint.grip});
            add_remark(
                joint,
                fmt::format("no part with a hole was found between {} and {}: one member fills the grip",
                            head_name, end));
        } else if (std::abs(sum - joint.grip) > 0.02 * mm) {
            add_remark(joint, fmt::format("the parts between {0} and {1} are {2:.2f} mm thick; expected "
                                          "{3:.2f} mm, the distance from {0} to {1}",
                                          head_name, end, sum / mm, joint.grip / mm));
        }
    }

    std::vector<ClampedMember> members_of(const PlacedFastener& bolt, const JointCandidate& joint,
                                          double head, double far) const {
        std::vector<const PartGeometry*> parts;
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) parts.push_back(part_of(static_cast<int>(n)));
        for (const auto& list :
             {joint.head_washers, joint.nut_washers, std::vector{joint.bolt, joint.nut, joint.tapped}})
            for (const int node : list)
                if (node >= 0) parts[static_cast<std::size_t>(node)] = nullptr;
        return find_members(parts, poses_, {bolt.origin, bolt.axis, bolt.diameter, head, far});
    }

    void add_remark(const JointCandidate& joint, const std::string& what) {
        search_.remarks.push_back(
            fmt::format("{}: {}", tree_.nodes[static_cast<std::size_t>(joint.bolt)].name, what));
    }

    // Returns the node of a group joint_ID in the file around this joint; −1 if there is none.
    int group_of(const JointCandidate& joint) const {
        const auto name = [&](int node) -> const std::string& {
            return tree_.nodes[static_cast<std::size_t>(node)].name;
        };
        for (int up = common_parent(tree_, joint.bolt, joint.is_screw() ? joint.bolt : joint.nut); up >= 0;
             up = tree_.nodes[static_cast<std::size_t>(up)].parent)
            if (name(up).starts_with(joint_prefix) && name(up).size() > joint_prefix.size()) return up;
        return -1;
    }

    // Takes the id of a joint from its group; numbers the others by position: x, then z, then y, rounded to 1
    // mm.
    void assign_ids() {
        std::map<int, int> members;
        for (const JointCandidate& joint : search_.joints)
            if (joint.group >= 0) ++members[joint.group];
        std::set<std::string> taken;
        for (JointCandidate& joint : search_.joints) {
            if (joint.group >= 0 && members[joint.group] > 1)
                joint.group = -1;  // the group holds several joints
            if (joint.group < 0) continue;
            joint.id = tree_.nodes[static_cast<std::size_t>(joint.group)].name.substr(joint_prefix.size());
            if (!taken.insert(joint.id).second) joint.group = -1;
        }
        const auto key = [](const JointCandidate& joint) {
            return std::array{std::lround(joint.seat.x / mm), std::lround(joint.seat.z / mm),
                              std::lround(joint.seat.y / mm)};
        };
        std::stable_sort(search_.joints.begin(), search_.joints.end(),
                         [&](const JointCandidate& a, const JointCandidate& b) { return key(a) < key(b); });
        int next = 1;
        for (JointCandidate& joint : search_.joints) {
            if (joint.group >= 0) continue;
            do joint.id = fmt::format("J{}", next++);
            while (!taken.insert(joint.id).second);
        }
        std::stable_sort(search_.joints.begin(), search_.joints.end(),
                         [](const JointCandidate& a, const JointCandidate& b) {
                             return std::pair(a.id.size(), a.id) < std::pair(b.id.size(), b.id);
                         });
    }

    // Where a group's origin is on the seat of the head, the author means to turn the head.
    void turn_at_head_where_groups_are() {
        for (JointCandidate& joint : search_.joints) {
            if (joint.group < 0 || !has_two_hexagons(joint)) continue;
            const Vec3& origin = poses_[static_cast<std::size_t>(joint.group)].position;
            if (glm::distance(origin, head_seat(joint)) < glm::distance(origin, joint.seat))
                turn_at_head(joint);
        }
    }
};

}  // namespace

Status turn_at_heads(JointSearchResult& search, std::span<const std::string> ids) {
    for (const std::string& id : ids) {
        bool found = false;
        for (JointCandidate& joint : search.joints) {
            if (id != "all" && id != joint.id) continue;
            const bool possible = has_two_hexagons(joint) && !joint.turned_at_head;
            found = found || possible || joint.turns_head();
            if (possible) turn_at_head(joint);
        }
        if (found || id == "all") continue;
        std::string possible;
        for (const JointCandidate& joint : search.joints)
            if (has_two_hexagons(joint)) possible += (possible.empty() ? "" : ", ") + joint.id;
        return fail(ErrorCode::usage,
                    fmt::format("--turn-heads: no hexagon bolt with a nut is a joint {}", id),
                    possible.empty() ? "no such option: the file has no hexagon bolt with a nut"
                                     : fmt::format("one of {}, or all", possible));
    }
    return {};
}

JointSearchResult find_joints(const Tree& tree, const std::vector<PartGeometry>& parts) {
    return JointFinder(tree, parts).run();
}

}  // namespace bolt::step_import
