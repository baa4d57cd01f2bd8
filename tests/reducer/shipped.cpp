#include "shipped.hpp"

#include <doctest/doctest.h>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <IntCurvesFace_ShapeIntersector.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_ChildIterator.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <gp_Lin.hxx>

#include "content/format/assembly.hpp"

namespace reducer_test {
namespace {

std::string name_of(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    std::string text;
    for (int i = 1; i <= name->Get().Length(); ++i) text += static_cast<char>(name->Get().Value(i));
    return text;
}

void collect(const TDF_Label& label, const TopLoc_Location& above, const std::string& path,
             std::map<std::string, PlacedPart>& parts) {
    TDF_LabelSequence children;
    XCAFDoc_ShapeTool::GetComponents(label, children);
    for (int i = 1; i <= children.Length(); ++i) {
        const TDF_Label& child = children.Value(i);
        TDF_Label referred;
        if (!XCAFDoc_ShapeTool::GetReferredShape(child, referred)) continue;
        const std::string name = name_of(child);
        const TopLoc_Location location = above * XCAFDoc_ShapeTool::GetLocation(child);
        if (XCAFDoc_ShapeTool::IsAssembly(referred)) {
            collect(referred, location, path + "/" + name, parts);
            continue;
        }
        REQUIRE_MESSAGE(parts.count(name) == 0, name);
        parts[name] = {path, XCAFDoc_ShapeTool::GetShape(referred).Moved(location)};
    }
}

std::map<std::string, PlacedPart> read() {
    const auto file = bolt::content::content_folder() / "assemblies/zq350/zq350.step";
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    STEPCAFControl_Reader reader;
    reader.SetNameMode(true);
    REQUIRE(reader.ReadFile(file.c_str()) == IFSelect_RetDone);
    REQUIRE(reader.Transfer(document));
    TDF_LabelSequence roots;
    XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(roots);
    std::map<std::string, PlacedPart> parts;
    for (int i = 1; i <= roots.Length(); ++i) collect(roots.Value(i), {}, "", parts);
    return parts;
}

}  // namespace

const std::map<std::string, PlacedPart>& shipped() {
    static const std::map<std::string, PlacedPart> parts = read();
    return parts;
}

const TopoDS_Shape& part(const std::string& name) {
    const auto found = shipped().find(name);
    REQUIRE_MESSAGE(found != shipped().end(), name);
    return found->second.shape;
}

double volume(const TopoDS_Shape& shape) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shape, properties);
    return properties.Mass();
}

double common_volume(const TopoDS_Shape& a, const TopoDS_Shape& b) {
    BRepAlgoAPI_Common common(a, b);
    REQUIRE(common.IsDone());
    return volume(common.Shape());
}

double distance(const TopoDS_Shape& a, const TopoDS_Shape& b) {
    const BRepExtrema_DistShapeShape extrema(a, b);
    REQUIRE(extrema.IsDone());
    return extrema.Value();
}

std::vector<double> crossings_z(const TopoDS_Shape& shape, double x, double y) {
    // One intersector a shape, because the tests query two castings with hundreds of lines.
    static std::map<const void*, IntCurvesFace_ShapeIntersector> cache;
    const auto [at, is_new] = cache.try_emplace(&shape);
    IntCurvesFace_ShapeIntersector& faces = at->second;
    if (is_new) faces.Load(shape, 1e-7);
    faces.Perform(gp_Lin(gp_Pnt(x, y, 0.0), gp_Dir(0, 0, 1)), -1000.0, 1000.0);
    std::vector<double> z;
    for (int i = 1; i <= faces.NbPnt(); ++i) z.push_back(faces.Pnt(i).Z());
    std::sort(z.begin(), z.end());
    return z;
}

}  // namespace reducer_test
