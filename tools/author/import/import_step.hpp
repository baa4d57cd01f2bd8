// Imports a STEP file: writes the near and far models, the contact model and a draft of assembly.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::step_import {

struct ImportOptions {
    std::filesystem::path step, folder;
    std::filesystem::path write_to;      // temporary folder of the files; empty: `folder`
    std::string name;                    // of the files; empty: the name of the STEP file
    double deflection_mm = 0.1;          // largest distance between chord and curve or surface
    double angle_deg = 15.0;             // largest angle between neighbouring chords
    double contact_deflection_mm = 0.0;  // of the contact model; 0: deflection_mm
    bool far_level = false;              // also write NAME.far.glb
    std::size_t far_triangles = 60'000;
    bool joints = true;                   // find joints and draft assembly.json
    std::vector<std::string> turn_heads;  // ids of joints to turn at the head instead of the nut, or "all"
};

struct PartReport {
    std::string name;
    std::size_t instances = 0, triangles = 0, far_triangles = 0, contact_triangles = 0;
    std::size_t open_edges = 0;
    std::vector<Vec3> open_at_mm;  // middles of the first open edges, in the part's CAD frame
    std::size_t faces_without_triangles = 0;
    double deviation_mm = 0.0;  // largest distance found between a triangle and its surface
};

struct FileReport {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
};

struct ImportReport {
    std::string unit;  // of the STEP file
    std::vector<PartReport> parts;
    std::size_t instances = 0, triangles = 0, far_triangles = 0;  // counting instances
    std::vector<std::string> materials;
    std::size_t joints = 0, joints_drafted = 0;
    std::vector<std::string> tools, joint_types;  // of the draft in words
    // Deflections of the near, the contact and the far mesh, 0 without a far mesh, and the error that the
    // simplification adds to the far mesh.
    double deflection_mm = 0.0, contact_deflection_mm = 0.0, far_deflection_mm = 0.0, far_error_mm = 0.0;
    std::size_t renamed = 0;  // nodes with a duplicate name
    std::vector<FileReport> files;
    std::vector<std::string> remarks;
};

// Called with the progress of the whole import, 0 … 1, and the present phase.
using ImportProgress = std::function<void(double fraction, const std::string& what)>;

struct ImportResult {
    ImportReport report;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// Throws std::bad_alloc if memory runs out. OpenCASCADE may crash or never return on a damaged file, so the
// command calls this in a child process (guard.hpp).
ImportResult import_step(const ImportOptions& options, const ImportProgress& progress);

// Formats the report as a table.
std::string summary(const ImportReport& report);

}  // namespace bolt::step_import
