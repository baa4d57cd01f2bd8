#include "tests/people/support.hpp"

#include <doctest/doctest.h>

namespace bolt::people::test {

namespace fs = std::filesystem;

fs::path put_session(const fs::path& path, const std::string& trainee, const std::string& profile) {
    session::Header header = session::test::sample_header(0.1);
    header.trainee_profile = profile;
    header.trainee = trainee;
    header.view_help.reset();
    fs::create_directories(path.parent_path());
    auto writer = session::SessionWriter::create(path, header);
    REQUIRE(writer);
    for (const session::TickRecord& tick : session::test::random_ticks(20, 1)) REQUIRE(writer->append(tick));
    REQUIRE(writer->finish(session::test::sample_result()));
    return path;
}

void put_text(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    REQUIRE(write_file(path, text));
}

std::string summary_of(const std::string& trainee, const std::string& profile) {
    return "{\"assembly\": \"zq350\", \"operator\": \"" + profile + "\", \"trainee\": \"" + trainee + "\"}\n";
}

std::string page_of(const std::vector<std::string>& people) {
    std::string metadata;
    for (const std::string& person : people)
        metadata += "<meta name=\"boltwright-person\" content=\"" + person + "\"/>\n";
    return "<!DOCTYPE html>\n<html><head><title>ZQ350 – training report</title>\n" + metadata +
           "</head><body></body></html>\n";
}

std::set<std::string> files_in(const fs::path& folder) {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory()) files.insert(fs::relative(entry.path(), folder).generic_string());
    return files;
}

}  // namespace bolt::people::test
