// Tests of the shipped STEP models: they are read back and compared with their assembly files.
#include <doctest/doctest.h>

#include <BRepAdaptor_Surface.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "haptics/joint/fastener.hpp"
#include "support.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/skip.hpp"
#include "tools/assets/models/shipped.hpp"
#include "tools/assets/models/solids.hpp"

using namespace bolt;
using namespace bolt::models;

namespace {

struct ShippedModel {
    std::string name;
    Status (*build)(CadDocument&);
};

const ShippedModel shipped[] = {
    {"dn200-pn16", add_dn200_pn16}, {"cover-m8", add_cover_m8}, {"pump-32-160", add_pump_32_160}};

std::string written(const ShippedModel& model, const test::Folder& folder) {
    CadDocument document(model.name);
    const Status built = model.build(document);
    REQUIRE_MESSAGE(built.has_value(), (built ? "" : built.error().message()));
    const std::filesystem::path path = folder / (model.name + ".step");
    const Status done = document.write_step(path.string());
    REQUIRE_MESSAGE(done.has_value(), (done ? "" : done.error().message()));
    return path.string();
}

std::string shipped_file(const std::string& name) {
    return (content::content_folder() / "assemblies" / name / (name + ".step")).string();
}

struct Instance {
    TopoDS_Shape shape;  // moved to its placement
    gp_Trsf placement;
};

// All instances of a STEP file by name.
std::map<std::string, Instance> instances(const std::string& path) {
    Handle(TDocStd_Document) document = new TDocStd_Document("MDTV-XCAF");
    STEPCAFControl_Reader reader;
    reader.SetNameMode(Standard_True);
    REQUIRE(reader.ReadFile(path.c_str()) == IFSelect_RetDone);
    REQUIRE(reader.Transfer(document));
    std::map<std::string, Instance> found;
    const auto visit = [&](const auto& self, const TDF_Label& label, const TopLoc_Location& where) -> void {
        TDF_LabelSequence children;
        XCAFDoc_ShapeTool::GetComponents(label, children);
        for (int i = 1; i <= children.Length(); ++i) {
            Handle(TDataStd_Name) name;
            TDF_Label prototype;
            REQUIRE(XCAFDoc_ShapeTool::GetReferredShape(children(i), prototype));
            const TopLoc_Location here = where * XCAFDoc_ShapeTool::GetLocation(children(i));
            REQUIRE(children(i).FindAttribute(TDataStd_Name::GetID(), name));
            const std::string text = TCollection_AsciiString(name->Get()).ToCString();
            CHECK_MESSAGE(found.count(text) == 0, text);
            found[text] = {XCAFDoc_ShapeTool::GetShape(prototype).Moved(here), here.Transformation()};
            self(self, prototype, here);
        }
    };
    TDF_LabelSequence roots;
    XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(roots);
    for (int i = 1; i <= roots.Length(); ++i) visit(visit, roots(i), TopLoc_Location());
    return found;
}

gp_Vec to_cad(const Vec3& v) { return {v.x, -v.z, v.y}; }

// The number of cylindrical faces of a radius about an axis.
int count_coaxial(const TopoDS_Shape& shape, const gp_Lin& axis, double radius) {
    int count = 0;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(faces.Current()));
        if (surface.GetType() != GeomAbs_Cylinder || std::abs(surface.Cylinder().Radius() - radius) > 0.01)
            continue;
        const gp_Ax1 own = surface.Cylinder().Axis();
        if (own.Direction().IsParallel(axis.Direction(), 1e-5) && axis.Distance(own.Location()) < 0.01)
            ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("Models: joints, bolts, nuts and holes are within 0.01 mm of the assembly file") {
    for (const std::string name : {"zq350", "dn200-pn16", "cover-m8"}) {
        CAPTURE(name);
        const auto loaded = content::load_assembly(name);
        REQUIRE(loaded.errors.empty());
        const auto found = instances(shipped_file(name));
        for (const auto& joint : loaded.assembly.joints) {
            const joint::JointDesign& design = joint.design;
            CAPTURE(design.id);
            REQUIRE(found.count(joint.node) == 1);
            const gp_Trsf& placement = found.at(joint.node).placement;
            // The seat of a design is under the nut, on top of the washer.
            const joint::FastenerSize& size = design.thread.size;
            const double washer = size.washer_thickness * 1e3;
            const gp_Vec axis = to_cad(design.axis);
            const gp_Vec seat = to_cad(design.seat) * 1e3 - axis * washer;
            CHECK((gp_Vec(placement.TranslationPart()) - seat).Magnitude() < 0.01);
            CHECK((gp_Vec(gp::DZ()).Transformed(placement) - axis).Magnitude() < 1e-6);

            double grip = 0.0;
            for (const joint::Member& member : design.members) grip += member.thickness * 1e3;
            const auto offset = [&](const std::string& part) {
                REQUIRE(found.count(design.id + part) == 1);
                const gp_Vec at(found.at(design.id + part).placement.TranslationPart());
                const gp_Vec from_seat = at - seat;
                CHECK((from_seat - axis * from_seat.Dot(axis)).Magnitude() < 0.01);
                return from_seat.Dot(axis);
            };
            CHECK(offset("_nut") == doctest::Approx(washer).epsilon(1e-4));
            CHECK(std::abs(offset("_washer_nut")) < 0.01);
            CHECK(offset("_bolt") == doctest::Approx(-grip - washer).epsilon(1e-4));
            CHECK(offset("_washer_head") == doctest::Approx(-grip - washer).epsilon(1e-4));

            // At least two members have a hole of the medium series around this axis.
            const gp_Lin line(gp_Pnt(seat.XYZ()), gp_Dir(axis));
            int members = 0;
            for (const auto& [part, instance] : found)
                if (instance.shape.ShapeType() == TopAbs_SOLID &&
                    count_coaxial(instance.shape, line, 0.5e3 * size.hole) > 0)
                    ++members;
            CHECK(members >= 2);
        }
    }
}

TEST_CASE("Models: studs, cap screws and foot screws of the pump are where its assembly file says") {
    const auto loaded = content::load_assembly("pump-32-160");
    REQUIRE(loaded.errors.empty());
    const auto found = instances(shipped_file("pump-32-160"));
    REQUIRE(loaded.assembly.joints.size() == 18);
    for (const auto& joint : loaded.assembly.joints) {
        const joint::JointDesign& design = joint.design;
        CAPTURE(design.id);
        const gp_Vec axis = to_cad(design.axis);
        const gp_Vec face = to_cad(design.seat) * 1e3 - axis * design.washer_under_turned() * 1e3;
        const auto height = [&](const std::string& part) {
            REQUIRE(found.count(part) == 1);
            const gp_Vec from_face = gp_Vec(found.at(part).placement.TranslationPart()) - face;
            CHECK((from_face - axis * from_face.Dot(axis)).Magnitude() < 0.01);
            return from_face.Dot(axis);
        };
        CHECK(std::abs(height(joint.node)) < 0.01);
        const bool stud = design.form == joint::JointForm::stud;
        const double grip = design.members.front().thickness * 1e3;
        CHECK(height(design.id + "_bolt") ==
              doctest::Approx(stud ? -grip : design.washer_under_turned() * 1e3).epsilon(1e-4));
        CHECK((found.count(design.id + "_nut") == 1) == stud);
        // A member with a clearance hole, and a part with a hole as wide as the core of the thread.
        const gp_Lin line(gp_Pnt(face.XYZ()), gp_Dir(axis));
        const joint::FastenerSize& size = design.thread.size;
        const double core = 0.5e3 * (size.d - 1.0825 * size.coarse_pitch);
        int members = 0, tapped = 0;
        for (const auto& [part, instance] : found) {
            if (instance.shape.ShapeType() != TopAbs_SOLID) continue;
            members += count_coaxial(instance.shape, line, 0.5e3 * size.hole) > 0 ? 1 : 0;
            tapped += part.find("nut") == std::string::npos && count_coaxial(instance.shape, line, core) > 0;
        }
        CHECK(members == 1);
        CHECK(tapped == 1);
    }
}

TEST_CASE("Models: every part of a shipped model is one valid solid") {
    for (const ShippedModel& model : shipped) {
        CAPTURE(model.name);
        for (const auto& [name, instance] : instances(shipped_file(model.name))) {
            if (instance.shape.ShapeType() == TopAbs_COMPOUND) continue;  // a group
            CAPTURE(name);
            CHECK(instance.shape.ShapeType() == TopAbs_SOLID);
            CHECK(is_valid_solid(instance.shape));
        }
    }
}

TEST_CASE("Models: the shipped file is reproduced byte for byte and contains no date and no path") {
    for (const ShippedModel& model : shipped) {
        CAPTURE(model.name);
        constexpr std::size_t limit = std::size_t{1} << 28U;
        const test::Folder folder;
        const std::string path = written(model, folder);
        const auto now = read_file(path, limit, ErrorCode::failed);
        const auto then = read_file(shipped_file(model.name), limit, ErrorCode::failed);
        REQUIRE(now);
        REQUIRE(then);
        if (const std::string other_libraries = BOLT_OTHER_LIBRARIES; other_libraries.empty())
            CHECK(*now == *then);
        else
            test::skip_part("equal bytes: " + other_libraries);
        CHECK(now->find("2020-01-01T00:00:00") != std::string::npos);
        CHECK(now->find(folder.path().string()) == std::string::npos);
    }
}

TEST_CASE("Models: a duplicate name and a missing folder are errors") {
    CadDocument twice("twice");
    const CadPart part = twice.add_part("block", box(gp_Pnt(0, 0, 0), gp_Pnt(1, 1, 1)), finish::brass);
    twice.add_instance(twice.root(), "left", part);
    twice.add_instance(twice.root(), "left", part, shift(2.0, 0.0, 0.0));
    const Status status = twice.write_step("/nowhere/at/all.step");
    REQUIRE_FALSE(status);
    CHECK(status.error().what.find("left") != std::string::npos);

    CadDocument document("one");
    document.add_instance(document.root(), "only",
                          document.add_part("block", box(gp_Pnt(0, 0, 0), gp_Pnt(1, 1, 1)), finish::brass));
    CHECK_FALSE(document.write_step("/nowhere/at/all.step"));
}
