// From everything that is near to the few contacts that hold the tool.
#pragma once

#include <span>

#include "engine/base/function_ref.hpp"
#include "haptics/contact/contact.hpp"

namespace bolt::contact {

// Contacts of one obstacle count as one when their points on the tool are within a distance that is
// `merge_distance` at first and doubles, up to `furthest_merge`, until those left find room, and when their
// normals are nearly the same; of the farther one the normal may be off the more the farther it is. The
// nearest of them is kept. So a motion that the contacts written allow and in which no point goes further
// than `merge_stride` brings one that was merged behind its surface, further than what is kept was behind its
// own, by at most merge_angle × merge_stride and the merge distance times the turn.
inline constexpr double merge_angle = 4.0 * pi / 180.0;
inline constexpr double merge_stride = 0.5e-3;  // m
inline constexpr double merge_distance = 2e-3;
inline constexpr double furthest_merge = 32e-3;

// An order of all contacts, by distance first.
bool nearer(const Contact& a, const Contact& b);

// A contact of which so much is known that it may never have to be found: most are merged with nearer ones.
struct Waiting {
    double lower = 0.0;     // m: its distance is not less
    Vec3 on_tool{0.0};      // m: its point on the tool is not further from here than `blur`
    Vec3 normal{0.0};       // unit: its normal is not further from that than `spread`
    float blur = 0.0F;      // m
    float spread = 0.0F;    // rad
    std::int32_t body = 0;  // as its contact has it
    // Where it comes from, for who finds it.
    std::uint32_t sample = 0;
    double spent = 0.0;
    std::uint32_t pair = 0;
    bool of_tool = false;
    // It has become a contact, or none.
    bool found = false;
};

// Writes the contact that somebody waits for; false: there is none.
using FindWaiting = FunctionRef<bool(const Waiting&, Contact&)>;

// Working space.
struct Ranked {
    double distance = 0.0;
    std::uint32_t index = 0;  // of the contact, or of what waits
    std::uint32_t by = 0;     // which contact it was merged with last, if with one
};
struct Core {
    Vec3 on_tool{0.0}, normal{0.0};
    double distance = 0.0;
    std::int32_t body = 0;
    std::uint32_t index = 0;  // of the contact
};

struct Reducing {
    std::span<Contact> near;  // room for more behind the first `count`
    std::size_t count = 0;
    // As large as `near`.
    std::span<Ranked> order;
    std::span<Core> kept;
    std::span<std::uint8_t> kept_in;
    std::span<Waiting> waiting;
    std::span<Ranked> waiting_order;  // as large as `waiting`
    double clearance = 0.0;           // m: up to where all these are all there is
};

// Writes what is kept, as if all that wait had been found beforehand.
Found reduce(Reducing all, FindWaiting find, std::span<Contact> out);

}  // namespace bolt::contact
