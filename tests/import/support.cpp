#include "support.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Version.hxx>
#include <StepData_StepModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gp_Pln.hxx>
#include <sstream>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"

namespace import_test {

namespace fs = std::filesystem;

namespace {

Quantity_Color colour_of(const std::string& hex) {
    const auto part = [&](std::size_t at) { return std::stoi(hex.substr(at, 2), nullptr, 16) / 255.0; };
    return {part(1), part(3), part(5), Quantity_TOC_sRGB};
}

}  // namespace

StepMaker::StepMaker() : document_(new TDocStd_Document("MDTV-XCAF")) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    XCAFDoc_ShapeTool::SetAutoNaming(false);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colours_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
    // OpenCASCADE 7.8 takes the unit of the shapes from the document when it writes.
    XCAFDoc_DocumentTool::SetLengthUnit(document_, 1.0, UnitsMethods_LengthUnit_Millimeter);
}

TDF_Label StepMaker::part(const std::string& name, const TopoDS_Shape& shape, const std::string& colour) {
    const TDF_Label label = shapes_->AddShape(shape, false);
    TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
    if (!colour.empty()) paint(label, colour);
    return label;
}

TDF_Label StepMaker::assembly(const std::string& name) {
    const TDF_Label label = shapes_->NewShape();
    TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
    return label;
}

TDF_Label StepMaker::place(const TDF_Label& parent, const TDF_Label& what, const std::string& name,
                           const gp_Trsf& where) {
    const TDF_Label label = shapes_->AddComponent(parent, what, TopLoc_Location(where));
    TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), true));
    return label;
}

void StepMaker::paint(const TDF_Label& label, const std::string& colour) {
    colours_->SetColor(label, colour_of(colour), XCAFDoc_ColorSurf);
}

void StepMaker::paint_face(const TDF_Label& part, const TopoDS_Shape& face, const std::string& colour) {
    TDF_Label label;
    shapes_->AddSubShape(part, face, label);
    REQUIRE(!label.IsNull());
    paint(label, colour);
}

void StepMaker::material(const TDF_Label& part, const std::string& name) {
    const auto text = [](const char* value) {
        return Handle(TCollection_HAsciiString)(new TCollection_HAsciiString(value));
    };
    XCAFDoc_DocumentTool::MaterialTool(document_->Main())
        ->SetMaterial(part, text(name.c_str()), text(""), 7.85e-6, text("density"),
                      text("POSITIVE_RATIO_MEASURE"));
}

void StepMaker::write(const fs::path& path, const char* unit) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("write.step.schema", "AP214IS");
    Interface_Static::SetCVal("write.step.unit", unit);
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    STEPCAFControl_Writer writer;
    writer.SetColorMode(true);
    writer.SetNameMode(true);
#if OCC_VERSION_HEX >= 0x070800
    // This version names the unit in the file but takes the values from here.
    const std::string_view name = unit;
    writer.ChangeWriter().Model()->SetWriteLengthUnit(name == "INCH" ? 25.4 : name == "M" ? 1000.0 : 1.0);
#endif
    REQUIRE(writer.Transfer(document_, STEPControl_AsIs));
    REQUIRE(writer.Write(path.c_str()) == IFSelect_RetDone);
}

gp_Trsf moved(double x, double y, double z) {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(x, y, z));
    return move;
}

TopoDS_Shape face_towards(const TopoDS_Shape& shape, double x, double y, double z) {
    for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(at.Current()), false);
        if (surface.GetType() != GeomAbs_Plane) continue;
        gp_Dir normal = surface.Plane().Axis().Direction();
        if (at.Current().Orientation() == TopAbs_REVERSED) normal.Reverse();
        if (normal.IsEqual(gp_Dir(x, y, z), 1e-9)) return at.Current();
    }
    FAIL("there is no such face");
    return {};
}

namespace {

TopoDS_Shape hexagon(double flats, double from, double height) {
    BRepBuilderAPI_MakePolygon outline;
    const double corner = flats / std::sqrt(3.0);
    for (int i = 0; i < 6; ++i)
        outline.Add(gp_Pnt(corner * std::cos(i * pi / 3.0), corner * std::sin(i * pi / 3.0), from));
    outline.Close();
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()), gp_Vec(0.0, 0.0, height)).Shape();
}

}  // namespace

