// The tools that would fit a joint which the tool of the file does not fit: the same tool with a longer
// extension bar, other tools of the file, or other kinds of tools.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/author/geometry/tool_room.hpp"

namespace bolt::geometry {

// The tools of an assembly, and others that are generated when they are needed.
class ToolSet {
  public:
    ToolSet(const content::Assembly& assembly, std::vector<ToolGeometry> shapes)
        : assembly_(assembly), shapes_(std::move(shapes)) {}

    [[nodiscard]] const content::Assembly& assembly() const { return assembly_; }
    // In the order of Assembly::tools.
    [[nodiscard]] std::vector<ToolGeometry>& shapes() { return shapes_; }
    // Returns nullptr if no such tool can be made.
    const ToolGeometry* generate(const content::WrenchDesign& design);

  private:
    const content::Assembly& assembly_;
    std::vector<ToolGeometry> shapes_;
    std::map<std::string, std::optional<ToolGeometry>> generated_;  // by description
};

// The rooms of tools on one joint; each is measured once.
class JointRooms {
  public:
    JointRooms(const JointSurroundings& surroundings, ToolSet& tools)
        : surroundings_(surroundings), tools_(tools) {}

    const ToolRoom& room_of(const ToolGeometry& tool);

    // Names the tools that fit in place of a tool of the assembly, for a message; empty if none does. Tries,
    // in this order, longer extension bars, the other tools of the file, and other kinds with usual lengths.
    // `tool`: index in Assembly::tools.
    std::string describe_fitting_tool(std::size_t tool);

  private:
    std::string fitting_extension(const content::WrenchDesign& design);
    std::string fitting_tool_of_file(std::size_t tool);
    std::string usual_fitting_tool(const content::WrenchDesign& design);

    const JointSurroundings& surroundings_;
    ToolSet& tools_;
    std::map<const ToolGeometry*, ToolRoom> rooms_;
};

}  // namespace bolt::geometry
