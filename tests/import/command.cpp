// bolt-author import-step as its users call it: exit codes, messages, progress, summary.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>

#include "support.hpp"

using namespace import_test;

namespace {

struct Said {
    int code = -1;
    std::string out, err;
};

std::filesystem::path program() {
    const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bolt-author";
    REQUIRE(std::filesystem::exists(path));
    return path;
}

Said author(const Folder& folder, const std::string& arguments) {
    const std::string command = "cd '" + folder.path().string() + "' && '" + program().string() +
                                "' import-step " + arguments + " > said.out 2> said.err";
    const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes(folder / "said.out"),
            bytes(folder / "said.err")};
}

bool has(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

std::set<std::string> entries(const Folder& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.insert(entry.path().filename().string());
    return names;
}

}  // namespace

TEST_CASE("import-step: a summary on stdout, a line every tenth on stderr") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("root");
    for (int i = 0; i < 40; ++i)
        maker.place(root,
                    maker.part("block" + std::to_string(i), BRepPrimAPI_MakeBox(1.0, 2.0, 3.0 + i).Shape()),
                    "b" + std::to_string(i), moved(5.0 * i, 0.0, 1.0));
    maker.write(folder / "blocks.step");
    const Said said = author(folder, "blocks.step -o out --lod --name row");
    CHECK(said.code == 0);
    CHECK(has(said.out, "40 parts, 40 instances, 480 triangles"));
    CHECK(has(said.out, "out/row.far.glb"));
    CHECK(has(said.out, "watertight"));
    const auto lines = std::count(said.err.begin(), said.err.end(), '\n');
    CHECK(lines >= 8);
    CHECK(lines <= 12);
    CHECK(has(said.err, "100 % done"));
    CHECK(has(said.err, "meshing block"));
    CHECK_FALSE(has(said.err, "\033"));  // no terminal here
    for (const char* file : {"row.glb", "row.far.glb", "row.contact.glb"})
        CHECK(std::filesystem::exists(folder / "out" / file));
}

