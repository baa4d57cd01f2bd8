// Reads a STEP file into parts with styles and a tree of instances, and converts the CAD frame (millimetres,
// Z up) to the scene frame (metres, Y up): x = X, y = Z, z = −Y. Geometry and every placement are converted,
// so that no node has to rotate the model.
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

inline Vec3 direction_to_scene(const gp_XYZ& v) { return {v.X(), v.Z(), -v.Y()}; }
inline Vec3 point_to_scene(const gp_XYZ& p) { return direction_to_scene(p) * mm; }

inline gp_XYZ point_to_cad(const Vec3& p) { return {p.x / mm, -p.z / mm, p.y / mm}; }

// For messages, because the author works in the CAD frame.
inline Vec3 point_to_cad_mm(const Vec3& p) { return Vec3{p.x, -p.z, p.y} / mm; }

// Scale, then rotation, then translation. A negative scale mirrors.
struct ScaledPose {
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 position{0.0};
    double scale = 1.0;

    [[nodiscard]] Vec3 point(const Vec3& p) const { return rotation * (p * scale) + position; }
    [[nodiscard]] Vec3 direction(const Vec3& d) const { return rotation * (scale < 0.0 ? -d : d); }
};

inline ScaledPose operator*(const ScaledPose& outer, const ScaledPose& inner) {
    return {outer.rotation * inner.rotation, outer.point(inner.position), outer.scale * inner.scale};
}

inline ScaledPose inverse(const ScaledPose& pose) {
    const Quat inverse_rotation = glm::conjugate(pose.rotation);
    return {inverse_rotation, inverse_rotation * (-pose.position / pose.scale), 1.0 / pose.scale};
}

// Rounds values below 1e-12 to zero, so that an unrotated instance gets the exact identity.
inline ScaledPose to_scene(const gp_Trsf& placement) {
    const auto snap = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };
    const gp_Quaternion q = placement.GetRotation();
    ScaledPose pose;
    pose.rotation = {snap(q.W()), snap(q.X()), snap(q.Z()), snap(-q.Y())};
    if (std::abs(std::abs(pose.rotation.w) - 1.0) < 1e-15) pose.rotation = {1.0, 0.0, 0.0, 0.0};
    const Vec3 moved = point_to_scene(placement.TranslationPart());
    pose.position = {snap(moved.x), snap(moved.y), snap(moved.z)};
    pose.scale = placement.ScaleFactor();
    return pose;
}

using FaceMap = TopTools_IndexedMapOfShape;

// Returns the faces of a shape, each once, numbered from 1 in an order that depends on the shape alone.
inline FaceMap faces_of(const TopoDS_Shape& shape) {
    FaceMap faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    return faces;
}

// Style of one face in the file.
struct FaceStyle {
    std::optional<Colour> colour;
    std::string name;
};

// A product without components. All its instances share one shape.
struct StepPart {
    std::string name;
    TopoDS_Shape shape;
    std::optional<Colour> colour;
    std::string material;          // name in the file: "C45"
    std::vector<FaceStyle> faces;  // in the order of faces_of()
};

// One instance of a part, or of an assembly (part −1, with children).
struct StepInstance {
    std::string name;   // of the instance, or of its product if the instance has none
    gp_Trsf placement;  // relative to the parent
    int part = -1;
    std::vector<int> children;
    // The colour of this instance overrides that of the part; the colour of a face overrides both.
    std::optional<Colour> colour;
};

// CAD frame: millimetres, Z up.
struct StepDocument {
    std::vector<StepPart> parts;
    std::vector<StepInstance> instances;  // parents before children
    std::vector<int> roots;
    std::string unit;                   // length unit as named in the file: "millimetre", "inch"
    std::vector<std::string> warnings;  // of the reader about omitted records
};

// Called with the progress of the phase `what`, 0 … 1.
using ReadProgress = std::function<void(double fraction, const std::string& what)>;

// Fails with bad_content if the file is not a STEP file, is truncated, or has no shape.
Result<StepDocument> read_step(const std::filesystem::path& path, const ReadProgress& progress);

}  // namespace bolt::step_import
