// The script that drives the mock runtime in another process: the file that MOCK_OPENXR_SCRIPT names. The
// runtime then runs in real time.
//
// A line is a frame number, a command and its arguments; an empty line or one that begins with # is skipped.
// Frames are counted from 0 over the whole process. A frame's commands run when the client waits for that
// frame; while no session runs, each xrGetSystem and each xrPollEvent without an event counts as a frame.
// Commands of frame 0 run before the first instance is created.
//
//   0 config eyes|width|height|period|ipd|cant VALUE  properties of the headset (Config); width and height of
//                                                     the recommended picture; period, ipd and cant in SI
//   0 config with|without EXTENSION      the runtime offers the extension, or does not
//   0 config format VK_FORMAT_NUMBER     the only colour format; depth stays
//   0 config separate|foreign_gpu 1      no swapchains with several layers; a GPU that Vulkan does not list
//   0 config passthrough 1               the blend mode ALPHA_BLEND is offered; for a layer of its own:
//                                        config with XR_FB_passthrough
//   0 config realtime 0|1                xrWaitFrame waits in real time
//   0 report FILE          writes a summary at each xrDestroyInstance and at exit: "frames N", "drawn N",
//                          "blended N" (with the real room, by blend mode or layer), "vibrations N", then
//                          "violation TEXT" for each violation
//   F head POSE            POSE: x y z qx qy qz qw
//   F head valid|tracked 0|1
//   F hand left|right grip|aim POSE
//   F hand SIDE trigger|squeeze VALUE
//   F hand SIDE stick X Y, or profile /interaction_profiles/...
//   F hand SIDE active|menu|secondary|valid|tracked|joints|pinch 0|1   joints: a flat hand around the grip;
//                                                                      pinch: of the joints
//   F tracker SERIAL role ROLE|none                a Vive tracker; it is connected by its first command
//   F tracker SERIAL pose POSE, or connected|valid|tracked 0|1
//   F event ready|stopping|visible|focused|session_loss|instance_loss|exit|profile|mask|events_lost
//   F event room_reinit|room_failed|room_interrupted|room_restored   of XR_FB_passthrough
//   F event worn|not_worn   sensed by XR_EXT_user_presence; the session keeps its state
//   F event recentre stage|floor|seated [POSE]     the origin moves to POSE in the old space
//   F headset 0|1          disconnected or connected, as the next xrGetSystem reports it
//   F render 0|1           shouldRender, as xrWaitFrame returns it
//   F fail FUNCTION RESULT COUNT                   RESULT: a number, for example -17
//   F follow FILE          each xrSyncActions runs the commands of FILE, which have no frame numbers
//   F picture FILE         writes the frame's pictures, side by side, as PPM, when the frame ends
//   F exit                 the user ends the program in the headset's menu: `event exit`
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
