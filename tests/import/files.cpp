// Invalid input files, output that cannot be written, the guard, reproducible bytes, the far level and the
// summary.
#include <doctest/doctest.h>
#include <unistd.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <cmath>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "support.hpp"
#include "tests/support/skip.hpp"
#include "tools/author/import/guard.hpp"

using namespace import_test;

namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string good_file(const Folder& folder) {
    StepMaker maker;
    const TDF_Label root = maker.assembly("things");
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(40.0, 60.0, 20.0).Shape();
    const TopoDS_Shape block = BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(10.0, 20.0).Shape()).Shape();
    const TDF_Label part = maker.part("block", block, "#2F5D62");
    maker.paint_face(part, face_towards(block, 0.0, 0.0, 1.0), "#A8A9A6");
    maker.place(root, part, "block_1", moved(1.0, 0.0, 0.0));
    maker.place(root, part, "block_2", moved(100.0, 0.0, 0.0));
    maker.place(root, maker.part("ring", BRepPrimAPI_MakeTorus(30.0, 8.0).Shape(), "#C8A24A"), "ring_1",
                moved(0.0, 0.0, 50.0));
    maker.write(folder / "good.step");
    return bytes(folder / "good.step");
}

}  // namespace

TEST_CASE("Import: a file that is not STEP is refused with its name and an expectation") {
    const Folder folder;
    const std::string good = good_file(folder);
    std::filesystem::create_directory(folder / "folder.step");
    const std::string header = good.substr(0, good.find("DATA;"));
    struct Case {
        const char* name;
        std::string text;
        const char* what;
    };
    const Case cases[] = {
        {"empty.step", "", "is empty"},
        {"text.step", "Dear reader,\nthis is a letter.\n", "not a STEP file"},
        {"binary.step", std::string(5000, '\x7F') + std::string(3, '\0'), "not a STEP file"},
        {"magic.step", "ISO-10303-21;", "cut short"},
        {"half.step", good.substr(0, good.size() / 2), "cut short"},
        {"header.step", header + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n", "no shape"},
        {"rubbish.step", header + "DATA;\n#1=((((;\n'''\nENDSEC;\nEND-ISO-10303-21;\n", ""},
        {"house.step",
         "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n",
         "IFC"},
    };
    for (const Case& one : cases) {
        CAPTURE(one.name);
        write(folder / one.name, one.text);
        const auto imported = import(folder / one.name, folder / "out");
        REQUIRE(imported.errors.size() == 1);
        const Error& error = imported.errors[0];
        CHECK(error.code == ErrorCode::bad_content);
        CHECK(error.file == (folder / one.name).string());
        CHECK(error.what.find(one.what) != std::string::npos);
        CHECK_FALSE(error.expected.empty());
    }
    for (const char* name : {"folder.step", "not_there.step"}) {
        const auto imported = import(folder / name, folder / "out");
        REQUIRE(imported.errors.size() == 1);
        CHECK(imported.errors[0].code == ErrorCode::bad_content);
    }
    CHECK_FALSE(std::filesystem::exists(folder / "out"));  // no output folder is created
}

TEST_CASE("Import: the guard returns the exit code, the phase and the result of its work") {
    const auto run = step_import::run_guarded({}, [](step_import::GuardChannel& channel) {
        channel.set_phase("meshing block");
        return channel.append_result(std::string(10'000, 'x')) ? 4 : 1;
    });
    CHECK(run.outcome == step_import::GuardOutcome::exited);
    CHECK(run.code == 4);
    CHECK(run.phase == "meshing block");
    CHECK(run.result == std::string(10'000, 'x'));
}

TEST_CASE("Import: the guard contains a crash, an endless loop, too much memory and an exception") {
    using step_import::GuardChannel;
    using step_import::GuardOutcome;
    const auto crash = step_import::run_guarded({}, [](GuardChannel& channel) -> int {
        channel.set_phase("reading");
        return raise(SIGSEGV);
    });
    CHECK(crash.outcome == GuardOutcome::crashed);
    CHECK(crash.code == SIGSEGV);
    CHECK(crash.phase == "reading");
    const auto endless = step_import::run_guarded({1, 0}, [](GuardChannel&) -> int {
        for (volatile bool on = true; on;) {
        }
        return 0;
    });
    CHECK(endless.outcome == GuardOutcome::out_of_time);
    const auto greedy = step_import::run_guarded({60, 1024}, [](GuardChannel&) -> int {
        std::vector<std::string> all;
        for (;;) all.emplace_back(std::size_t{64} << 20U, 'x');
    });
    CHECK(greedy.outcome == GuardOutcome::out_of_memory);
    const auto thrown =
        step_import::run_guarded({}, [](GuardChannel&) -> int { throw std::runtime_error("thrown"); });
    CHECK(thrown.outcome == GuardOutcome::exited);
    CHECK(thrown.code == 1);
    CHECK(step_import::default_limits("/nonexistent/x.step").processor_s == 120);
}

TEST_CASE("Import: output that cannot be written is an error") {
    const Folder folder;
    (void)good_file(folder);
    write(folder / "file", "in the way");
    for (const std::filesystem::path& where : {folder / "file", folder / "file" / "below"}) {
        const auto imported = import(folder / "good.step", where);
        REQUIRE(imported.errors.size() == 1);
        CHECK(imported.errors[0].code == ErrorCode::failed);
        CHECK(imported.errors[0].file.find("file") != std::string::npos);
    }
    if (geteuid() == 0) {
        test::skip_part("a folder without write permission: root may write everywhere");
    } else {
        std::filesystem::create_directory(folder / "locked");
        std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_read);
        CHECK(import(folder / "good.step", folder / "locked").errors[0].code == ErrorCode::failed);
    }
    step_import::ImportOptions options;
    options.name = "../elsewhere";
    const auto imported = import(folder / "good.step", folder / "out", options);
    REQUIRE(imported.errors.size() == 1);
    CHECK(imported.errors[0].code == ErrorCode::usage);
}

TEST_CASE("Import: the same STEP file gives the same bytes") {
    const Folder folder;
    (void)good_file(folder);
    step_import::ImportOptions options;
    options.far_level = true;
    options.far_triangles = 200;
    for (const char* out : {"a", "b"}) REQUIRE(import(folder / "good.step", folder / out, options).ok());
    for (const char* file : {"good.glb", "good.far.glb", "good.contact.glb"}) {
        CAPTURE(file);
        CHECK(bytes(folder / "a" / file) == bytes(folder / "b" / file));
    }
}

TEST_CASE("Import: the far level has the same nodes, and keeps its budget and its stated error") {
    const Folder folder;
    (void)good_file(folder);
    step_import::ImportOptions options;
    options.far_level = true;
    options.far_triangles = 600;
    options.deflection_mm = 0.02;
    const auto imported = import(folder / "good.step", folder / "out", options);
    REQUIRE(imported.ok());
    const assets::Model near = load(folder / "out" / "good.glb"), far = load(folder / "out" / "good.far.glb");
    REQUIRE(near.nodes.size() == far.nodes.size());
    for (std::size_t i = 0; i < near.nodes.size(); ++i) CHECK(near.nodes[i].name == far.nodes[i].name);
    CHECK(imported.report.triangles > 2000);
    CHECK(imported.report.far_triangles <= 600);
    CHECK(imported.report.far_triangles > 50);
    // The simplification keeps a subset of the vertices, so each one is on the torus.
    const int node = node_named(far, "ring_1");
    const auto& ring = far.meshes[static_cast<std::size_t>(far.nodes[static_cast<std::size_t>(node)].mesh)];
    double most = 0.0;
    for (const glm::vec3& p : ring.primitives[0].positions) {
        const double r = std::hypot(static_cast<double>(p.x), static_cast<double>(p.z)) - 0.030;
        most = std::max(most, std::abs(std::hypot(r, static_cast<double>(p.y)) - 0.008));
    }
    CHECK(most < 1e-6);
    // The volume differs from that of the torus by at most the error times the surface area.
    const double error = (imported.report.far_deflection_mm + imported.report.far_error_mm) * 1e-3;
    CHECK(imported.report.far_error_mm > 0.0);
    CHECK(std::abs(volume(ring) - 2.0 * pi * pi * 0.030 * 0.008 * 0.008) <
          4.0 * pi * pi * 0.030 * 0.008 * error);
}

TEST_CASE("Import: the summary has every figure and file") {
    const Folder folder;
    (void)good_file(folder);
    const auto imported = import(folder / "good.step", folder / "out");
    REQUIRE(imported.ok());
    const std::string text = step_import::summary(imported.report);
    for (const char* word :
         {"block", "ring", "2 parts, 3 instances", "deflection: 0.1 mm", "painted_cast_iron", "watertight",
          "joints: 0 found", "good.glb", "good.contact.glb", "millimetre"}) {
        CAPTURE(word);
        CHECK(text.find(word) != std::string::npos);
    }
}
