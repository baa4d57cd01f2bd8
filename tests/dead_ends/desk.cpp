#include "tests/dead_ends/desk.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dead_ends {

namespace {

constexpr double fastest_hand = 0.03;  // m in a tick, beyond which the servo would not believe it

}  // namespace

Desk::Desk(session::Course& c, Watch& w) : course(c), watch(w) {
    player.hand = trainer::make_hand({Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)});
    last.device = servo::sample_of(player.hand.pose);
}

bool Desk::tick(servo::Input input, bool wrench_in_hand, double room, bool asks) {
    input.setting = static_cast<float>(sets * lesson::setting(course.lesson()));
    const auto stepped = course.step(input);
    if (!stepped) {
        watch.trouble(stepped.error().message());
        return false;
    }
    output = *stepped;
    last = input;
    watch.tick(output);
    if (course.state().tick % frame_ticks == 0) watch.frame(output, wrench_in_hand, room, asks);
    return true;
}

void Desk::frame(trainer::Wish wish, std::optional<std::size_t> takes_back, bool asks) {
    trainer::MouseHand& hand = player.hand;
    if (takes_back) trainer::go_back(back, course.lesson(), *takes_back);
    if (back.to && hand.nut) wish.retreat = true;
    trainer::wish(hand, wish, course.setup(), course.state());
    for (int i = 0; i < frame_ticks && !over(); ++i) {
        const Vec3 before = hand.pose.position;
        servo::Input input = trainer::move(hand, course.setup(), course.state());
        if (const lesson::Step* due = course.lesson().due(); due != nullptr && course.lesson().guides)
            input.guide = static_cast<std::int16_t>(due->joint);
        const auto steps = trainer::steps_back(back, course.lesson());
        if (steps && hand.doing == trainer::Doing::resting && !hand.nut) course.go_back(*steps);
        double room = std::numeric_limits<double>::infinity();
        if (hand.wrench && hand.doing == trainer::Doing::holding)
            room = hand.room - std::abs(hand.handle - hand.begun_at);
        double leap = glm::distance(before, hand.pose.position);
        // Off a nut that it did not get onto it goes on from where the wrench was held up.
        if (course.state().tool_contact && hand.wrench)
            leap = std::min(leap, glm::distance(course.state().tool_contact->god_object.tool.position,
                                                hand.pose.position));
        if (!(leap < fastest_hand))
            watch.trouble(fmt::format("a hand at a mouse leaps by {:.1f} mm, doing {}", 1e3 * leap,
                                      static_cast<int>(hand.doing)));
        if (!tick(input, hand.wrench, room, asks)) return;
        for (const lesson::Event& event : course.events()) trainer::note(back, course.lesson(), event);
    }
    trainer::wait(back, frame_seconds);
}

}  // namespace dead_ends
