#include "tools/import/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "haptics/joint/fastener.hpp"

namespace bolt::step_import {

namespace {

constexpr double touching = 0.06 * mm;
constexpr std::string_view joint_prefix = "joint_";

struct Placed {
    int node = -1;
    const FastenerShape* shape = nullptr;
    Vec3 origin, axis;
    double scale = 1.0;
};

// Heights of a nut's or washer's faces along another axis.
std::pair<double, double> along(const Placed& placed, const Vec3& origin, const Vec3& axis) {
    const auto height = [&](double h) {
        return glm::dot(placed.origin + h * placed.scale * placed.axis - origin, axis);
    };
    const double a = height(placed.shape->low), b = height(placed.shape->high);
    return {std::min(a, b), std::max(a, b)};
}

// Row of the ISO table: by the thread's crests, and the flats must belong to it (or to the old DIN 934
// widths).
const joint::FastenerSize* size_of(const FastenerShape& bolt) {
    const joint::FastenerSize* best = nullptr;
    for (const joint::FastenerSize& size : joint::fastener_sizes())
        if (best == nullptr || std::abs(size.d - bolt.diameter) < std::abs(best->d - bolt.diameter))
            best = &size;
    if (best == nullptr || std::abs(best->d - bolt.diameter) > std::max(0.35 * mm, 0.04 * best->d))
        return nullptr;
    double old = best->across_flats;
    if (best->name == "M10") old = 17.0 * mm;
    if (best->name == "M12") old = 19.0 * mm;
    if (best->name == "M14") old = 22.0 * mm;
    if (best->name == "M22") old = 32.0 * mm;
    const auto fits = [&](double flats) { return std::abs(bolt.across_flats - flats) < 0.5 * mm; };
    return fits(best->across_flats) || fits(old) ? best : nullptr;
}

// The pitch shows in the nut's hole where its thread is modelled: D1 = d − 1.0825 P (ISO 68-1). Else coarse.
std::string thread_name(const joint::FastenerSize& size, double hole) {
    const auto off = [&](double pitch) { return std::abs(size.d - 1.0825 * pitch - hole); };
    double best = size.coarse_pitch;
    for (const double fine : size.fine_pitches)
        if (fine > 0.0 && off(fine) < 0.1 * mm && off(fine) + 0.1 * mm < off(best)) best = fine;
    return best == size.coarse_pitch ? std::string(size.name)
                                     : fmt::format("{}x{:g}", size.name, std::round(best / mm * 1e3) / 1e3);
}

class Finder {
  public:
    Finder(const Tree& tree, const std::vector<PartGeometry>& parts) : tree_(tree), parts_(parts) {
        for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
            const int node = static_cast<int>(n);
            poses_.push_back(world(tree, node));
            const PartGeometry* part = part_of(node);
            if (part == nullptr || part->fastener.kind == FastenerKind::none) continue;
            const Pose& pose = poses_.back();
            Placed placed{node, &part->fastener, pose.point(part->fastener.origin),
                          pose.direction(part->fastener.axis), std::abs(pose.scale)};
            of_kind_[part->fastener.kind].push_back(placed);
        }
    }

    JointSearch run() {
        std::set<int> nuts_used;
        for (const Placed& bolt : of_kind_[FastenerKind::bolt]) {
            const auto nut = nut_on(bolt, nuts_used);
            const joint::FastenerSize* size = nut ? size_of(*bolt.shape) : nullptr;
            if (size == nullptr) {
                ++search_.bolts_alone;
                continue;
            }
            nuts_used.insert(nut->node);
            search_.joints.push_back(make(bolt, *nut, *size));
        }
        search_.nuts_alone = of_kind_[FastenerKind::nut].size() - nuts_used.size();
        number();
        return std::move(search_);
    }

  private:
    const Tree& tree_;
    const std::vector<PartGeometry>& parts_;
    std::vector<Pose> poses_;
    std::map<FastenerKind, std::vector<Placed>> of_kind_;
    JointSearch search_;

    const PartGeometry* part_of(int node) const {
        const int shape = tree_.nodes[static_cast<std::size_t>(node)].shape;
        if (shape < 0) return nullptr;
        return &parts_[static_cast<std::size_t>(tree_.shapes[static_cast<std::size_t>(shape)].part)];
    }

