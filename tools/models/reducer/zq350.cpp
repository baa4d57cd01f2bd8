#include "tools/models/reducer/zq350.hpp"

#include <fmt/format.h>
#include <cmath>
#include <gp_Ax3.hxx>
#include <string>

#include "tools/models/fasteners.hpp"
#include "tools/models/reducer/casing.hpp"
#include "tools/models/reducer/drive.hpp"
#include "tools/models/reducer/fittings.hpp"
#include "tools/models/reducer/layout.hpp"

namespace bolt::models {
namespace {

using namespace reducer;

gp_Trsf shifted(double x, double y, double z) {
    gp_Trsf by;
    by.SetTranslation(gp_Vec(x, y, z));
    return by;
}

// A part with one or many places.
Result<Part> add(Document& document, std::string_view name, const Result<TopoDS_Shape>& shape,
                 Finish finish) {
    if (!shape) return fail(shape.error());
    return document.add_part(name, *shape, finish);
}

Status add_single(Document& document, Group group, std::string_view name, const Result<TopoDS_Shape>& shape,
                  Finish finish, const gp_Trsf& placement = {}) {
    const Result<Part> part = add(document, name, shape, finish);
    if (!part) return fail(part.error());
    document.add_instance(group, name, *part, placement);
    return {};
}

Status add_casing(Document& document, std::string_view name, const Result<Casting>& casting) {
    if (!casting) return fail(casting.error());
    const Part part = document.add_part(name, casting->shape, finish::painted_cast_iron, casting->machined);
    document.add_instance(document.root(), name, part);
    return {};
}

void add_drive_part(Document& document, Group group, const DrivePart& part) {
    document.add_instance(group, part.name,
                          document.add_part(part.name, part.shape, part.finish, part.faces));
}

Status add_bearings(Document& document, Group group) {
    constexpr std::array<std::string_view, 3> size{"NJ306", "NJ309", "NJ213"};
    constexpr std::array<std::string_view, 3> place{"input", "intermediate", "output"};
    for (std::size_t i = 0; i < shafts.size(); ++i) {
        const ShaftPlace& s = shafts[i];
        const Result<Part> part =
            add(document, fmt::format("bearing_{}", size[i]),
                roller_bearing(s.bearing_bore, s.bearing_outer, s.bearing_width), finish::bearing_steel);
        if (!part) return fail(part.error());
        const double y = bearing_inner + s.bearing_width / 2.0;
        for (const double side : {-1.0, 1.0}) {
            gp_Trsf at;
            at.SetTransformation(gp_Ax3(gp_Pnt(s.x, side * y, 0), gp_Dir(0, side, 0), gp_Dir(1, 0, 0)),
                                 gp_Ax3());
            document.add_instance(group, fmt::format("bearing_{}_{}", place[i], side < 0 ? "front" : "back"),
                                  *part, at);
        }
    }
    return {};
}

Status add_drive(Document& document) {
    const Group group = document.add_group(document.root(), "drive");
    for (const Result<DrivePart>& part :
         {input_shaft(), intermediate_shaft(), output_shaft(), first_wheel(), second_wheel()}) {
        if (!part) return fail(part.error());
        add_drive_part(document, group, *part);
    }
    const Result<std::vector<DrivePart>> small = keys_and_sleeves();
    if (!small) return fail(small.error());
    for (const DrivePart& part : *small) add_drive_part(document, group, part);
    return add_bearings(document, group);
}

Result<Part> add_screw(Document& document, double length) {
    const Result<SocketScrewSpec> spec = iso_4762("M8", length);
    if (!spec) return fail(spec.error());
    return add(document, fmt::format("screw_M8x{}", length), socket_screw(*spec), finish::black_oxide);
}

// A screw whose head sits at z = head in a frame, its point towards -z.
gp_Trsf screw_at(const gp_Trsf& frame, double x, double y, double head) {
    gp_Trsf at;
    at.SetTransformation(gp_Ax3(gp_Pnt(x, y, head), gp_Dir(0, 0, -1), gp_Dir(1, 0, 0)), gp_Ax3());
    return frame * at;
}

struct CapPlace {
    std::string_view name;
    std::size_t shaft;
    bool front;
    double through, seal_outer, seal_width;  // lip seals of DIN 3760: 30x47x7 and 60x80x8
};
constexpr std::array<CapPlace, 6> caps{{{"input_front", 0, true, 30.0, 47.0, 7.0},
                                        {"input_back", 0, false, 0.0, 0.0, 0.0},
                                        {"intermediate_front", 1, true, 0.0, 0.0, 0.0},
                                        {"intermediate_back", 1, false, 0.0, 0.0, 0.0},
                                        {"output_front", 2, true, 0.0, 0.0, 0.0},
                                        {"output_back", 2, false, 60.0, 80.0, 8.0}}};

Status add_caps(Document& document) {
    const Group group = document.add_group(document.root(), "end_caps");
    const Result<Part> screw = add_screw(document, 25.0);
    if (!screw) return fail(screw.error());
    Part blind;  // the intermediate shaft's two are alike
    for (const CapPlace& place : caps) {
        const ShaftPlace& shaft = shafts[place.shaft];
        const CapSpec spec = cap_spec(shaft, place.through, place.seal_outer, place.seal_width);
        const gp_Trsf frame = cap_frame(shaft, place.front);
        const bool again = place.name == "intermediate_back";
        if (!again) {
            const Result<Part> part = add(document, fmt::format("end_cap_{}", place.name), end_cap(spec),
                                          finish::painted_cast_iron);
            if (!part) return fail(part.error());
            blind = *part;
        }
        document.add_instance(group, fmt::format("cap_{}", place.name), blind, frame);
        if (spec.shaft > 0.0) {
            const Status seal = add_single(document, group, fmt::format("seal_{}", place.name),
                                           lip_seal(spec), finish::rubber, frame);
            if (!seal) return seal;
        }
        for (int i = 0; i < spec.screws; ++i) {
            const double angle = cap_screw_angle(spec, i);
            document.add_instance(group, fmt::format("cap_{}_screw_{}", place.name, i + 1), *screw,
                                  screw_at(frame, spec.screw_circle * std::cos(angle),
                                           spec.screw_circle * std::sin(angle), spec.thickness - 1.0));
        }
    }
    return {};
}

Status add_hatch(Document& document) {
    const Group group = document.add_group(document.root(), "inspection_cover", hatch_frame());
    const double top = hatch.gasket + hatch.cover;
    if (const Status s = add_single(document, group, "cover_gasket", hatch_gasket(), finish::gasket); !s)
        return s;
    if (const Status s = add_single(document, group, "cover_plate", hatch_cover(), finish::painted_cast_iron);
        !s)
        return s;
    if (const Status s =
            add_single(document, group, "breather", breather(), finish::brass, shifted(0, 0, top));
        !s)
        return s;
    const Result<Part> screw = add_screw(document, 20.0);
    if (!screw) return fail(screw.error());
    int i = 0;
    for (const double x : {-hatch.screw_x, 0.0, hatch.screw_x})
        for (const double y : {-hatch.screw_y, hatch.screw_y})
            document.add_instance(group, fmt::format("cover_screw_{}", ++i), *screw, screw_at({}, x, y, top));
    return {};
}

Status add_fittings(Document& document) {
    const Group group = document.add_group(document.root(), "fittings");
    struct Fitting {
        std::string_view name;
        Result<TopoDS_Shape> shape;
        Finish finish;
        gp_Trsf place;
    };
    const std::array<Fitting, 7> fittings{
        {{"sight_glass_bezel", glass_bezel(), finish::brass, glass_frame()},
         {"sight_glass", glass_disc(), finish::sight_glass, glass_frame()},
         {"drain_plug", drain_plug(), finish::brass, drain_frame()},
         {"drain_ring", drain_ring(), finish::gasket, drain_frame()},
         {"nameplate", nameplate(), finish::stainless_steel, nameplate_frame()},
         {"nameplate_text", nameplate_text(), finish::black_oxide, nameplate_frame()},
         {"oil", oil_surface(), finish::oil_film, {}}}};
    for (const Fitting& f : fittings)
        if (const Status s = add_single(document, group, f.name, f.shape, f.finish, f.place); !s) return s;
    const Result<Part> pin = add(document, "dowel", dowel(), finish::machined_steel);
    if (!pin) return fail(pin.error());
    for (std::size_t i = 0; i < dowels.size(); ++i)
        document.add_instance(group, fmt::format("dowel_{}", i + 1), *pin,
                              shifted(dowels[i].first, dowels[i].second, 0));
    return {};
}

Status add_joints(Document& document) {
    const Result<FastenerParts> long_ones = add_fasteners(document, "M16", 180.0, finish::zinc_plated);
    if (!long_ones) return fail(long_ones.error());
    const Result<FastenerParts> short_ones =
        add_fasteners(document, "M16", 75.0, finish::zinc_plated, &*long_ones);
    if (!short_ones) return fail(short_ones.error());
    for (const JointPlace& joint : joints)
        add_joint(document, document.root(), joint.id, joint.at_bearing ? *long_ones : *short_ones,
                  2.0 * thickness(joint), shifted(joint.x, joint.y, thickness(joint)));
    return {};
}

}  // namespace

Status add_zq350(Document& document) {
    if (const Status s = add_casing(document, "casing_lower", casing_lower()); !s) return s;
    if (const Status s = add_casing(document, "casing_upper", casing_upper()); !s) return s;
    for (const auto step : {add_drive, add_caps, add_hatch, add_fittings, add_joints})
        if (const Status s = step(document); !s) return s;
    return {};
}

}  // namespace bolt::models
