#include "tools/author/geometry/check_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "tools/author/geometry/messages.hpp"

namespace bolt::geometry {

namespace {

struct AxisConvention {
    Vec3 (*apply)(const Vec3&);  // from coordinates of the file to those of the model
    const char* what;            // nullptr: the same axes
    const char* expected;
};

constexpr AxisConvention axis_conventions[] = {
    {[](const Vec3& p) { return p; }, nullptr, nullptr},
    {[](const Vec3& p) {
         return Vec3{p.x, -p.z, p.y};
     },
     "the model has Z up", "Y up, as in glTF: bolt-author import-step converts it"},
    {[](const Vec3& p) {
         return Vec3{p.x, p.z, -p.y};
     },
     "the model has Y and Z exchanged (its up is -Z)",
     "Y up, as in glTF: rotate the model by 90 degrees about X, so that its -Z points up"},
    {[](const Vec3& p) {
         return Vec3{p.x, p.z, p.y};
     },
     "Y and Z are exchanged, which mirrors the model",
     "Y up and no mirror: check the order of the coordinates in the file"},
};

struct UnitScale {
    double factor;  // model / file
    const char* what;
    const char* expected;
};

constexpr UnitScale unit_scales[] = {
    {1.0, nullptr, nullptr},
    {1e3, "the model is in millimetres", "metres, as in glTF: scale the model by 0.001"},
    {1e2, "the model is in centimetres", "metres, as in glTF: scale the model by 0.01"},
    {1.0 / 0.0254, "the model is in inches", "metres, as in glTF: scale the model by 0.0254"},
    {1e-3, "the model is a thousand times too small", "metres, as in glTF: scale the model by 1000"},
    {1e-2, "the model is a hundred times too small", "metres, as in glTF: scale the model by 100"},
    {25.4, "the model is 25.4 times too large: millimetres were read as inches",
     "metres: scale the model by 1/25.4"},
    {1.0 / 25.4, "the model is 25.4 times too small: inches were read as millimetres",
     "metres: scale the model by 25.4"},
};

bool same_axis(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) <= axis_tolerance;
}

bool fits(const JointPlacement& p, const AxisConvention& axes, double factor) {
    const Vec3 expected = factor * axes.apply(p.file);
    const double rounding = 1e-6 * glm::length(expected);  // single precision, and factors such as 1/25.4
    return glm::length(p.model - expected) <= position_tolerance * factor + rounding &&
           same_axis(p.model_axis, axes.apply(p.file_axis));
}

}  // namespace

bool agrees(const JointPlacement& p) {
    return glm::length(p.model - p.file) <= position_tolerance && same_axis(p.model_axis, p.file_axis);
}

std::optional<SystematicError> find_systematic_error(std::span<const JointPlacement> placements) {
    if (placements.empty() || std::all_of(placements.begin(), placements.end(), agrees)) return std::nullopt;
    double furthest = 0.0;
    for (const JointPlacement& p : placements) furthest = std::max(furthest, glm::length(p.file));
    for (const AxisConvention& axes : axis_conventions)
        for (const UnitScale& scale : unit_scales) {
            if (axes.what == nullptr && scale.what == nullptr) continue;
            if (!std::all_of(placements.begin(), placements.end(),
                             [&](const JointPlacement& p) { return fits(p, axes, scale.factor); }))
                continue;
            // No machine is smaller than 2 mm: in that case the file, not the model, has the wrong unit.
            if (scale.factor == 1e3 && furthest < 2 * mm)
                return SystematicError{"position_mm is in metres", "millimetres: multiply by 1000"};
            SystematicError cause{scale.what != nullptr ? scale.what : axes.what,
                                  scale.what != nullptr ? scale.expected : axes.expected};
            if (scale.what != nullptr && axes.what != nullptr) {
                cause.what += fmt::format(", and {}", axes.what);
                cause.expected += fmt::format("; {}", axes.expected);
            }
            return cause;
        }
    const Vec3 shift = placements[0].model - placements[0].file;
    const bool shifted = placements.size() > 1 &&
                         std::all_of(placements.begin(), placements.end(), [&](const JointPlacement& p) {
                             return glm::length(p.model - p.file - shift) <= position_tolerance &&
                                    same_axis(p.model_axis, p.file_axis);
                         });
    if (shifted)
        return SystematicError{fmt::format("the whole model is shifted by {} mm", in_mm(shift)),
                               "one origin for the file and its model"};
    return std::nullopt;
}

