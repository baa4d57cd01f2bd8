#include "game/session/recorded_tick.hpp"

#include <doctest/doctest.h>

#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;

TEST_CASE("Tick record: converting to a record and back returns the input") {
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        servo::TickInput input;
        input.commanded_tool = session::test::random_tick(random).commanded_tool;
        input.grip = static_cast<servo::Grip>(random.bits() % 3);
        input.dead_man = random.chance(0.5);
        input.fresh = random.chance(0.5);
        input.stop = random.chance(0.5);
        input.reset = random.chance(0.5);
        input.missed = static_cast<std::uint8_t>(random.bits() % 16);
        input.guided_joint = static_cast<std::int16_t>(static_cast<int>(random.bits() % 20) - 1);
        const TickRecord record = make_record(input, {});
        CHECK(is_valid(record));
        CHECK(session::test::same(make_record(input_of(record), {}), record));
        CHECK(input_of(record).grip == input.grip);
        CHECK(input_of(record).dead_man == input.dead_man);
        CHECK(input_of(record).fresh == input.fresh);
        CHECK(input_of(record).stop == input.stop);
        CHECK(input_of(record).reset == input.reset);
        CHECK(input_of(record).missed == input.missed);
        CHECK(input_of(record).guided_joint == input.guided_joint);
    }
}

TEST_CASE("Tick record: the output is stored in single precision") {
    servo::Output output;
    output.force = {0.1, -2.0, 3.0e-8};
    output.torque = {1.0 / 3.0, 0.0, -0.25};
    output.joint = 11;
    output.stage = joint::Stage::yield;
    output.wrench_torque = 48.7;
    output.nut_angle = 6.283185307179586;
    output.clamp = 23456.789;
    output.contacts = 7;
    output.touched = collision::ObstacleId::nut(11);
    output.fault = force::Fault::jumped;
    const TickRecord record = make_record({}, output);
    CHECK(record.force[0] == 0.1F);
    CHECK(record.force[1] == -2.0F);
    CHECK(record.force[2] == 3.0e-8F);
    CHECK(record.torque[0] == 1.0F / 3.0F);
    CHECK(record.torque[2] == -0.25F);
    CHECK(record.joint == 11);
    CHECK(record.stage == 3);
    CHECK(record.wrench_torque == 48.7F);
    CHECK(record.nut_angle == 6.283185307179586F);
    CHECK(record.clamp == 23456.789F);
    CHECK(record.contacts == 7);
    CHECK(record.touched == collision::ObstacleId::nut(11));
    CHECK(record.fault == static_cast<std::uint8_t>(force::Fault::jumped));
}

TEST_CASE("Tick record: obstacle numbers match older files, and each number is one obstacle") {
    using collision::ObstacleId;
    CHECK(file_number({}) == std::int16_t{-1});
    for (const std::size_t i : {0U, 1U, 999U})
        CHECK(file_number(ObstacleId::fixed(i)) == static_cast<std::int16_t>(i));
    for (const std::size_t i : {0U, 11U, 31767U})
        CHECK(file_number(ObstacleId::nut(i)) == static_cast<std::int16_t>(1000 + i));
    CHECK(file_number(ObstacleId::fixed(1000)) == std::int16_t{-2});
    CHECK_FALSE(file_number(ObstacleId::fixed(max_fixed)));
    CHECK_FALSE(file_number(ObstacleId::nut(max_nuts)));
    for (int number = -32767; number <= 32767; ++number)
        CHECK(file_number(obstacle_of_number(static_cast<std::int16_t>(number))) == number);
    CHECK_FALSE(file_number(obstacle_of_number(INT16_MIN)));
}
