#include "game/trainer/equipment.hpp"

#include "game/station/plan.hpp"
#include "haptics/device/device.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::trainer {

namespace {

std::string name_of(const station_setup::Choice& choice) {
    std::string name = choice.mover ? choice.mover->name : std::string();
    if (choice.wheel) name += (name.empty() ? "" : " + ") + choice.wheel->name;
    return name;
}

}  // namespace

std::vector<Seat> seats() {
    std::vector<Seat> there{{{}, {}}};
    const station_setup::Choice all = station_setup::choose_any(device::list_devices());
    const auto add = [&](const station_setup::Choice& choice) {
        there.push_back({name_of(choice), {station_setup::ids_of(choice), {}, {}, 1.0, false}});
    };
    if (all.mover) add({all.mover, std::nullopt});
    if (all.wheel) add({std::nullopt, all.wheel});
    if (all.mover && all.wheel) add(all);
    return there;
}

Equipment usual_equipment() {
    Equipment with;
    const station_setup::Choice all = station_setup::choose_any(device::list_devices());
    if (all.mover) with.devices = station_setup::ids_of(all);
    return with;
}

Result<std::unique_ptr<station_setup::Bench>> start_station(const content::Assembly& assembly,
                                                            const session::CourseOptions& course,
                                                            const Equipment& with,
                                                            const std::string& trainee) {
    device::VirtualPuck puck({}, device::steady_timer());
    station_setup::Wanted wanted;
    wanted.devices = with.devices;
    wanted.rig = with.rig;
    wanted.otherwise = puck.open();
    wanted.glove = with.glove;
    wanted.trainee = trainee;
    wanted.force_scale = with.force_scale;
    if (!with.glove.empty() && trainee.empty())
        return fail(ErrorCode::no_device, "nobody is said to wear the glove",
                    "the trainee's name, as boltwright glove calibrate has it");
    Result<station_setup::Planned> planned = station_setup::plan_lesson(assembly, course, wanted, {});
    if (!planned) return fail(planned.error());
    station::StationOptions& plan = planned->plan;
    plan.controls.pause = true;
    std::optional<device::VirtualPuck> pushed;
    if (!planned->choice.mover) {
        pushed = std::move(puck);
        plan.mover_buttons = {1, 0, 0, 0};
    }
    return station_setup::start_bench(std::move(plan), std::move(pushed));
}

}  // namespace bolt::trainer