    std::optional<Placed> nut_on(const Placed& bolt, const std::set<int>& used) {
        std::optional<Placed> best;
        double nearest = 0.0;
        const double low = bolt.shape->low * bolt.scale, high = bolt.shape->high * bolt.scale;
        for (const Placed& nut : of_kind_[FastenerKind::nut]) {
            if (used.contains(nut.node) || !coaxial(bolt.origin, bolt.axis, nut.origin, nut.axis)) continue;
            if (std::abs(nut.shape->across_flats - bolt.shape->across_flats) > 0.5 * mm) continue;
            const auto [seat, top] = along(nut, bolt.origin, bolt.axis);
            if (seat < low || seat > high) continue;
            if (!best || seat < nearest) {  // of two nuts locked against each other, the one that bears
                best = nut;
                nearest = seat;
            }
        }
        return best;
    }

    // Washers stacked from `face` in the direction `way` (+1: along the axis); moves `face` to the last one's
    // far side.
    std::vector<int> washers_from(const Placed& bolt, double& face, double way) {
        std::vector<int> found;
        for (bool more = true; more;) {
            more = false;
            for (const Placed& washer : of_kind_[FastenerKind::washer]) {
                if (std::find(found.begin(), found.end(), washer.node) != found.end()) continue;
                if (!coaxial(bolt.origin, bolt.axis, washer.origin, washer.axis)) continue;
                const double hole = washer.shape->diameter * washer.scale, d = bolt.shape->diameter;
                if (hole < 0.98 * d || hole > 1.3 * d) continue;
                const auto [low, high] = along(washer, bolt.origin, bolt.axis);
                const double near = way > 0.0 ? low : high;
                if (std::abs(near - face) > touching) continue;
                face = way > 0.0 ? high : low;
                found.push_back(washer.node);
                more = true;
                break;
            }
        }
        return found;
    }

    JointCandidate make(const Placed& bolt, const Placed& nut, const joint::FastenerSize& size) {
        JointCandidate joint;
        joint.bolt = bolt.node;
        joint.nut = nut.node;
        joint.axis = bolt.axis;
        joint.size = thread_name(size, nut.shape->diameter);
        double head = bolt.shape->low * bolt.scale;
        double seat = along(nut, bolt.origin, bolt.axis).first;
        joint.bolt_length = bolt.shape->high * bolt.scale - head;
        joint.head_washers = washers_from(bolt, head, 1.0);
        joint.nut_washers = washers_from(bolt, seat, -1.0);
        joint.grip = seat - head;
        joint.members = members_of(bolt, joint, head, seat);
        // What is clamped says better than the nut where the seat is: a CAD nut may stand off it.
        double sum = 0.0;
        for (const ClampedMember& member : joint.members) sum += member.thickness;
        joint.seat = bolt.origin + seat * bolt.axis;
        if (joint.members.empty()) {
            joint.members.push_back({-1, joint.grip});
            note(joint, "no part with a hole was found between head and nut: one member fills the grip");
        } else if (std::abs(sum - joint.grip) > 0.02 * mm) {
            note(joint,
                 fmt::format("the parts between head and nut are {:.2f} mm, the room for them is {:.2f} mm",
                             sum / mm, joint.grip / mm));
        }
        joint.group = group_of(joint);
        return joint;
    }

    std::vector<ClampedMember> members_of(const Placed& bolt, const JointCandidate& joint, double head,
                                          double seat) const {
        std::vector<const PartGeometry*> parts;
        for (std::size_t n = 0; n < tree_.nodes.size(); ++n) parts.push_back(part_of(static_cast<int>(n)));
        for (const auto& list : {joint.head_washers, joint.nut_washers, std::vector{joint.bolt, joint.nut}})
            for (const int node : list) parts[static_cast<std::size_t>(node)] = nullptr;
        return find_members(parts, poses_, {bolt.origin, bolt.axis, bolt.shape->diameter, head, seat});
    }

