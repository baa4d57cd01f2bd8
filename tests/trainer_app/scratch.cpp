#include <doctest/doctest.h>
#include <cstdio>
#include <cstdlib>
#include "haptics/collision/jaw.hpp"
#include "haptics/servo/engagement.hpp"
#include "tests/trainer_app/headless_trainer.hpp"
#include "tests/trainer_app/free_hand_user.hpp"
#include "tests/trainer_app/simulated_user.hpp"
#include "tests/trainer/one_joint.hpp"
using namespace bolt;
using namespace bolt::trainer;
static void save(const render::Picture& p, const std::string& path) {
    FILE* f = std::fopen(path.c_str(), "wb");
    std::fprintf(f, "P6\n%u %u\n255\n", p.width, p.height);
    for (std::size_t i = 0; i < p.rgba.size(); i += 4) std::fwrite(&p.rgba[i], 1, 3, f);
    std::fclose(f);
}
TEST_CASE("Scratch") {
    const char* assembly = std::getenv("SCRATCH");
    if (!assembly) { CHECK(true); return; }
    const char* L = std::getenv("SCRATCH_LONG");
    const char* P = std::getenv("SCRATCH_PICS");
    std::optional<test::OneJoint> one;
    if (std::getenv("SCRATCH_ONE")) one.emplace(assembly);
    AppOptions o = test::options(assembly, false);
    if (one) o.choice.assembly = one->name();
    const bool helped = std::getenv("SCRATCH_HELPED") != nullptr;
    if (!helped) o.choice.equipment.hand = HandMode::free;
    test::HeadlessTrainer driver(o, P ? test::Display{{640, 360}, 0.5F, 0.05} : test::Display{{320, 180}, 0.3F, 0.05});
    driver.frame();
    int presses = 0; double end = 0;
    double next = 0, nextpic = 0; int pic = 0;
    auto trace = [&](const char* act) {
        if (driver.app().screen() != ShownScreen::lesson) return;
        const auto& a = driver.lesson();
        const double now = a.session->time(); end = now;
        if (now < next) return;
        next = now + 0.25;
        const auto* due = a.session->lesson().due();
        if (!due) return;
        const auto& setup = a.session->setup();
        const Pose tool = hand_of(a).wrench ? tool_of(a).pose : hand_of(a).pose;
        const auto& g = setup.nuts[due->joint];
        const Vec3 n = servo::nut_centre(g, a.session->state().joints[due->joint].nut.angle);
        const Vec3 d = tool.position - n; const double above = glm::dot(d, g.axis);
        const auto seat = collision::seat_of(setup.wrench.jaw, servo::prism_of(g), servo::on_nut(g, a.session->state().joints[due->joint].nut.angle, servo::at_pose(tool)));
        const auto& out = a.station ? a.station->latest.output : servo::Output{};
        const double squint = glm::dot(tool.orientation * Vec3(0, 0, 1), g.axis);
        std::printf("%7.2f %-8s step %zu %s j%zu eng %d wr %d above %6.1f level %6.1f mis %6.1f sq %5.2f ovl %5.1f F %4.1f cont %d touch %d st %d tq %.2f/%.2f\n", now, act, a.session->lesson().current, due->kind == lesson::StepKind::run_down ? "run" : "tgt", due->joint,
            a.session->state().engagement.joint, hand_of(a).wrench, above * 1e3, glm::length(d - above * g.axis) * 1e3, to_degrees(seat.misalignment), squint, seat.overlap*1e3, glm::length(out.force), out.contacts, int(out.touched.is_none() ? 0 : out.touched.is_fixed() ? 1 : 2), int(a.session->state().joints[due->joint].stage), a.session->state().joints[due->joint].torque, due->torque);
        if (P && now >= nextpic) { nextpic = now + std::atof(P); char b[99]; std::snprintf(b, 99, "/tmp/fh_pics/%03d_%06.1f.ppm", pic++, now); save(driver.picture(), b); }
    };
    const double longest = L ? std::atof(L) : 120.0;
    if (helped) { test::SimulatedUser u(driver); u.play(longest); presses = u.presses; end = driver.lesson().session->time(); }
    else { test::FreeHandUser u(driver); u.on_frame = [&] { trace(""); }; u.play(longest); presses = u.presses; }
    for (auto& l : driver.log()) std::printf("LOG %s\n", l.c_str());
    std::printf("END %.1f s presses %d step %zu score %.0f\n", end, presses, driver.lesson().session->lesson().current, driver.outcome() ? driver.outcome()->result.score : -1.0);
    CHECK(true);
}
