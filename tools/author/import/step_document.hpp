// From the CAD frame (millimetres, Z up) to the scene's (metres, Y up): x = X, y = Z, z = −Y. Geometry and
// every placement are converted, so that no node has to turn the model.
#pragma once

#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <functional>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <gp_XYZ.hxx>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "tools/author/import/materials.hpp"

namespace bolt::step_import {

inline constexpr double mm = 1e-3;

inline Vec3 direction_to_scene(const gp_XYZ& v) { return {v.X(), v.Z(), -v.Y()}; }
inline Vec3 point_to_scene(const gp_XYZ& p) { return direction_to_scene(p) * mm; }

inline gp_XYZ point_to_cad(const Vec3& p) { return {p.x / mm, -p.z / mm, p.y / mm}; }

// For messages to the author, who knows the CAD frame.
inline Vec3 point_to_cad_mm(const Vec3& p) { return Vec3{p.x, -p.z, p.y} / mm; }

// A placement: scale, then turn, then move. A negative scale mirrors.
struct Placement {
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 position{0.0};
    double scale = 1.0;

    [[nodiscard]] Vec3 point(const Vec3& p) const { return rotation * (p * scale) + position; }
    [[nodiscard]] Vec3 direction(const Vec3& d) const { return rotation * (scale < 0.0 ? -d : d); }
};

inline Placement operator*(const Placement& outer, const Placement& inner) {
    return {outer.rotation * inner.rotation, outer.point(inner.position), outer.scale * inner.scale};
}

inline Placement inverse(const Placement& pose) {
    const Quat turned = glm::conjugate(pose.rotation);
    return {turned, turned * (-pose.position / pose.scale), 1.0 / pose.scale};
}

// Rounding noise (1e-12) is taken off, so that what is not turned has no turn.
inline Placement to_scene(const gp_Trsf& placement) {
    const auto snap = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };
    const gp_Quaternion q = placement.GetRotation();
    Placement pose;
    pose.rotation = {snap(q.W()), snap(q.X()), snap(q.Z()), snap(-q.Y())};
    if (std::abs(std::abs(pose.rotation.w) - 1.0) < 1e-15) pose.rotation = {1.0, 0.0, 0.0, 0.0};
    const Vec3 moved = point_to_scene(placement.TranslationPart());
    pose.position = {snap(moved.x), snap(moved.y), snap(moved.z)};
    pose.scale = placement.ScaleFactor();
    return pose;
}

// The faces of a shape, each once, numbered from 1 in an order that depends on the shape alone.

using FaceMap = TopTools_IndexedMapOfShape;

inline FaceMap faces_of(const TopoDS_Shape& shape) {
    FaceMap faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    return faces;
}

// A STEP file as read: parts with their styles, and the tree of instances. CAD frame: millimetres, Z up.

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
