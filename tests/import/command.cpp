// bolt-author import-step as its users call it: exit codes, messages, progress, summary.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "support.hpp"

using namespace import_test;

namespace {

struct Said {
    int code = -1;
    std::string out, err;
};

Said author(const Folder& folder, const std::string& arguments) {
    const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bolt-author";
    REQUIRE(std::filesystem::exists(program));
    const std::string command = "cd '" + folder.path().string() + "' && '" + program.string() +
                                "' import-step " + arguments + " > said.out 2> said.err";
    const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes(folder / "said.out"),
            bytes(folder / "said.err")};
}

bool has(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

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