    void note(const JointCandidate& joint, const std::string& what) {
        search_.remarks.push_back(
            fmt::format("{}: {}", tree_.nodes[static_cast<std::size_t>(joint.bolt)].name, what));
    }

    // The group that the author made for this joint.
    int group_of(const JointCandidate& joint) const {
        const auto name = [&](int node) -> const std::string& {
            return tree_.nodes[static_cast<std::size_t>(node)].name;
        };
        for (int up = common_parent(tree_, joint.bolt, joint.nut); up >= 0;
             up = tree_.nodes[static_cast<std::size_t>(up)].parent)
            if (name(up).starts_with(joint_prefix) && name(up).size() > joint_prefix.size()) return up;
        return -1;
    }

    // Ids of the author's groups as they are, others by position: along x, then z, then y, in millimetres.
    void number() {
        std::map<int, int> members;
        for (const JointCandidate& joint : search_.joints)
            if (joint.group >= 0) ++members[joint.group];
        std::set<std::string> taken;
        for (JointCandidate& joint : search_.joints) {
            if (joint.group >= 0 && members[joint.group] > 1) joint.group = -1;  // a group of several joints
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
};

// The shortest turn of +Y into the axis.
Quat turn_to(const Vec3& axis) {
    const Vec3 up{0.0, 1.0, 0.0};
    const double cos = glm::dot(up, axis);
    if (cos > 1.0 - 1e-12) return {1.0, 0.0, 0.0, 0.0};
    if (cos < -1.0 + 1e-12) return {0.0, 1.0, 0.0, 0.0};
    const Vec3 cross = glm::cross(up, axis);
    return glm::normalize(Quat{1.0 + cos, cross.x, cross.y, cross.z});
}

int make_group(Tree& tree, const JointCandidate& joint) {
    const int node = static_cast<int>(tree.nodes.size());
    TreeNode group;
    group.local = {turn_to(joint.axis), joint.seat, 1.0};
    tree.nodes.push_back(group);
    tree.roots.push_back(node);
    if (const int parent = common_parent(tree, joint.bolt, joint.nut); parent >= 0)
        move_under(tree, node, parent);
    return node;
}

// The group of the author's own should stand where the geometry says.
void check_group(const Tree& tree, const JointCandidate& joint, std::vector<std::string>& remarks) {
    const Pose pose = world(tree, joint.group);
    const double off = glm::length(pose.position - joint.seat) / mm;
    const double turn = glm::dot(pose.direction({0.0, 1.0, 0.0}), joint.axis);
    const std::string& name = tree.nodes[static_cast<std::size_t>(joint.group)].name;
    if (off > 0.01)
        remarks.push_back(
            fmt::format("{}: its origin is {:.3f} mm from the centre of the hole under the nut", name, off));
    if (turn < 1.0 - 1e-6)
        remarks.push_back(fmt::format("{}: its +Z axis is {:.2f} degrees off the bolt's", name,
                                      to_degrees(std::acos(std::clamp(turn, -1.0, 1.0)))));
}

}  // namespace

JointSearch find_joints(const Tree& tree, const std::vector<PartGeometry>& parts) {
    return Finder(tree, parts).run();
}

void group_joints(Tree& tree, JointSearch& search) {
    for (JointCandidate& joint : search.joints) {
        if (joint.group >= 0)
            check_group(tree, joint, search.remarks);
        else
            joint.group = make_group(tree, joint);
        const auto put = [&](int node, const std::string& name) {
            if (tree.nodes[static_cast<std::size_t>(node)].parent != joint.group)
                move_under(tree, node, joint.group);
            tree.nodes[static_cast<std::size_t>(node)].name = joint.id + "_" + name;
            tree.nodes[static_cast<std::size_t>(node)].fixed = true;
        };
        tree.nodes[static_cast<std::size_t>(joint.group)].name = std::string(joint_prefix) + joint.id;
        tree.nodes[static_cast<std::size_t>(joint.group)].fixed = true;
        put(joint.bolt, "bolt");
        for (const int washer : joint.head_washers) put(washer, "washer_head");
        for (const int washer : joint.nut_washers) put(washer, "washer_nut");
        put(joint.nut, "nut");
    }
}

}  // namespace bolt::step_import
