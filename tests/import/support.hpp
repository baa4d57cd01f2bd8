// Creates STEP files whose expected values are known in closed form, and reads the imported models.
#pragma once

#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <filesystem>
#include <functional>
#include <gp_Trsf.hxx>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "tests/support/folder.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/import/import_step.hpp"

namespace import_test {

using namespace bolt;

using bolt::test::Folder;

class StepMaker {
  public:
    StepMaker();
    TDF_Label part(const std::string& name, const TopoDS_Shape& shape, const std::string& colour = {});
    TDF_Label assembly(const std::string& name);
    // The writer of OpenCASCADE drops the name of a component without a translation.
    TDF_Label place(const TDF_Label& parent, const TDF_Label& what, const std::string& name,
                    const gp_Trsf& where = {});
    void paint(const TDF_Label& label, const std::string& colour);
    void paint_face(const TDF_Label& part, const TopoDS_Shape& face, const std::string& colour);
    void material(const TDF_Label& part, const std::string& name);
    void write(const std::filesystem::path& path, const char* unit = "MM");

  private:
    Handle(TDocStd_Document) document_;
    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colours_;
};

gp_Trsf moved(double x, double y, double z);

// Returns the plane face with the outward normal (x, y, z); fails the test if there is none.
TopoDS_Shape face_towards(const TopoDS_Shape& shape, double x, double y, double z);

// Fasteners without threads, along +Z, mm. The head is below z = 0, the shank extends from 0 to `length`; nut
// and washer extend from 0 upwards.
TopoDS_Shape hexagon_bolt(double d, double flats, double head, double length);
// A cap screw: diameters of thread and head, height of the head, width and depth of its socket.
TopoDS_Shape cap_screw(double d, double head, double height, double socket, double depth, double length);
TopoDS_Shape hexagon_nut(double flats, double height, double hole);
TopoDS_Shape ring(double outer, double inner, double height);

step_import::ImportResult import(const std::filesystem::path& step, const std::filesystem::path& folder,
                                 step_import::ImportOptions options = {});

// An imported file with the draft of its lesson.
struct ImportedLesson {
    nlohmann::json draft;  // null: no joint was found
    step_import::ImportReport report;
    geometry::Findings findings;  // of the draft and its models

    [[nodiscard]] bool has_remark(const std::string& part) const;
};

// Imports the STEP file that `write` makes, and checks its draft. Fails the test if the draft has mistakes.
ImportedLesson import_lesson(const std::function<void(const std::filesystem::path& step)>& write,
                             step_import::ImportOptions options = {});
// Fails the test for each remark of the import, each finding, and another number of joints than one.
void require_one_good_joint(const ImportedLesson& imported);

assets::Model load(const std::filesystem::path& glb);
int node_named(const assets::Model& model, const std::string& name);  // index; −1 if there is none
glm::dmat4 world(const assets::Model& model, int node);
double volume(const assets::Mesh& mesh);  // m³, of a closed mesh
std::string bytes(const std::filesystem::path& file);

// Runs a program of this build in the folder; its output goes to the file "log" there. Fails the test unless
// it succeeds.
void run_program(const Folder& folder, const std::string& program, const std::string& arguments);

}  // namespace import_test
