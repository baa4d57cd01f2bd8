// A STEP file as read: parts with their styles, and the tree of instances. CAD frame: millimetres, Z up.
#pragma once

#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <functional>
#include <gp_Trsf.hxx>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "tools/author/import/colour.hpp"

namespace bolt::step_import {

// What a face says about itself; the faces in the order of faces_of().
struct FaceStyle {
    std::optional<Colour> colour;
    std::string name;
};

// A product without components: one shape, however often it is used.
struct Part {
    std::string name;
    TopoDS_Shape shape;
    std::optional<Colour> colour;
    std::string material;  // as the file has it: "C45"
    std::vector<FaceStyle> faces;
};

// One use of a part, or of an assembly (part −1, with children).
struct Instance {
    std::string name;   // of the use, or of the product where the use has none
    gp_Trsf placement;  // against the parent
    int part = -1;
    std::vector<int> children;
    std::optional<Colour> colour;  // of this use: stronger than the part's, weaker than a face's
};

struct StepDocument {
    std::vector<Part> parts;
    std::vector<Instance> instances;  // parents before children
    std::vector<int> roots;
    std::string unit;                   // of the file, as it names it: "millimetre", "inch"
    std::vector<std::string> warnings;  // what the reader had to leave out
};

// 0 … 1 of the step that `what` names.
using StepProgress = std::function<void(double fraction, const std::string& what)>;

// Bad content: no STEP file, cut short, or nothing in it that could be shown.
Result<StepDocument> read_step(const std::filesystem::path& path, const StepProgress& progress);

}  // namespace bolt::step_import
