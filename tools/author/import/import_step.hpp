// From a STEP file to what an assembly needs: models near and far, the contact model, a draft of
// assembly.json.
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
    std::filesystem::path write_to;      // where the files are created, if not in `folder` itself
    std::string name;                    // of the files; empty: as the STEP file
    double deflection_mm = 0.1;          // chord against curve or surface
    double angle_deg = 15.0;             // between neighbouring chords
    double contact_deflection_mm = 0.0;  // 0: as the near level
    bool far_level = false;              // write NAME.far.glb too
    std::size_t far_triangles = 60'000;
    bool joints = true;  // look for joints, and draft assembly.json
};

struct PartReport {
    std::string name;
    std::size_t instances = 0, triangles = 0, far_triangles = 0, contact_triangles = 0;
    std::size_t open_edges = 0;
    std::vector<Vec3> open_at_mm;  // the first ones, in the part's CAD frame
    std::size_t faces_without_triangles = 0;
    double deviation_mm = 0.0;  // largest found
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
    double deflection_mm = 0.0, contact_deflection_mm = 0.0, far_deflection_mm = 0.0, far_error_mm = 0.0;
    std::size_t renamed = 0;  // nodes whose name was taken
    std::vector<FileReport> files;
    std::vector<std::string> remarks;
};

// 0 … 1 of the whole, and what is being worked on.
using Progress = std::function<void(double fraction, const std::string& what)>;

struct Imported {
    ImportReport report;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// Throws std::bad_alloc if memory runs out. OpenCASCADE may crash or never return on a damaged file: the
// command calls it in a child process (guard.hpp).
Imported import_step(const ImportOptions& options, const Progress& progress);

// The report as a table for people.
std::string summary(const ImportReport& report);

}  // namespace bolt::step_import
