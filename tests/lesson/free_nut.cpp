// A nut that is free follows a ratchet back when it swings.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

#include "game/trainees/trainee.hpp"
#include "tests/support/folder.hpp"

namespace bolt::lesson::free_nut {

TEST_CASE("Free nut: a trainee takes the ratchet off a nut that follows it back, and the nut stays free") {
    // A lesson on one nut of the pump, with all parts around it.
    const test::Folder folder;
    const std::filesystem::path pump = folder / "pump";
    std::filesystem::copy(content::assembly_folder("pump-32-160"), pump);
    std::stringstream text;
    text << std::ifstream(pump / "assembly.json").rdbuf();
    std::string file = text.str();
    const std::size_t at = file.find("\"joint_types\": {");
    REQUIRE(at != std::string::npos);
    file.insert(at, R"("variants": { "one": { "title": { "en": "One nut" }, "joints": ["N4"] } }, )");
    std::ofstream(pump / "assembly.json") << file;
    content::LoadedAssembly loaded = content::load_assembly(pump.string());
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    trainees::TrainOptions train;
    train.lesson.task = Task::loosen;
    train.lesson.obstacles = session::ObstacleUse::required;
    train.trainee = trainees::find_profile("novice").value();
    const auto outcome = trainees::train(loaded.assembly, train, folder / "lesson.boltwright",
                                         [](const trainees::TrainingProgress&) { return true; });
    REQUIRE(outcome);
    CHECK(outcome->result.finished);
}

}  // namespace bolt::lesson::free_nut
