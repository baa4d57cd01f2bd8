#include "support.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "engine/base/file.hpp"

namespace content_test {

std::string shipped(std::string_view name) {
    const auto path = bolt::content::content_folder() / "assemblies" / name / "assembly.json";
    const auto text = bolt::read_file(path, 1U << 22U, bolt::ErrorCode::failed);
    REQUIRE_MESSAGE(text, path.string());
    return *text;
}

std::string cover() {
    const auto path = bolt::content::content_folder().parent_path() / "tests" / "data" / "cover.json";
    const auto text = bolt::read_file(path, 1U << 22U, bolt::ErrorCode::failed);
    REQUIRE_MESSAGE(text, path.string());
    return *text;
}

std::string_view everything() {
    return R"({
  "$schema": "assembly.schema.json",
  "title": {"en": "Bracket", "de": "Konsole", "zh": "支架", "fr": "Console"},
  "lesson": {"en": "Tighten."},
  "sources": "Made up.",
  "model": "bracket.glb",
  "model_far": "bracket.far.glb",
  "contact_model": "bracket.contact.glb",
  "law": "published",
  "published": {
    "nut_mass_g": 33.3, "alpha_deg": 30, "beta_deg": 30, "mu": 0.3, "mu1": 0.4, "mu2": 0.3, "pitch_mm": 2,
    "d2_mm": 14.7, "D1_mm": 24, "D2_mm": 14.7, "r_t_mm": 14.7, "r_b_mm": 24, "E1_GPa": 117, "E2_GPa": 117,
    "nu1": 0.25, "nu2": 0.25, "kappa": 2, "spring_rates_MN_per_mm": [1.47, 1.46, 1.51, 1.53, 1.40, 1.38, 1.42],
    "T_max_Nm": 72.126, "kappa1_Nm_per_deg2": 0.0015, "theta_max_turns": 20.05, "yield_width_deg": 90,
    "transition_width_deg": 30, "contact_end_mm2": 0.01,
    "target_torque_Nm": 71, "min_torque_Nm": 68, "max_torque_Nm": 76, "snug_torque_Nm": 18
  },
  "tool": {"kind": "open_end_wrench", "jaw_mm": 18.1, "head_thickness_mm": 9, "jaw_depth_mm": 11, "jaw_tip_mm": 12.5, "head_angle_deg": 15, "handle_length_mm": 180, "model": "wrench_18.glb"}, "more_tools": {"clicker": {"title": {"en": "Torque wrench"}, "kind": "click_torque_wrench", "jaw_mm": 18.1, "handle_length_mm": 400, "click_swing_deg": 5, "accuracy_percent": 3, "adaptor_mm": 50},
    "socket set": {"kind": "ratchet", "head": "socket", "size_mm": 18, "teeth": 90, "extension_mm": 125, "handle_length_mm": 200, "instead": {"A": "clicker"}}},
  "flange": {"thickness_mm": 20, "E_GPa": 70, "poisson": 0.33, "interface_stiffness_GPa_per_m": 500, "joint_types": ["M12x1.25"]},
  "materials": {"grey iron": {"E_GPa": 105}},
  "joint_types": {
    "M12x1.25": {
      "size": "M12x1.25",
      "class": "10.9",
      "nut_proof_stress_MPa": 1050,
      "bolt_length_mm": 60,
      "bolt_thread_length_mm": 32,
      "members": [{"thickness_mm": 20, "material": "grey iron"}, {"thickness_mm": 15, "material": "steel"}],
      "member_diameter_mm": 40,
      "washer_under_head": false,
      "washer_under_nut": true,
      "friction_thread": 0.1,
      "friction_bearing": 0.13,
      "friction_static_ratio": 1.2,
      "friction_scatter_percent": 5,
      "lubrication": "mos2",
      "roughness_Rz_um": 25,
      "misfit_um": 8,
      "embedding_time_s": 3,
      "prevailing_torque_Nm": 9,
      "running_torque_Nm": 0.05,
      "start_gap_mm": 20,
      "nut_mass_g": 17,
      "published": {"T_max_Nm": 75, "target_angle_deg": 80, "min_angle_deg": 40, "max_angle_deg": 110},
      "spec": {
        "strategy": "torque_angle",
        "target_torque_Nm": 90,
        "min_torque_Nm": 80,
        "max_torque_Nm": 105,
        "snug_torque_Nm": 30,
        "target_angle_deg": 40,
        "min_angle_deg": 30,
        "max_angle_deg": 60,
        "target_clamp_kN": 50,
        "risk_class": "A"
      }
    },
    "M12 stud": {
      "form": "stud", "head": "hexagon", "turned": "nut", "counter_hold": "fixed", "thread_direction": "left", "locking_insert": true, "size": "M12", "class": "8.8",
      "tapped_hole": {"material": "our iron", "E_GPa": 105, "tensile_strength_MPa": 260, "shear_ratio": 1.1, "engagement_mm": 15, "depth_mm": 40},
      "bolt_length_mm": 60, "members": [{"thickness_mm": 35, "material": "steel"}], "friction_thread": 0.12, "friction_bearing": 0.12, "friction_held_bearing": 0.1,
      "spec": {"strategy": "torque", "target_torque_Nm": 50}
    }
  },
  "joints": [
    {"id": "A", "type": "M12x1.25", "node": "joint_A", "position_mm": [0, 0, 0], "axis": [0, 0, 1]},
    {"id": "B", "type": "M12x1.25", "node": "joint_B", "position_mm": [80, 0, 0], "axis": [0, 0.6, 0.8],
     "override": {
       "size": "M12",
       "class": "8.8",
       "nut_proof_stress_MPa": 900,
       "bolt_length_mm": 65,
       "bolt_thread_length_mm": 40,
       "members": [{"thickness_mm": 35, "material": "steel"}],
       "member_diameter_mm": 50,
       "washer_under_head": true,
       "washer_under_nut": false,
       "friction_thread": 0.12,
       "friction_bearing": 0.12,
       "friction_static_ratio": 1.1,
       "friction_scatter_percent": 4,
       "lubrication": "dry",
       "roughness_Rz_um": 10,
       "misfit_um": 4,
       "embedding_time_s": 2,
       "prevailing_torque_Nm": 0,
       "running_torque_Nm": 0.03,
       "start_gap_mm": 15,
       "nut_mass_g": 16,
       "published": {"E2_GPa": 120, "target_torque_Nm": 74},
       "spec": {
         "strategy": "torque",
         "target_torque_Nm": 70,
         "torque_tolerance_percent": 5,
         "snug_torque_Nm": 20,
         "target_angle_deg": 35,
         "min_angle_deg": 25,
         "max_angle_deg": 50,
         "target_clamp_kN": 40,
         "risk_class": "B"
       }
     }}
  ],
  "order": ["B", "A"],
  "passes": [
    {"kind": "run_down", "order": ["A", "B"]},
    {"kind": "tighten", "percent": 50},
    {"kind": "tighten", "percent": 100},
    {"kind": "recheck", "instruction": {"text": {"en": "Mark each nut.", "de": "Markieren Sie jede Mutter."}, "view": "front", "picture": "mark.png"}}
  ],
  "loosening": [{"kind": "turn_back", "angle_deg": 60, "order": ["A", "B"]}, {"kind": "loosen"}],
  "default_variant": "plain",
  "variants": {
    "plain": {},
    "weak": {
      "title": {"en": "Weak"},
      "every_joint_type": {"friction_thread": 0.11, "published": {"E1_GPa": 114}},
      "joint_types": {"M12x1.25": {"class": "8.8", "spec": {"min_torque_Nm": 78, "max_torque_Nm": 100}}},
      "passes": [{"kind": "run_down", "order": ["A", "B"]}, {"kind": "tighten", "percent": 50}, {"kind": "tighten", "percent": 100}, {"kind": "recheck"}],
      "loosening": [{"kind": "loosen"}]
    },
    "one": {
      "lesson": {"en": "Only B."}, "tool": "clicker", "joints": ["B"], "views": [{"name": "side", "eye_mm": [500, 0, 0], "target_mm": [0, 0, 0]}],
      "added_models": {"model": "stand.glb", "model_far": "stand.far.glb", "contact_model": "stand.contact.glb"}
    }
  },
  "views": [{"name": "front", "eye_mm": [0, 0, 500], "target_mm": [0, 0, 0], "field_of_view_deg": 50}]
}
)";
}

std::string edited(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, std::string(from));
    return text.replace(at, from.size(), to);
}

std::vector<std::string> messages(std::string_view text) {
    std::vector<std::string> lines;
    for (bolt::Error error : bolt::content::parse_assembly(text, "f").errors) {
        CHECK(error.code == bolt::ErrorCode::bad_content);
        CHECK(error.file == "f");
        lines.push_back(error.message().substr(2));  // without "f:"
    }
    return lines;
}

int count_lines(std::string_view text) {
    return 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace content_test
