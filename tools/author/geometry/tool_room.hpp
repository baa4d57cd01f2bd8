// The room for one tool on one joint: its free swing where the joint is seated and where its thread starts,
// and a free path onto it.
#pragma once

#include <optional>

#include "content/format/assembly.hpp"
#include "tools/author/geometry/free_swing.hpp"
#include "tools/author/geometry/scene.hpp"
#include "tools/author/geometry/tool_geometry.hpp"

namespace bolt::geometry {

// The swing of a tool as it is and turned over; only an open end can be turned over.
struct SwingPair {
    FreeSwing plain, turned_over;
    bool reversible = true;  // the tool can be turned over

    [[nodiscard]] double most() const { return std::max(plain.width(), turned_over.width()); }
    [[nodiscard]] double least() const { return std::min(plain.width(), turned_over.width()); }
    [[nodiscard]] bool is_wider_turned_over() const { return turned_over.width() > plain.width(); }
    [[nodiscard]] const FreeSwing& wider() const { return is_wider_turned_over() ? turned_over : plain; }
};

// The swing that a tool needs, rad.
struct SwingRule {
    double least = 0.0;   // width that one free arc must have
    double period = 0.0;  // angle after which the head fits the hexagon again
};
SwingRule swing_rule(const ToolGeometry& tool);

// Returns true if the tool fits on the part whatever the angle of the part is, so that it can turn the part
// without limit. `one_way_up`: without turning an open end over.
bool can_turn_fully(const SwingPair& swings, const ToolGeometry& tool, bool one_way_up);

// Returns true if can_turn_fully(), with an open end either way up, and if one arc has the least width that
// swing_rule() demands.
bool is_enough(const SwingPair& swings, const ToolGeometry& tool);

struct ToolRoom {
    double height = 0.0;  // m, of the tool's origin above the joint's, on the tightened joint
    SwingPair seated;
    std::optional<SwingPair> at_start;    // if the thread starts more than 1 mm above the seat
    std::uint32_t obstruction = no_part;  // a part in the path onto the tightened joint
    bool is_sufficient = false;           // the swings are wide enough, and a path is free
};

// A joint and the obstacles around it.
class JointSurroundings {
  public:
    // `trees`: of build_part_trees().
    JointSurroundings(const content::AssemblyJoint& joint, const JointParts& parts,
                      const FlattenedModel& scene, const std::vector<Bvh>& trees)
        : joint_(joint),
          parts_(parts),
          scene_(scene),
          obstacles_(trees, parts.to_joint, parts.to_assembly, parts.turned.parts) {}

    // The joint must have a part that the tool grips.
    [[nodiscard]] ToolRoom room_for(const ToolGeometry& tool) const;

    [[nodiscard]] const content::AssemblyJoint& joint() const { return joint_; }
    [[nodiscard]] const JointParts& parts() const { return parts_; }
    [[nodiscard]] const FlattenedModel& scene() const { return scene_; }
    [[nodiscard]] std::string name_of(std::uint32_t part) const {
        return part < scene_.parts.size() ? content::in_quotes(scene_.parts[part].name) : "no part";
    }

  private:
    [[nodiscard]] double height_of(const ToolGeometry& tool) const;
    [[nodiscard]] std::uint32_t find_path(const ToolGeometry& tool, const ToolRoom& room, const Bvh& plain,
                                          const Bvh& over) const;

    const content::AssemblyJoint& joint_;
    const JointParts& parts_;
    const FlattenedModel& scene_;
    Obstacles obstacles_;
};

}  // namespace bolt::geometry