TopoDS_Shape hexagon_bolt(double d, double flats, double head, double length) {
    return BRepAlgoAPI_Fuse(hexagon(flats, -head, head), BRepPrimAPI_MakeCylinder(0.5 * d, length).Shape())
        .Shape();
}

TopoDS_Shape cap_screw(double d, double head, double height, double socket, double depth, double length) {
    const gp_Ax2 top(gp_Pnt(0.0, 0.0, -height), gp_Dir(0.0, 0.0, 1.0));
    const TopoDS_Shape solid = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(top, 0.5 * head, height).Shape(),
                                                BRepPrimAPI_MakeCylinder(0.5 * d, length).Shape())
                                   .Shape();
    return BRepAlgoAPI_Cut(solid, hexagon(socket, -height, depth)).Shape();
}

TopoDS_Shape hexagon_nut(double flats, double height, double hole) {
    return BRepAlgoAPI_Cut(hexagon(flats, 0.0, height), BRepPrimAPI_MakeCylinder(0.5 * hole, height).Shape())
        .Shape();
}

TopoDS_Shape ring(double outer, double inner, double height) {
    return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(0.5 * outer, height).Shape(),
                           BRepPrimAPI_MakeCylinder(0.5 * inner, height).Shape())
        .Shape();
}

step_import::ImportResult import(const fs::path& step, const fs::path& folder,
                                 step_import::ImportOptions options) {
    options.step = step;
    options.folder = folder;
    auto imported = step_import::import_step(options, [](double, const std::string&) {});
    for (const Error& error : imported.errors) MESSAGE(error.message());
    return imported;
}

bool ImportedLesson::has_remark(const std::string& part) const {
    return std::any_of(report.remarks.begin(), report.remarks.end(),
                       [&](const std::string& remark) { return remark.find(part) != std::string::npos; });
}

ImportedLesson import_lesson(const std::function<void(const std::filesystem::path& step)>& write,
                             step_import::ImportOptions options) {
    const Folder folder;
    write(folder / "machine.step");
    const auto imported = import(folder / "machine.step", folder / "out", std::move(options));
    REQUIRE(imported.ok());
    ImportedLesson result{{}, imported.report, {}};
    if (!std::filesystem::exists(folder / "out" / "assembly.json")) return result;
    const auto loaded = content::load_assembly(folder / "out");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    result.findings = geometry::check_geometry(loaded.assembly);
    result.draft = nlohmann::json::parse(bytes(folder / "out" / "assembly.json"));
    return result;
}

void require_one_good_joint(const ImportedLesson& imported) {
    for (const std::string& remark : imported.report.remarks) FAIL_CHECK(remark);
    for (const Error& error : imported.findings.errors) FAIL_CHECK(error.message());
    REQUIRE(imported.draft["joints"].size() == 1);
}

assets::Model load(const fs::path& glb) {
    auto model = assets::read_gltf(glb);
    if (!model) FAIL(model.error().message());
    return std::move(*model);
}

int node_named(const assets::Model& model, const std::string& name) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (model.nodes[i].name == name) return static_cast<int>(i);
    return -1;
}

glm::dmat4 world(const assets::Model& model, int node) {
    const assets::Node& one = model.nodes[static_cast<std::size_t>(node)];
    glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), glm::dvec3(one.translation));
    matrix = matrix * glm::mat4_cast(glm::dquat(one.rotation));
    matrix = glm::scale(matrix, glm::dvec3(one.scale));
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        for (const int child : model.nodes[i].children)
            if (child == node) return world(model, static_cast<int>(i)) * matrix;
    return matrix;
}

double volume(const assets::Mesh& mesh) {
    double sum = 0.0;
    for (const assets::Primitive& primitive : mesh.primitives)
        for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
            const auto p = [&](std::size_t k) { return Vec3(primitive.positions[primitive.indices[i + k]]); };
            sum += glm::dot(p(0), glm::cross(p(1), p(2))) / 6.0;
        }
    return sum;
}

std::string bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    REQUIRE(in);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
}

void run_program(const Folder& folder, const std::string& program, const std::string& arguments) {
    const auto bin = fs::read_symlink("/proc/self/exe").parent_path();
    const std::string command = "cd '" + folder.path().string() + "' && '" + (bin / program).string() + "' " +
                                arguments + " > log 2>&1";
    const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
    INFO(bytes(folder / "log"));
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}

}  // namespace import_test
