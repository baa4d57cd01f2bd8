#include "haptics/servo/touch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/contact/smooth_normals.hpp"
#include "haptics/joint/corner.hpp"
#include "haptics/servo/jaw_grip.hpp"

namespace bolt::servo {

namespace {

// Between two queries nothing goes further than merged contacts allow for.
static_assert(contact::GodObjectParameters{}.stride <= contact::merge_stride);

constexpr double against = 1.5;  // skins: nearer than this an obstacle holds the wrench

// Kept between jaw and hexagon, m: of a clearance of a tenth of a millimetre the skin would take half.
constexpr double jaw_skin = 2e-6;
constexpr double both_skins = 2.5;  // over the skin: that a jaw on a nut has on either side, with some room

// Of the opening: a nut this near to the jaw's middle touches nothing of the wrench but its jaw.
constexpr double beside = 0.15, ahead = 0.25;
constexpr double nearly_level = 0.99;  // cos 8°

// In the frame of the jaw: along the slot to its throat, across, along the normal.
Vec3 in_jaw(const contact::Jaw& jaw, const Pose& wrench, const Vec3& point) {
    return glm::angleAxis(-jaw.head_angle, Vec3(0, 0, 1)) * (inverse(wrench) * point);
}

// Whether only the jaw can touch the nut in this tick and some more.
bool jaw_only(const Setup& setup, const NutPlace& nut, const Pose& place, const Pose& wrench) {
    const contact::Jaw& jaw = setup.wrench.jaw;
    const Vec3 p = in_jaw(jaw, wrench, place.position + 0.5 * nut.height * nut.axis);
    const Vec3 normal = wrench.orientation * Vec3(0, 0, 1);
    return std::abs(p.y) < beside * jaw.opening && p.x < ahead * jaw.opening &&
           std::abs(glm::dot(normal, nut.axis)) > nearly_level;
}

bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

void place_nuts(const Setup& setup, Touch& touch, std::span<const joint::JointState> joints, bool held) {
    for (std::size_t i = 0; i < touch.places.size(); ++i) {
        const Pose place = nut_pose(setup.nuts[i], joints[i].nut.angle);
        const bool stays = same(place, touch.places[i]);
        touch.found.nuts_hold = touch.found.nuts_hold && stays;
        touch.places[i] = place;
        if (!touch.nuts[i]) continue;
        contact::Body& body = touch.world.bodies[*touch.nuts[i]];
        body.pose = place;
        const bool on = !held || !jaw_only(setup, setup.nuts[i], place, touch.god_object.tool);
        touch.found.meshes_hold = touch.found.meshes_hold && on == body.on && (stays || !on);
        body.on = on;
    }
}

// Where the hexagon stands for the jaw that sits on it: turned with it beyond the play, and so little before
// that both jaws have their skin. Pressed together they would contradict each other, and rub without limit.
Pose turned_with(const Setup& setup, const NutPlace& nut, const Pose& place, const Pose& wrench) {
    const double off =
        contact::seat_of(setup.wrench.jaw, prism_of(nut), inverse(place) * wrench).misalignment;
    const double play = joint::rounded_half_play(setup.wrench.jaw.opening, nut.across_flats, 0.0);
    const double lever = 0.5 * nut.across_flats * (std::cos(play) / std::sqrt(3.0) - std::sin(play));
    const double room = std::max(0.0, play - both_skins * jaw_skin / lever);
    const double beyond = off - std::clamp(off, -room, room);
    return {place.position, place.orientation * glm::angleAxis(-beyond, Vec3(0, 0, 1))};
}

// Contacts of the jaw with all nuts, as many as there is room for.
contact::Found find_on_nuts(const Setup& setup, const Touch& touch, const Pose& pose, double band,
                            std::span<contact::Contact> out) {
    const double spared = touch.parameters.skin - jaw_skin;
    contact::Found found{0, band, false};
    std::array<contact::Contact, contact::most_jaw_contacts> met;
    for (std::size_t i = 0; i < touch.hexagons.size(); ++i) {
        const NutPlace& nut = setup.nuts[i];
        const bool sits = static_cast<int>(i) == touch.around;
        const Pose place = sits ? turned_with(setup, nut, touch.places[i], pose) : touch.places[i];
        const std::size_t count = contact::jaw_contacts(touch.jaw, touch.hexagons[i], pose, place, band,
                                                        first_nut + static_cast<std::int32_t>(i), met);
        if (sits) contact::let_turn(place.position, nut.axis, std::span(met).first(count));
        for (std::size_t k = 0; k < count; ++k) {
            contact::Contact& c = met[k];
            c.distance += spared;
            if (found.count < out.size()) {
                out[found.count++] = c;
            } else {
                found.crowded = true;
                found.clearance = std::min(found.clearance, c.distance);
            }
        }
    }
    return found;
}

// Contacts of all but the nuts' own with the jaw, which are closed form.
contact::Found find_on_meshes(Touch& touch, const Pose& pose, double band, std::span<contact::Contact> out) {
    contact::Found found =
        contact::find_contacts(touch.world, touch.wrench, pose, band, touch.proximity, out);
    contact::smooth_normals(touch.world, touch.wrench, pose, out.first(found.count));
    const auto said = [&](const contact::Contact& c) {
        return c.body >= first_nut && contact::stand_for(touch.jaw, inverse(pose) * c.on_tool);
    };
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(found.count);
    found.count = static_cast<std::size_t>(std::remove_if(out.begin(), end, said) - out.begin());
    return found;
}

// A tick often begins where the one before ended: then only what has moved is asked again, which is often
// nothing, and of a nut that turns in the jaw only that nut.
contact::Found find(const Setup& setup, Touch& touch, const Pose& pose, double band,
                    std::span<contact::Contact> out) {
    LastFound& last = touch.found;
    const bool here = last.band == band && same(last.pose, pose);
    const auto kept = std::span(last.contacts).first(last.count);
    const bool nuts_hold = here && last.nuts_hold;
    // How many contacts of meshes are told depends on the room that is left to them.
    const std::size_t room_taken = last.nuts.count;
    if (nuts_hold)
        std::copy_n(kept.begin(), last.nuts.count, out.begin());
    else
        last.nuts = find_on_nuts(setup, touch, pose, band, out);
    const auto rest = out.subspan(last.nuts.count);
    contact::Found found = last.meshes;
    found.work = 0;
    if (here && last.meshes_hold && last.nuts.count == room_taken)
        std::copy_n(kept.begin() + static_cast<std::ptrdiff_t>(room_taken), found.count, rest.begin());
    else
        found = last.meshes = find_on_meshes(touch, pose, band, rest);
    found.count += last.nuts.count;
    found.clearance = std::min(found.clearance, last.nuts.clearance);
    found.crowded = found.crowded || last.nuts.crowded;

    std::copy_n(out.begin(), found.count, last.contacts.begin());
    last.count = found.count;
    last.pose = pose;
    last.band = band;
    last.nuts_hold = last.meshes_hold = true;
    return found;
}

// A jaw that was on a nut and holds it no more is off it when it is clear of the hexagon as that stands.
bool is_off(const Touch& touch, std::size_t i) {
    std::array<contact::Contact, contact::most_jaw_contacts> met;
    return contact::jaw_contacts(touch.jaw, touch.hexagons[i], touch.god_object.tool, touch.places[i], 0.0, 0,
                                 met) == 0;
}

// The nearest of some contacts, if the wrench lies against it.
std::int32_t touched_of(std::span<const contact::Contact> contacts, double skin) {
    const auto nearest = std::min_element(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
        return a.distance < b.distance;
    });
    return nearest != contacts.end() && nearest->distance < against * skin ? nearest->body : -1;
}

}  // namespace