OpenEdges open_edges(std::span<const Triangle> triangles) {
    std::map<std::tuple<double, double, double>, std::uint32_t> index;
    std::vector<Vec3> points;
    const auto weld = [&](const Vec3& p) {
        const auto [it, fresh] =
            index.emplace(std::tuple{p.x, p.y, p.z}, static_cast<std::uint32_t>(points.size()));
        if (fresh) points.push_back(p);
        return it->second;
    };
    // By edge (lower corner first): the uses from the lower to the higher corner minus those back.
    std::map<std::pair<std::uint32_t, std::uint32_t>, long> uses;
    for (const Triangle& t : triangles) {
        const std::uint32_t corners[3] = {weld(t.a), weld(t.b), weld(t.c)};
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
            if (a < b) ++uses[{a, b}];
            if (b < a) --uses[{b, a}];
        }
    }
    OpenEdges open;
    for (const auto& [edge, balance] : uses) {
        if (balance == 0) continue;
        if (open.count == 0) open.first = 0.5 * (points[edge.first] + points[edge.second]);
        open.count += static_cast<std::size_t>(std::abs(balance));
    }
    return open;
}

namespace {

// Returns the node that a joint names; -1 after reporting an error.
int find_node(const std::string& name, std::size_t joint, const FlattenedModel& scene,
              const std::vector<std::string>& joint_nodes, const Messages& messages) {
    if (name.empty()) {
        messages.error(joint_pointer(joint), "this joint names no node of the model",
                       "\"node\", the name of the node that shows it");
        return -1;
    }
    const auto found = scene.by_name.find(name);
    if (found == scene.by_name.end()) {
        const std::string near = content::nearest_name(name, scene.names());
        messages.error(joint_pointer(joint, "node"),
                       fmt::format("there is no node {} in the model", content::in_quotes(name)),
                       !near.empty()         ? fmt::format("did you mean {}?", content::in_quotes(near))
                       : joint_nodes.empty() ? "the name of a node; no node name begins with joint_"
                                             : content::suggest(name, joint_nodes));
        return -1;
    }
    if (found->second.size() > 1) {
        messages.error(
            joint_pointer(joint, "node"),
            fmt::format("{} nodes of the model are named {}", found->second.size(), content::in_quotes(name)),
            "one");
        return -1;
    }
    return found->second.front();
}

// Returns false for a node that is scaled, mirrored or skewed.
bool is_rigid(const glm::dmat4& m) {
    const Vec3 x(m[0]), y(m[1]), z(m[2]);
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-4; };
    return near(glm::length(x), 1.0) && near(glm::length(y), 1.0) && near(glm::length(z), 1.0) &&
           near(glm::dot(glm::cross(x, y), z), 1.0);
}

JointPlacement placement_of(const content::AssemblyJoint& joint, const glm::dmat4& world) {
    return {joint.design.seat - joint.design.washer_under_turned() * joint.design.axis, joint.design.axis,
            Vec3(world[3]), glm::normalize(Vec3(world[1]))};
}

void report_misplaced(const JointPlacement& p, const std::string& name, std::size_t joint,
                      const Messages& messages) {
    const double off = glm::length(p.model - p.file);
    if (off > position_tolerance) {
        const auto cause = find_systematic_error({&p, 1});
        messages.error(joint_pointer(joint, "position_mm"),
                       fmt::format("the joint is {} mm here, but its node {} stands at {} mm, {:.3g} mm away",
                                   in_mm(p.file), content::in_quotes(name), in_mm(p.model), off / mm),
                       cause ? fmt::format("both within 0.01 mm; it looks as if {}", cause->what)
                             : "both within 0.01 mm");
        return;
    }
    const double angle =
        std::atan2(glm::length(glm::cross(p.model_axis, p.file_axis)), glm::dot(p.model_axis, p.file_axis));
    messages.error(
        joint_pointer(joint, "axis"),
        fmt::format("the axis is [{:.4g}, {:.4g}, {:.4g}] here, but +Y of its node {} is [{:.4g}, "
                    "{:.4g}, {:.4g}], {:.3g} degrees off",
                    p.file_axis.x, p.file_axis.y, p.file_axis.z, content::in_quotes(name), p.model_axis.x,
                    p.model_axis.y, p.model_axis.z, to_degrees(angle)),
        angle > to_radians(179.0) ? "the opposite direction of the bolt" : "both within 0.1 degrees");
}

}  // namespace

