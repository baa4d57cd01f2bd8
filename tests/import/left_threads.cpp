// Left-hand threads: drawn by the model builder, recognised in the CAD file, and compared with the assembly.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "support.hpp"
#include "tools/assets/models/fasteners.hpp"
#include "tools/assets/models/solids.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/geometry/drawn_thread.hpp"
#include "tools/author/geometry/scene.hpp"

using namespace import_test;
using nlohmann::json;

namespace {

TopoDS_Shape plate(double low, double high) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-40.0, -25.0, low), 80.0, 50.0, high - low).Shape();
    TopoDS_Shape shape = box;
    for (const double x : {-20.0, 20.0})
        shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, 0.0, low - 1.0), gp::DZ()),
                                                                4.5, high - low + 2.0)
                                           .Shape())
                    .Shape();
    return shape;
}

// Two plates of 8 mm with one M8x30 of each direction.
void write_pair(const std::filesystem::path& step) {
    models::CadDocument document("pair");
    document.add_instance(
        document.root(), "lower",
        document.add_part("lower_plate", plate(-16.0, -8.0), models::finish::machined_steel));
    document.add_instance(document.root(), "upper",
                          document.add_part("upper_plate", plate(-8.0, 0.0), models::finish::machined_steel));
    models::FastenerParts right;
    double x = -20.0;
    for (const auto direction : {joint::ThreadDirection::right, joint::ThreadDirection::left}) {
        const auto parts = models::add_fasteners(document, "M8", 30.0, models::finish::zinc_plated,
                                                 x > 0.0 ? &right : nullptr, "8.8", direction);
        REQUIRE(parts);
        models::add_joint(document, document.root(), std::string(name(direction)), *parts, 16.0,
                          models::shift(x, 0.0, 0.0));
        right = *parts;
        x = 20.0;
    }
    REQUIRE(document.write_step(step.string()));
}

std::vector<std::string> thread_notes(const std::filesystem::path& file) {
    const content::LoadedAssembly loaded = content::load_assembly(file);
    REQUIRE(loaded.ok());
    std::vector<std::string> notes;
    for (const Error& note : geometry::check_geometry(loaded.assembly).notes)
        if (note.what.find("-hand thread") != std::string::npos)
            notes.push_back(note.pointer + " " + note.what);
    return notes;
}

}  // namespace

TEST_CASE("Left-hand threads: the drawn helix decides the direction in the draft, and validate compares it") {
    const Folder folder;
    write_pair(folder / "pair.step");
    const auto imported = import(folder / "pair.step", folder / "pair");
    REQUIRE(imported.errors.empty());
    const std::filesystem::path file = folder.path() / "pair" / "assembly.json";
    const json draft = json::parse(bytes(file));
    REQUIRE(draft["joints"].size() == 2);
    for (const json& joint : draft["joints"]) {
        const json& type = draft["joint_types"][joint["type"].get<std::string>()];
        const bool left = joint["id"] == "left";
        CHECK(type.value("thread_direction", "right") == (left ? "left" : "right"));
        CHECK(joint["type"] == (left ? "M8x30 LH" : "M8x30"));
    }
    CHECK(thread_notes(file).empty());

    // The pitch of the helix, in the model that the lesson draws.
    const geometry::FlattenedModel scene = geometry::flatten(load(folder.path() / "pair" / "pair.glb"));
    const content::LoadedAssembly loaded = content::load_assembly(file);
    REQUIRE(loaded.ok());
    for (const content::AssemblyJoint& joint : loaded.assembly.joints) {
        const auto node = scene.by_name.find(joint.node);
        REQUIRE(node != scene.by_name.end());
        const geometry::JointParts parts =
            geometry::find_joint_parts(scene, node->second.front(), joint.design);
        for (const geometry::Fastener* fastener : {&parts.bolt, &parts.nut}) {
            const auto thread = geometry::measure_drawn_thread(fastener->triangles, 8.0 * mm);
            REQUIRE(thread);
            CHECK(thread->direction == joint.design.thread_direction);
            CHECK(thread->pitch == doctest::Approx(1.25 * mm).epsilon(0.1));
        }
        CHECK_FALSE(geometry::measure_drawn_thread(parts.washer_nut.triangles, 8.0 * mm));
    }

    // The other direction in the file: bolt and nut are noted.
    std::string text = bytes(file);
    const std::string left = "\"thread_direction\": \"left\"";
    text.replace(text.find(left), left.size(), "\"thread_direction\": \"right\"");
    REQUIRE(write_file(file, text));
    const std::vector<std::string> notes = thread_notes(file);
    REQUIRE(notes.size() == 2);
    CHECK(notes.front().find("\"left_bolt\" is drawn with a left-hand thread, but \"thread_direction\" is "
                             "\"right\"") != std::string::npos);
}
