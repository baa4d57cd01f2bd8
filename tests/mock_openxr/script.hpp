// The script that drives the mock runtime in another process; mock_openxr.hpp describes its lines.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/mock_openxr/mock_openxr.hpp"

namespace bolt::mock {

struct State;

struct ScriptLine {
    int number = 0;                  // in the file
    std::vector<std::string> words;  // after the frame number
};

struct Script {
    std::string file;
    std::multimap<std::uint64_t, ScriptLine> lines;  // by frame
    std::uint64_t frame = 0;                         // of the next commands
    std::vector<std::string> requested;           // files of pictures, for the next frame that is waited for
    std::multimap<XrTime, std::string> pictures;  // the same by the frame's display time
    std::string report;                           // file; empty: none
    std::string followed;  // file of commands, run at each synchronization; empty: none
};

// Reads the file. A line without a frame number is a violation.
Script load_script(State& s, const std::string& file);
// Runs the commands of this frame. A command that is not understood is a violation.
void run_commands(State& s, std::uint64_t frame);
// Runs the commands of the followed file as it is now. The file may be missing.
void run_followed(State& s);
// Writes the frame's pictures to the files that were requested for it or for an earlier frame without any.
void write_pictures(State& s, const Frame& frame);

}  // namespace bolt::mock
