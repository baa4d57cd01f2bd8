// What a hand plays with: mouse and keyboard, or a station of what is plugged in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "game/session/lesson_session.hpp"
#include "game/station/bench.hpp"

namespace bolt::trainer {

struct Equipment {
    std::vector<std::string> devices;  // ids, as boltwright devices has them
    std::filesystem::path rig;         // what is known of a wheel; may be empty
    std::filesystem::path glove;       // its port; empty: none
    double force_scale = 1.0;          // 0 … 1 of the forces that devices may render
    bool keyboard = false;  // a station without a device: keys move the tool, and the servo has a thread

    [[nodiscard]] bool none() const { return devices.empty() && glove.empty() && !keyboard; }  // the mouse
    bool operator==(const Equipment&) const = default;
};

// Something to choose: what is there now.
struct Seat {
    std::string name;  // in words, of the devices; empty: mouse and keyboard
    Equipment with;
};
std::vector<Seat> seats();
// What suits whoever says nothing: a device that moves the tool, and with it a wheel; else the mouse.
Equipment usual_equipment();

// A station of that for the lesson, paused. `trainee` wears the glove.
Result<std::unique_ptr<station_setup::Bench>> start_station(const content::Assembly& assembly,
                                                            const session::CourseOptions& course,
                                                            const Equipment& with,
                                                            const std::string& trainee);

}  // namespace bolt::trainer
