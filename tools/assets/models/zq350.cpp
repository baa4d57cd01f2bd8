// Assembles the reducer ZQ350 from the parts in reducer/.
#include <fmt/format.h>

#include <cmath>
#include <gp_Ax3.hxx>
#include <string>

#include "tools/assets/models/fasteners.hpp"
#include "tools/assets/models/reducer/casing.hpp"
#include "tools/assets/models/reducer/drive.hpp"
#include "tools/assets/models/reducer/fittings.hpp"
#include "tools/assets/models/reducer/layout.hpp"
#include "tools/assets/models/shipped.hpp"

namespace bolt::models {
namespace {

using namespace reducer;

gp_Trsf shifted(double x, double y, double z) {
    gp_Trsf by;
    by.SetTranslation(gp_Vec(x, y, z));
    return by;
}

// Adds a part without an instance; the caller places it once or many times.
Result<CadPart> add(CadDocument& document, std::string_view name, const Result<TopoDS_Shape>& shape,
                    Finish finish) {
    if (!shape) return fail(shape.error());
    return document.add_part(name, *shape, finish);
}

Status add_single(CadDocument& document, CadGroup group, std::string_view name,
                  const Result<TopoDS_Shape>& shape, Finish finish, const gp_Trsf& placement = {}) {
    BOLT_TRY_ASSIGN(const auto part, add(document, name, shape, finish));
    document.add_instance(group, name, part, placement);
    return {};
}

Status add_casing(CadDocument& document, std::string_view name, const Result<Casting>& casting) {
    if (!casting) return fail(casting.error());
    const CadPart part =
        document.add_part(name, casting->shape, finish::painted_cast_iron, casting->machined);
    document.add_instance(document.root(), name, part);
    return {};
}

void add_drive_part(CadDocument& document, CadGroup group, const DrivePart& part) {
    document.add_instance(group, part.name,
                          document.add_part(part.name, part.shape, part.finish, part.faces));
}

Status add_bearings(CadDocument& document, CadGroup group) {
    constexpr std::array<std::string_view, 3> size{"NJ306", "NJ309", "NJ213"};
    constexpr std::array<std::string_view, 3> shaft_names{"input", "intermediate", "output"};
    for (std::size_t i = 0; i < shafts.size(); ++i) {
        const ShaftLayout& s = shafts[i];
        BOLT_TRY_ASSIGN(const auto part, add(document, fmt::format("bearing_{}", size[i]),
                                             roller_bearing(s.bearing_bore, s.bearing_outer, s.bearing_width),
                                             finish::bearing_steel));
        const double y = bearing_inner + s.bearing_width / 2.0;
        for (const double side : {-1.0, 1.0}) {
            gp_Trsf at;
            at.SetTransformation(gp_Ax3(gp_Pnt(s.x, side * y, 0), gp_Dir(0, side, 0), gp_Dir(1, 0, 0)),
                                 gp_Ax3());
            document.add_instance(
                group, fmt::format("bearing_{}_{}", shaft_names[i], side < 0 ? "front" : "back"), part, at);
        }
    }
    return {};
}

Status add_drive(CadDocument& document) {
    const CadGroup group = document.add_group(document.root(), "drive");
    for (const Result<DrivePart>& part :
         {input_shaft(), intermediate_shaft(), output_shaft(), first_wheel(), second_wheel()}) {
        if (!part) return fail(part.error());
        add_drive_part(document, group, *part);
    }
    BOLT_TRY_ASSIGN(const auto small, keys_and_sleeves());
    for (const DrivePart& part : small) add_drive_part(document, group, part);
    return add_bearings(document, group);
}

Result<CadPart> add_screw(CadDocument& document, double length) {
    BOLT_TRY_ASSIGN(const auto spec, iso_4762("M8", length));
    return add(document, fmt::format("screw_M8x{}", length), socket_screw(spec), finish::black_oxide);
}

// Placement of a screw in `frame`: the underside of its head at z = `head`, its point towards -z.
gp_Trsf screw_at(const gp_Trsf& frame, double x, double y, double head) {
    gp_Trsf at;
    at.SetTransformation(gp_Ax3(gp_Pnt(x, y, head), gp_Dir(0, 0, -1), gp_Dir(1, 0, 0)), gp_Ax3());
    return frame * at;
}

struct CapLayout {
    std::string_view name;
    std::size_t shaft;  // index into `shafts`
    bool front;         // on the -Y side
    // Diameters of the shaft that passes through and of its seal; 0 for a blind cap. Lip seals follow DIN
    // 3760: 30x47x7 and 60x80x8.
    double through, seal_outer, seal_width;
};
constexpr std::array<CapLayout, 6> caps{{{"input_front", 0, true, 30.0, 47.0, 7.0},
                                         {"input_back", 0, false, 0.0, 0.0, 0.0},
                                         {"intermediate_front", 1, true, 0.0, 0.0, 0.0},
                                         {"intermediate_back", 1, false, 0.0, 0.0, 0.0},
                                         {"output_front", 2, true, 0.0, 0.0, 0.0},
                                         {"output_back", 2, false, 60.0, 80.0, 8.0}}};

Status add_caps(CadDocument& document) {
    const CadGroup group = document.add_group(document.root(), "end_caps");
    BOLT_TRY_ASSIGN(const auto screw, add_screw(document, 25.0));
    CadPart cap;  // the two caps of the intermediate shaft share one part
    for (const CapLayout& layout : caps) {
        const ShaftLayout& shaft = shafts[layout.shaft];
        const CapSpec spec = cap_spec(shaft, layout.through, layout.seal_outer, layout.seal_width);
        const gp_Trsf frame = cap_frame(shaft, layout.front);
        if (layout.name != "intermediate_back") {
            BOLT_TRY_ASSIGN(const auto part, add(document, fmt::format("end_cap_{}", layout.name),
                                                 end_cap(spec), finish::painted_cast_iron));
            cap = part;
        }
        document.add_instance(group, fmt::format("cap_{}", layout.name), cap, frame);
        if (spec.shaft > 0.0) {
            BOLT_TRY(add_single(document, group, fmt::format("seal_{}", layout.name), lip_seal(spec),
                                finish::rubber, frame));
        }
        for (int i = 0; i < spec.screws; ++i) {
            const double angle = cap_screw_angle(spec, i);
            document.add_instance(group, fmt::format("cap_{}_screw_{}", layout.name, i + 1), screw,
                                  screw_at(frame, spec.screw_circle * std::cos(angle),
                                           spec.screw_circle * std::sin(angle), spec.thickness - 1.0));
        }
    }
    return {};
}

Status add_hatch(CadDocument& document) {
    const CadGroup group = document.add_group(document.root(), "inspection_cover", hatch_frame());
    const double top = hatch.gasket + hatch.cover;
    BOLT_TRY(add_single(document, group, "cover_gasket", hatch_gasket(), finish::gasket));
    BOLT_TRY(add_single(document, group, "cover_plate", hatch_cover(), finish::painted_cast_iron));
    BOLT_TRY(add_single(document, group, "breather", breather(), finish::brass, shifted(0, 0, top)));
    BOLT_TRY_ASSIGN(const auto screw, add_screw(document, 20.0));
    int i = 0;
    for (const double x : {-hatch.screw_x, 0.0, hatch.screw_x})
        for (const double y : {-hatch.screw_y, hatch.screw_y})
            document.add_instance(group, fmt::format("cover_screw_{}", ++i), screw, screw_at({}, x, y, top));
    return {};
}

Status add_fittings(CadDocument& document) {
    const CadGroup group = document.add_group(document.root(), "fittings");
    struct Fitting {
        std::string_view name;
        Result<TopoDS_Shape> shape;
        Finish finish;
        gp_Trsf placement;
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
        BOLT_TRY(add_single(document, group, f.name, f.shape, f.finish, f.placement));
    BOLT_TRY_ASSIGN(const auto pin, add(document, "dowel", dowel(), finish::machined_steel));
    for (std::size_t i = 0; i < dowels.size(); ++i)
        document.add_instance(group, fmt::format("dowel_{}", i + 1), pin,
                              shifted(dowels[i].first, dowels[i].second, 0));
    return {};
}

Status add_joints(CadDocument& document) {
    BOLT_TRY_ASSIGN(const auto long_bolts, add_fasteners(document, "M16", 180.0, finish::zinc_plated));
    BOLT_TRY_ASSIGN(const auto short_bolts,
                    add_fasteners(document, "M16", 75.0, finish::zinc_plated, &long_bolts));
    for (const JointLayout& joint : joints)
        add_joint(document, document.root(), joint.id, joint.at_bearing ? long_bolts : short_bolts,
                  2.0 * thickness(joint), shifted(joint.x, joint.y, thickness(joint)));
    return {};
}

}  // namespace

Status add_zq350(CadDocument& document) {
    BOLT_TRY(add_casing(document, "casing_lower", casing_lower()));
    BOLT_TRY(add_casing(document, "casing_upper", casing_upper()));
    for (const auto step : {add_drive, add_caps, add_hatch, add_fittings, add_joints})
        BOLT_TRY(step(document));
    return {};
}

}  // namespace bolt::models