TEST_CASE("import-step: exit codes and messages") {
    const Folder folder;
    StepMaker maker;
    maker.part("block", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
    maker.write(folder / "block.step");
    std::ofstream(folder / "empty.step") << "";
    std::ofstream(folder / "letter.step") << "Dear reader,\n";
    Said said = author(folder, "empty.step -o out");
    CHECK(said.code == 3);
    CHECK(has(said.err, "empty.step: the file is empty; expected a STEP file"));
    said = author(folder, "letter.step -o out");
    CHECK(said.code == 3);
    CHECK(has(said.err, "letter.step: this is no STEP file"));
    CHECK(author(folder, "none.step -o out").code == 3);
    CHECK(author(folder, "block.step").code == 2);
    CHECK(author(folder, "block.step -o out --deflection 0").code == 2);
    CHECK(author(folder, "block.step -o out --name a/b").code == 2);
    CHECK(author(folder, "block.step -o letter.step").code == 1);
    CHECK(author(folder, "block.step -o /proc/nowhere").code == 1);
    CHECK(author(folder, "block.step -o out --no-joints").code == 0);
}

TEST_CASE("Import: a STEP file that crashes OpenCASCADE is bad content and leaves no files") {
    const Folder folder;
    StepMaker maker;
    maker.part("block", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
    maker.write(folder / "block.step");
    // A vertex refers to an entity that is missing: OpenCASCADE 7.6 dereferences its null pointer.
    std::string text = bytes(folder / "block.step");
    const std::size_t point = text.find("VERTEX_POINT('',#") + 17;
    REQUIRE(point < text.size());
    text.replace(point, text.find(')', point) - point, "99999");
    std::ofstream(folder / "damaged.step", std::ios::binary) << text;
    const Said said = author(folder, "damaged.step -o out");
    CHECK(said.code == 3);
    CHECK(
        has(said.err,
            "damaged.step: OpenCASCADE ended by signal 11 while reading damaged.step; expected a STEP file"));
    CHECK(said.out.empty());
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
    CHECK(entries(folder) == std::set<std::string>{"block.step", "damaged.step", "said.err", "said.out"});
    // Files of the author in an output folder that exists are kept.
    std::filesystem::create_directory(folder / "out");
    std::ofstream(folder / "out" / "notes.txt") << "mine";
    CHECK(author(folder, "damaged.step -o out").code == 3);
    CHECK(author(folder, "block.step -o out").code == 0);
    CHECK(bytes(folder / "out" / "notes.txt") == "mine");
    CHECK(std::filesystem::exists(folder / "out" / "block.glb"));
    CHECK_FALSE(has(said.err, "\033"));
}

TEST_CASE(
    "Import: an import that is stopped leaves no files, one that is killed none after the next import") {
    const Folder folder;
    StepMaker maker;
    maker.part("block", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
    maker.write(folder / "block.step");
    maker.part("ring", BRepPrimAPI_MakeTorus(300.0, 80.0).Shape());
    maker.write(folder / "slow.step");
    const std::string slow = "slow.step -o out --deflection 0.001 --angle 1";
    CHECK(author(folder, slow + " --time-limit 1").code == 3);
    CHECK(has(bytes(folder / "said.err"),
              "did not finish within 1 s of processor time while meshing ring; expected"));
    const std::set<std::string> nothing{"block.step", "said.err", "said.out", "slow.step"};
    CHECK(entries(folder) == nothing);
    for (const char* signal : {"TERM", "KILL"}) {
        CAPTURE(signal);
        // Returns when the program has ended by the signal, sent while the temporary folder is there.
        const std::string command =
            "cd '" + folder.path().string() + "' && { '" + program().string() + "' import-step " + slow +
            " > said.out 2> said.err & pid=$!; until ls -d .out.import-* > said.out 2>&1; do "
            "sleep 0.05; done; kill -" +
            signal + " $pid; wait $pid; }";
        (void)std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
        const bool killed = signal == std::string("KILL");
        CHECK(entries(folder).contains(".out.import-1") == killed);
        CHECK_FALSE(std::filesystem::exists(folder / "out"));
    }
    CHECK(author(folder, "block.step -o out").code == 0);
    std::set<std::string> all = nothing;
    all.insert("out");
    CHECK(entries(folder) == all);
}

// Six bolts with nuts of plain shape. Lengths in mm; `unit` is that of the file.
static void write_six(const std::filesystem::path& file, const char* unit, double d, double flats,
                      double nut_offset) {
    StepMaker maker;
    const TDF_Label root = maker.assembly("six");
    const TDF_Label bolt = maker.part("BOLT", hexagon_bolt(d, flats, 0.6 * d, 4.0 * d));
    const TDF_Label nut = maker.part("NUT", hexagon_nut(flats, 0.8 * d, 0.85 * d));
    for (int i = 1; i <= 6; ++i) {
        maker.place(root, bolt, "BOLT-" + std::to_string(i), moved(100.0 * i, 1.0, 0.0));
        maker.place(root, nut, "NUT-" + std::to_string(i), moved(100.0 * i + nut_offset, 1.0, 2.5 * d));
    }
    maker.write(file, unit);
}

TEST_CASE("Import: the command gives the reason for every bolt and nut that is in no joint") {
    const Folder folder;
    write_six(folder / "inch.step", "INCH", 12.7, 19.05, 0.0);
    Said said = author(folder, "inch.step -o inch");
    CHECK(said.code == 0);
    CHECK(has(said.out, "unit of the file: inch; lengths are given here in mm"));
    CHECK(has(said.out, "joints: 0 found"));
    for (int i = 1; i <= 6; ++i)
        CHECK(
            has(said.out,
                "note: BOLT-" + std::to_string(i) +
                    ": looks like a bolt (cylinder 12.70 mm, hexagon 19.05 mm across flats), but no metric "
                    "size has both; expected M12 with a cylinder 11.52 to 12.48 mm wide and a hexagon 18 or "
                    "19 mm across flats (12.70 mm is the inch thread 1/2 in"));
    CHECK(has(said.out, "by hand"));

    write_six(folder / "aside.step", "MM", 16.0, 24.0, 0.4);
    said = author(folder, "aside.step -o aside");
    CHECK(has(said.out, "unit of the file: millimetre\n"));
    for (int i = 1; i <= 6; ++i) {
        const std::string number = std::to_string(i);
        CHECK(has(said.out,
                  "note: BOLT-" + number +
                      ": looks like a bolt (cylinder 16.00 mm, hexagon 24.00 mm across flats), but no nut is "
                      "coaxial with it: the nearest one, NUT-" +
                      number +
                      ", is 0.40 mm off its axis and 0.00 degrees turned from it; expected at most "
                      "0.1 mm and 0.5 degrees"));
        CHECK(has(said.out, "note: NUT-" + number + ": looks like a nut"));
    }

    // The lengths are inches, but the file calls them millimetres.
    write_six(folder / "wrong_unit.step", "MM", 0.5, 0.75, 0.0);
    said = author(folder, "wrong_unit.step -o wrong_unit");
    CHECK(has(
        said.out,
        "note: BOLT-6: has a hexagon 0.750 mm across flats; expected 5 to 65 mm: is the unit of the file"));

    write_six(folder / "good.step", "INCH", 16.0, 24.0, 0.0);
    said = author(folder, "good.step -o good");
    CHECK(has(said.out, "joints: 6 found, 6 in the draft"));
    CHECK_FALSE(has(said.out, "looks like"));

    StepMaker maker;
    maker.part("BOLT-A", ring(16.0, 5.0, 80.0));
    maker.part("block", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
    maker.write(folder / "round.step");
    said = author(folder, "round.step -o round");
    CHECK(has(said.out,
              "note: BOLT-A: is named like a bolt or a nut, but none of its 2 plane faces form a hexagon; "
              "expected three pairs of opposite faces"));
}