void set_coupling(const Setup& setup, Touch& touch) {
    force::CouplingRange range;
    range.force = setup.limits.force;
    range.torque = setup.limits.torque;
    range.stiffness = setup.limits.stiffness;
    range.torsion = setup.limits.torsion;
    range.dt = setup.dt;
    touch.parameters.coupling = force::make_coupling(range);
}

Result<Touch> make_touch(const Setup& setup, const TouchDescription& d) {
    Touch touch;
    std::vector<contact::Obstacle> obstacles;
    for (const contact::ContactMesh& mesh : d.still)
        obstacles.push_back({static_cast<std::int32_t>(obstacles.size()), &mesh, {}, false});
    for (std::size_t i = 0; i < d.nuts.size() && i < setup.nuts.size(); ++i)
        if (!d.nuts[i].triangles.empty())
            obstacles.push_back(
                {first_nut + static_cast<std::int32_t>(i), &d.nuts[i], nut_pose(setup.nuts[i], 0.0), true});
    Result<contact::World> world = contact::make_world(obstacles);
    if (!world) return fail(world.error());
    touch.world = std::move(*world);
    Result<contact::ToolShape> wrench = contact::make_tool(d.wrench);
    if (!wrench) return fail(wrench.error());
    touch.wrench = std::move(*wrench);
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        touch.nuts.push_back(contact::find_body(touch.world, first_nut + static_cast<std::int32_t>(i)));
        touch.hexagons.push_back(contact::hexagon(prism_of(setup.nuts[i])));
        touch.places.push_back(nut_pose(setup.nuts[i], 0.0));
    }
    touch.jaw = contact::jaw_parts(setup.wrench.jaw);
    touch.proximity = contact::make_proximity(touch.world, touch.wrench);

    set_coupling(setup, touch);
    touch.parameters.radius = touch.wrench.reach();
    touch.parameters.box = {touch.wrench.solid.box.low, touch.wrench.solid.box.high};
    touch.parameters.friction = d.friction;
    return touch;
}

force::Wanted step_touch(const Setup& setup, Touch& touch, std::span<const joint::JointState> joints,
                         const Pose& hand, bool held, int held_nut) {
    place_nuts(setup, touch, joints, held);
    const int around = touch.around;
    if (held_nut >= 0)
        touch.around = held_nut;
    else if (touch.around >= 0 && (!held || is_off(touch, static_cast<std::size_t>(touch.around))))
        touch.around = -1;
    touch.found.nuts_hold = touch.found.nuts_hold && touch.around == around;
    if (!held || !touch.in_hand) {
        touch.god_object = contact::start_god_object(hand);
        touch.last = {};
        touch.touched = -1;
        touch.in_hand = held;
        if (!held) return {};
    }
    const auto finder = [&](const Pose& pose, double band, std::span<contact::Contact> out) {
        const contact::Found found = find(setup, touch, pose, band, out);
        touch.touched = touched_of(out.first(found.count), touch.parameters.skin);
        return found;
    };
    touch.last = contact::step_god_object(touch.parameters, touch.god_object, hand, finder, setup.dt);
    force::Wanted wanted;
    wanted.command = touch.god_object.felt;
    wanted.stored = force::stored_energy(touch.parameters.coupling, touch.god_object.offset);
    return wanted;
}

bool hidden(const Touch& touch, const Vec3& from, const Vec3& to, int joint) {
    const auto i = static_cast<std::size_t>(joint);
    const bool own = joint >= 0 && i < touch.nuts.size();
    return contact::occluded(touch.world, from, to, own ? touch.nuts[i] : std::nullopt);
}

}  // namespace bolt::servo