std::vector<int> check_nodes(const content::Assembly& assembly, const FlattenedModel& scene,
                             const Messages& messages) {
    std::vector<std::string> joint_nodes;
    for (const auto& [name, nodes] : scene.by_name)
        if (name.starts_with("joint_")) joint_nodes.push_back(name);

    std::vector<int> nodes;
    std::vector<JointPlacement> placements;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const content::AssemblyJoint& joint = assembly.joints[i];
        nodes.push_back(find_node(joint.node, joint.index_in_file, scene, joint_nodes, messages));
        if (nodes.back() < 0) continue;
        placements.push_back(placement_of(joint, joint_frame(scene, nodes.back(), joint.design)));
    }
    // A cause that explains all wrong positions is reported once, instead of one error for each joint.
    if (const auto cause = find_systematic_error(placements)) {
        const auto first = std::find_if(nodes.begin(), nodes.end(), [](int node) { return node >= 0; });
        const auto i = static_cast<std::size_t>(first - nodes.begin());
        messages.error("/model",
                       fmt::format("{}: {} is at {} mm in the model and at {} mm in the file", cause->what,
                                   content::in_quotes(assembly.joints[i].node), in_mm(placements[0].model),
                                   in_mm(placements[0].file)),
                       cause->expected);
        std::fill(nodes.begin(), nodes.end(), -1);
        return nodes;
    }
    std::size_t k = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] < 0) continue;
        const JointPlacement& p = placements[k++];
        const std::string& name = assembly.joints[i].node;
        if (!is_rigid(scene.nodes[static_cast<std::size_t>(nodes[i])].world)) {
            messages.error(joint_pointer(assembly.joints[i].index_in_file, "node"),
                           fmt::format("the node {} is scaled, mirrored or skewed", content::in_quotes(name)),
                           "a node that is only translated and rotated");
            nodes[i] = -1;
        } else if (!agrees(p)) {
            report_misplaced(p, name, assembly.joints[i].index_in_file, messages);
            nodes[i] = -1;
        }
    }
    return nodes;
}

namespace {

constexpr std::size_t max_listed_names = 5;  // reported one by one

// Returns the names of `reference` that `other` lacks.
std::vector<std::string> missing_names(const FlattenedModel& reference, const FlattenedModel& other) {
    std::vector<std::string> missing;
    for (const auto& [name, nodes] : reference.by_name)
        if (!other.by_name.contains(name)) missing.push_back(name);
    return missing;
}

}  // namespace

void check_file_size(const std::string& path, std::string_view pointer, const Messages& messages) {
    std::error_code problem;
    const auto size = std::filesystem::file_size(path, problem);
    if (!problem && size > file_budget)
        messages.error(pointer, fmt::format("the file has {:.1f} MB", static_cast<double>(size) * 1e-6),
                       "at most 8 MB");
}

void check_triangles(const FlattenedModel& scene, std::size_t budget, std::string_view pointer,
                     const Messages& messages) {
    if (scene.triangle_count() > budget)
        messages.error(pointer, fmt::format("the model has {} triangles", scene.triangle_count()),
                       fmt::format("at most {}: import it with a larger deflection", budget));
}

void check_names(const FlattenedModel& near, const FlattenedModel& far, const Messages& messages) {
    const std::vector<std::string> lost = missing_names(near, far), added = missing_names(far, near);
    for (std::size_t i = 0; i < lost.size() && i < max_listed_names; ++i) {
        const std::string meant = content::nearest_name(lost[i], added);
        messages.error(
            "/model_far",
            fmt::format("the far level has no node {}, which the model has", content::in_quotes(lost[i])),
            meant.empty() ? "the same names at both levels"
                          : fmt::format("did you mean {}?", content::in_quotes(meant)));
    }
    for (std::size_t i = 0; i < added.size() && i < max_listed_names && lost.empty(); ++i)
        messages.error(
            "/model_far",
            fmt::format("the far level has a node {}, which the model lacks", content::in_quotes(added[i])),
            "the same names at both levels");
    if (lost.size() > max_listed_names)
        messages.error("/model_far", fmt::format("{} more nodes are missing", lost.size() - max_listed_names),
                       "the same names at both levels");
}

void check_contact(const FlattenedModel& contact, const FlattenedModel& near, const Messages& messages) {
    for (const ModelPart& part : contact.parts) {
        const OpenEdges open = open_edges(part.triangles);
        if (open.count > 0)
            messages.error("/contact_model",
                           fmt::format("{} has {} open edges, one near {} mm", content::in_quotes(part.name),
                                       open.count, in_mm(open.first)),
                           "a closed surface");
        if (!near.by_name.contains(part.name)) {
            const std::string meant = content::nearest_name(part.name, near.names());
            messages.error("/contact_model",
                           fmt::format("{} is not a node of the model", content::in_quotes(part.name)),
                           meant.empty() ? "the name of a node of the model"
                                         : fmt::format("did you mean {}?", content::in_quotes(meant)));
        }
    }
}

}  // namespace bolt::geometry
