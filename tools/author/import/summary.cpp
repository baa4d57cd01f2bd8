// The summary of an import as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/author/import/import_step.hpp"

namespace bolt::step_import {

namespace {

std::string size_text(std::uintmax_t bytes) {
    const double kb = static_cast<double>(bytes) * 1e-3;
    return kb < 1000.0 ? fmt::format("{:.0f} kB", kb) : fmt::format("{:.2f} MB", kb * 1e-3);
}

// Pads or cuts a name to `width` characters (not bytes).
std::string column(const std::string& name, std::size_t width) {
    std::string text;
    std::size_t characters = 0;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool begins = (static_cast<unsigned char>(name[i]) & 0xC0U) != 0x80U;
        if (begins && characters == width) break;
        characters += begins ? 1 : 0;
        text += name[i];
    }
    return text + std::string(width - characters, ' ');
}

std::string part_line(const PartReport& part, bool far) {
    return fmt::format("{} {:>9} {:>9} {}{:>9} {:>6}  {:.4f}\n", column(part.name, 32), part.instances,
                       part.triangles, far ? fmt::format("{:>9} ", part.far_triangles) : "",
                       part.contact_triangles, part.open_edges, part.deviation_mm);
}

}  // namespace

std::string summary(const ImportReport& report) {
    const bool far = report.far_deflection_mm > 0.0;
    std::string text =
        fmt::format("{:<32} {:>9} {:>9} {}{:>9} {:>6}  {}\n", "part", "instances", "triangles",
                    far ? fmt::format("{:>9} ", "far") : "", "contact", "open", "deviation mm");
    for (const PartReport& part : report.parts) text += part_line(part, far);
    std::size_t open = 0;
    double deviation = 0.0;
    for (const PartReport& part : report.parts) {
        open += part.open_edges;
        deviation = std::max(deviation, part.deviation_mm);
    }
    text += fmt::format("{} parts, {} instances, {} triangles with all instances", report.parts.size(),
                        report.instances, report.triangles);
    if (far) text += fmt::format(", {} at the far level", report.far_triangles);
    text += fmt::format("\nunit of the file: {}{}\n", report.unit.empty() ? "not stated" : report.unit,
                        report.unit == "millimetre" ? "" : "; lengths are given here in mm");
    text += fmt::format("deflection: {:g} mm (largest deviation found {:.4f} mm), contact {:g} mm",
                        report.deflection_mm, deviation, report.contact_deflection_mm);
    if (far)
        text += fmt::format(", far {:g} mm and {:.3f} mm more by simplifying", report.far_deflection_mm,
                            report.far_error_mm);
    text += fmt::format("\nmaterials: {}\n", fmt::join(report.materials, ", "));
    text += fmt::format("joints: {} found, {} in the draft\n", report.joints, report.joints_drafted);
    for (const std::string& tool : report.tools) text += fmt::format("tool: {}\n", tool);
    for (const std::string& type : report.joint_types) text += fmt::format("joint type {}\n", type);
    text += open == 0 ? "contact model: watertight\n"
                      : fmt::format("contact model: {} open edges, NOT watertight:\n", open);
    for (const PartReport& part : report.parts) {
        if (part.open_edges == 0) continue;
        text += fmt::format("  {}: {} open edges, the first at", part.name, part.open_edges);
        for (const Vec3& at : part.open_at_mm)
            text += fmt::format(" ({:.3f}, {:.3f}, {:.3f})", at.x, at.y, at.z);
        text += " mm\n";
    }
    for (const PartReport& part : report.parts)
        if (part.faces_without_triangles > 0)
            text +=
                fmt::format("{}: {} faces could not be meshed\n", part.name, part.faces_without_triangles);
    if (report.renamed > 0)
        text += fmt::format("{} nodes with a duplicate name got a numeric suffix\n", report.renamed);
    for (const std::string& remark : report.remarks) text += "note: " + remark + "\n";
    for (const FileReport& file : report.files)
        text += fmt::format("{} {}\n", file.path.string(), size_text(file.bytes));
    return text;
}

}  // namespace bolt::step_import
