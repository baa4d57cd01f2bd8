#include "tools/author/geometry/check_nodes.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "tools/author/geometry/misplacement.hpp"

namespace bolt::geometry {

namespace {

// The one node that a joint names, or -1.
int find_node(const std::string& name, std::size_t joint, const Scene& scene,
              const std::vector<std::string>& joint_nodes, const Messages& messages) {
    if (name.empty()) {
        messages.error(joint_pointer(joint), "this joint names no node of the model",
                       "expected \"node\", the name of the node that shows it");
        return -1;
    }
    const auto found = scene.by_name.find(name);
    if (found == scene.by_name.end()) {
        const std::string near = content::meant(name, scene.names());
        messages.error(joint_pointer(joint, "node"),
                       fmt::format("there is no node {} in the model", content::in_quotes(name)),
                       !near.empty()         ? fmt::format("did you mean {}?", content::in_quotes(near))
                       : joint_nodes.empty() ? "expected a node's name; none begins with joint_"
                                             : content::suggest(name, joint_nodes));
        return -1;
    }
    if (found->second.size() > 1) {
        messages.error(
            joint_pointer(joint, "node"),
            fmt::format("{} nodes of the model are named {}", found->second.size(), content::in_quotes(name)),
            "expected one");
        return -1;
    }
    return found->second.front();
}

// Neither scaled, nor mirrored, nor skewed.
bool is_rigid(const glm::dmat4& m) {
    const Vec3 x(m[0]), y(m[1]), z(m[2]);
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-4; };
    return near(glm::length(x), 1.0) && near(glm::length(y), 1.0) && near(glm::length(z), 1.0) &&
           near(glm::dot(glm::cross(x, y), z), 1.0);
}

Placement placement_of(const content::AssemblyJoint& joint, const glm::dmat4& world) {
    const double washer = joint.design.washer_under_nut ? joint.design.thread.size.washer_thickness : 0.0;
    return {joint.design.seat - washer * joint.design.axis, joint.design.axis, Vec3(world[3]),
            glm::normalize(Vec3(world[1]))};
}

void say_misplaced(const Placement& p, const std::string& name, std::size_t joint, const Messages& messages) {
    const double off = glm::length(p.model - p.file);
    if (off > position_tolerance) {
        const auto slip = common_slip({&p, 1});
        messages.error(
            joint_pointer(joint, "position_mm"),
            fmt::format("{} is {} mm here, but its node {} stands at {} mm, {:.3g} mm away", "the joint",
                        in_mm(p.file), content::in_quotes(name), in_mm(p.model), off / mm),
            slip ? fmt::format("it looks as if {}", slip->what) : "expected both within 0.01 mm");
        return;
    }
    const double angle =
        std::atan2(glm::length(glm::cross(p.model_axis, p.file_axis)), glm::dot(p.model_axis, p.file_axis));
    messages.error(joint_pointer(joint, "axis"),
                   fmt::format("the axis is [{:.4g}, {:.4g}, {:.4g}] here, but +Y of its node {} is [{:.4g}, "
                               "{:.4g}, {:.4g}], {:.3g} degrees off",
                               p.file_axis.x, p.file_axis.y, p.file_axis.z, content::in_quotes(name),
                               p.model_axis.x, p.model_axis.y, p.model_axis.z, to_degrees(angle)),
                   angle > to_radians(179.0) ? "expected the opposite direction of the bolt"
                                             : "expected both within 0.1 degrees");
}

}  // namespace

std::vector<int> check_nodes(const content::Assembly& assembly, const Scene& scene,
                             const Messages& messages) {
    std::vector<std::string> joint_nodes;
    for (const auto& [name, nodes] : scene.by_name)
        if (name.starts_with("joint_")) joint_nodes.push_back(name);

    std::vector<int> nodes;
    std::vector<Placement> placements;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const content::AssemblyJoint& joint = assembly.joints[i];
        nodes.push_back(find_node(joint.node, i, scene, joint_nodes, messages));
        if (nodes.back() < 0) continue;
        const glm::dmat4& world = scene.nodes[static_cast<std::size_t>(nodes.back())].world;
        placements.push_back(placement_of(joint, world));
    }
    // One slip that explains all is said once, instead of a dozen consequences.
    if (const auto slip = common_slip(placements)) {
        const auto first = std::find_if(nodes.begin(), nodes.end(), [](int node) { return node >= 0; });
        const auto i = static_cast<std::size_t>(first - nodes.begin());
        messages.error("/model",
                       fmt::format("{}: {} stands at {} mm, and the file has it at {} mm", slip->what,
                                   content::in_quotes(assembly.joints[i].node), in_mm(placements[0].model),
                                   in_mm(placements[0].file)),
                       slip->expected);
        std::fill(nodes.begin(), nodes.end(), -1);
        return nodes;
    }
    std::size_t k = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] < 0) continue;
        const Placement& p = placements[k++];
        const std::string& name = assembly.joints[i].node;
        if (!is_rigid(scene.nodes[static_cast<std::size_t>(nodes[i])].world)) {
            messages.error(joint_pointer(i, "node"),
                           fmt::format("the node {} is scaled, mirrored or skewed", content::in_quotes(name)),
                           "expected a node that is only moved and turned");
            nodes[i] = -1;
        } else if (!agrees(p)) {
            say_misplaced(p, name, i, messages);
            nodes[i] = -1;
        }
    }
    return nodes;
}

}  // namespace bolt::geometry
