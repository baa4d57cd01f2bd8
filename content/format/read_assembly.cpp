#include "content/format/read_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "content/format/json_document.hpp"
#include "content/format/read_joints.hpp"

namespace bolt::content {

namespace {

constexpr double mm = 1e-3;
constexpr double largest_play = 0.6e-3;  // m, of a jaw on its nut
constexpr double default_head_angle = to_radians(15.0);
constexpr std::string_view click_kind = "click_torque_wrench", usual_tool = "wrench";
constexpr double default_click_swing_deg = 4.0;
constexpr double default_accuracy_percent = 4.0;  // ISO 6789-1: type II, class A, above 10 N·m
constexpr double default_field_of_view = to_radians(40.0);

std::map<std::string, std::string> read_texts(Reader& reader, const Node& node) {
    std::map<std::string, std::string> texts;
    for (const Node& item : reader.items(node))
        if (const auto text = reader.text(item)) texts[last_token(item.pointer)] = *text;
    for (const char* language : {"en", "de", "zh"}) reader.member(node, language);  // named in the schema
    return texts;
}

// Of a torque wrench alone: what is said of it on another tool is no use, and meant otherwise.
void read_click(Reader& reader, const Layers& tool, WrenchDesign& wrench) {
    const bool clicks = tool.text("kind").value_or("") == click_kind;
    const auto swing = tool.number("click_swing_deg"), accuracy = tool.number("accuracy_percent");
    for (const auto& value : {swing, accuracy})
        if (value && !clicks && tool.known({"kind"}))
            reader.report(value.pointer, "only a torque wrench clicks",
                          fmt::format("expected the kind {}, or no such value", in_quotes(click_kind)));
    if (!clicks) return;
    wrench.click_swing = to_radians(swing.value_or(default_click_swing_deg));
    wrench.click_accuracy = accuracy.value_or(default_accuracy_percent) / 100.0;
}

WrenchDesign read_tool(Reader& reader, const Node& node, const std::vector<AssemblyJoint>& joints) {
    const Layers tool(reader, {node});
    WrenchDesign wrench;
    read_click(reader, tool, wrench);
    wrench.head_angle = default_head_angle;
    if (const auto angle = tool.number("head_angle_deg")) wrench.head_angle = to_radians(*angle);
    wrench.handle_length = tool.number("handle_length_mm").value_or(0.0) * mm;
    wrench.head_thickness = tool.number("head_thickness_mm").value_or(0.0) * mm;
    const auto depth = tool.number("jaw_depth_mm"), tip = tool.number("jaw_tip_mm");
    wrench.jaw_depth = depth.value_or(0.0) * mm;
    wrench.jaw_tip = tip.value_or(0.0) * mm;
    // The jaw's bottom leaves room for a corner, its tips reach past the flats' ends.
    double widest = 0.0;
    for (const AssemblyJoint& joint : joints)
        widest = std::max(widest, joint.design.thread.size.across_flats);
    const auto too_short = [&](const auto& value, double share, const char* what) {
        if (!value || *value * mm >= share * widest - 1e-9) return;
        reader.report(
            value.pointer,
            fmt::format("{} of {:g} mm is too short for {:g} mm across flats", what, *value, widest / mm),
            fmt::format("expected at least {:.2f} mm", share * widest / mm));
    };
    too_short(depth, 1.0 / std::sqrt(3.0), "a jaw depth");
    too_short(tip, 1.0 / std::sqrt(12.0), "a jaw tip");
    const auto jaw = tool.number("jaw_mm");
    wrench.jaw = jaw.value_or(0.0) * mm;
    if (!jaw) return wrench;
    for (const AssemblyJoint& joint : joints) {
        const joint::FastenerSize& size = joint.design.thread.size;
        const double s = size.across_flats;
        if (s <= 0.0 || (wrench.jaw > s - 1e-9 && wrench.jaw < s + largest_play + 1e-9)) continue;
        reader.report(
            jaw.pointer,
            fmt::format("a jaw of {:g} mm does not fit {}, {:g} mm across flats", *jaw, size.name, s / mm),
            fmt::format("expected {:g} to {:g} mm", s / mm, (s + largest_play) / mm));
        break;
    }
    return wrench;
}

// The usual one, and what there is beside it.
std::vector<Tool> read_tools(Reader& reader, const std::vector<AssemblyJoint>& joints,
                             const FilePlaces& places) {
    std::vector<Tool> tools;
    const auto read = [&](std::string name, const Node& node) {
        Tool tool{std::move(name), read_texts(reader, reader.member(node, "title")),
                  read_tool(reader, node, joints)};
        tool.wrench.model = read_tool_model(reader, node, places);
        tools.push_back(std::move(tool));
    };
    read(std::string(usual_tool), reader.member(reader.root(), "tool"));
    for (const Node& node : reader.items(reader.member(reader.root(), "more_tools"))) {
        const std::string name = last_token(node.pointer);
        if (name == usual_tool)
            reader.report(node.pointer, fmt::format("{} is what \"tool\" is called", in_quotes(name)),
                          "expected another name", Part::key);
        read(name, node);
    }
    return tools;
}

FlangeDesign read_flange(Reader& reader) {
    const Layers file(reader, {reader.member(reader.root(), "flange")});
    FlangeDesign flange;
    flange.coupled = !file.objects().empty();
    flange.thickness = file.number("thickness_mm").value_or(0.0) * mm;
    flange.E = file.number("E_GPa").value_or(0.0) * 1e9;
    flange.poisson = file.number("poisson").value_or(flange.poisson);
    flange.interface_stiffness = file.number("interface_stiffness_GPa_per_m").value_or(0.0) * 1e9;
    return flange;
}

std::vector<View> read_views(Reader& reader) {
    std::vector<View> views;
    for (const Node& node : reader.items(reader.member(reader.root(), "views"))) {
        View view;
        const Node name = reader.member(node, "name");
        view.name = reader.text(name).value_or("");
        view.eye = reader.vector(reader.member(node, "eye_mm")).value_or(Vec3{0.0}) * mm;
        view.target = reader.vector(reader.member(node, "target_mm")).value_or(Vec3{0.0}) * mm;
        view.field_of_view = default_field_of_view;
        if (const auto angle = reader.number(reader.member(node, "field_of_view_deg")))
            view.field_of_view = to_radians(*angle);
        if (name &&
            std::any_of(views.begin(), views.end(), [&](const View& v) { return v.name == view.name; }))
            reader.report(name.pointer, fmt::format("there are two views {}", in_quotes(view.name)),
                          "expected a name of its own");
        const Vec3 look = view.target - view.eye;
        if (reader.sound(node.pointer) && glm::dot(look, look) < 1e-12)
            reader.report(reader.member(node, "target_mm").pointer, "the view looks at its own eye",
                          "expected another point");
        views.push_back(std::move(view));
    }
    return views;
}

std::string suggest_variant(std::string_view name, const std::vector<std::string>& known) {
    return known.empty() ? "expected none: the file has no variants" : suggest(name, known);
}

// The variant to use: what is asked for, else the file's default, else none.
std::string choose_variant(Reader& reader, std::string_view asked, const std::vector<Variant>& variants) {
    std::vector<std::string> names;
    for (const Variant& v : variants) names.push_back(v.name);
    const auto known = [&](std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const Node all = reader.member(reader.root(), "variants");
    const Node node = reader.member(reader.root(), "default_variant");
    const std::string fallback = reader.text(node).value_or("");
    if (node && !known(fallback) && reader.sound(all.pointer))
        reader.report(node.pointer, fmt::format("{} is no variant of this file", in_quotes(fallback)),
                      suggest_variant(fallback, names));
    if (asked.empty()) return known(fallback) ? fallback : std::string{};
    if (!known(asked) && reader.sound(all.pointer))
        reader.report(all.pointer,
                      fmt::format("the variant {} that was asked for is not in this file", in_quotes(asked)),
                      suggest_variant(asked, names));
    return known(asked) ? std::string(asked) : std::string{};
}

}  // namespace

Assembly read_assembly(Reader& reader, std::string_view variant, const FilePlaces& places) {
    Assembly assembly;
    const Node root = reader.root();
    reader.member(root, "$schema");  // for editors only
    assembly.title = read_texts(reader, reader.member(root, "title"));
    assembly.lesson = read_texts(reader, reader.member(root, "lesson"));
    assembly.sources = reader.text(reader.member(root, "sources")).value_or("");
    const bool published = reader.text(reader.member(root, "law")) == "published";
    assembly.law = published ? joint::Law::published : joint::Law::mechanistic;
    assembly.published = read_published(reader);
    assembly.published_targets = read_published_targets(reader, assembly.published);
    assembly.flange = read_flange(reader);
    assembly.views = read_views(reader);
    assembly.models = read_model_files(reader, places);

    for (const Node& node : reader.items(reader.member(root, "variants")))
        assembly.variants.push_back(
            {last_token(node.pointer), read_texts(reader, reader.member(node, "title"))});
    assembly.variant = choose_variant(reader, variant, assembly.variants);
    // The others are only read for their mistakes. Without a default the plain file can be chosen too.
    for (const Variant& other : assembly.variants)
        if (other.name != assembly.variant) read_tools(reader, read_joints(reader, other.name), places);
    assembly.joints = read_joints(reader, assembly.variant);
    assembly.tools = read_tools(reader, assembly.joints, places);
    assembly.tool = assembly.tools.front().name;
    assembly.wrench = assembly.tools.front().wrench;
    assembly.passes = read_passes(reader, assembly.joints);
    return assembly;
}

namespace fs = std::filesystem;

namespace {

// Names of the .glb files in a folder.
std::vector<std::string> models_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code problem;
    for (auto entry = fs::directory_iterator(folder, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem))
        if (entry->path().extension() == ".glb") names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

bool lies_in(const fs::path& inner, const fs::path& folder) {
    std::error_code problem;
    const fs::path whole = fs::weakly_canonical(fs::absolute(inner), problem);
    return !problem &&
           std::mismatch(folder.begin(), folder.end(), whole.begin(), whole.end()).first == folder.end();
}

// The path that a value names, from `folder`. Whether it is there is only asked where `root` is known.
std::string read_file_name(Reader& reader, const Node& node, const fs::path& folder, const fs::path& root,
                           std::string_view where) {
    const auto name = reader.text(node);
    if (!name) return {};
    const fs::path given(*name);
    if (given.is_absolute() || name->find('\\') != std::string::npos ||
        name->find(':') != std::string::npos) {
        reader.report(node.pointer, fmt::format("{} is not a relative path", in_quotes(*name)),
                      fmt::format("expected a path from {}, with / between folders", where));
        return {};
    }
    if (given.extension() != ".glb") {
        reader.report(node.pointer, fmt::format("{} is no .glb file", in_quotes(*name)),
                      "expected a binary glTF file: bolt-author import-step makes one from STEP");
        return {};
    }
    fs::path path = (folder / given).lexically_normal();
    if (root.empty()) return path.string();
    if (!lies_in(path, root)) {
        const bool own = lies_in(root, fs::weakly_canonical(fs::absolute(folder)));
        reader.report(node.pointer,
                      fmt::format("{} leads out of {}", in_quotes(*name), own ? where : "the content folder"),
                      fmt::format("expected a file in {}", own ? where : "the content folder"));
        return {};
    }
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        const std::vector<std::string> known = models_in(path.parent_path());
        reader.report(
            node.pointer, fmt::format("there is no file {} in {}", in_quotes(*name), where),
            known.empty() ? "expected a file; no .glb is there" : suggest(given.filename().string(), known));
        return {};
    }
    return path.string();
}

}  // namespace

ModelFiles read_model_files(Reader& reader, const FilePlaces& places) {
    const auto read = [&](std::string_view key) {
        return read_file_name(reader, reader.member(reader.root(), key), places.folder, places.root,
                              "the assembly's folder");
    };
    return {read("model"), read("model_far"), read("contact_model")};
}

std::string read_tool_model(Reader& reader, const Node& tool, const FilePlaces& places) {
    // Tools are shared by all assemblies, so their models lie in one place.
    const Node node = reader.member(tool, "model");
    const fs::path root = places.root.empty() ? fs::path{} : fs::weakly_canonical(places.tools);
    return read_file_name(reader, node, places.tools, root, "content/tools");
}

joint::PublishedParameters read_published(Reader& reader) {
    joint::PublishedParameters p;
    const Layers file(reader, {reader.member(reader.root(), "published")});
    const auto read = [&](std::string_view key, double& value) { value = file.number(key).value_or(value); };
    read("nut_mass_g", p.nut_mass_g);
    read("mu", p.mu);
    read("mu1", p.mu1);
    read("mu2", p.mu2);
    read("pitch_mm", p.pitch_mm);
    read("d2_mm", p.d2_mm);
    read("D1_mm", p.D1_mm);
    read("D2_mm", p.D2_mm);
    read("r_t_mm", p.r_t_mm);
    read("r_b_mm", p.r_b_mm);
    read("E1_GPa", p.E1_GPa);
    read("E2_GPa", p.E2_GPa);
    read("nu1", p.nu1);
    read("nu2", p.nu2);
    read("kappa", p.kappa);
    read("T_max_Nm", p.T_max_Nm);
    read("kappa1_Nm_per_deg2", p.kappa1);
    read("yield_width_deg", p.yield_width_deg);
    read("transition_width_deg", p.transition_width_deg);
    read("contact_end_mm2", p.contact_end_mm2);
    // Only where they are given: the printed values must come through to the last bit.
    if (const auto alpha = file.number("alpha_deg")) p.alpha = to_radians(*alpha);
    if (const auto beta = file.number("beta_deg")) p.beta = to_radians(*beta);
    if (const auto turns = file.number("theta_max_turns")) p.theta_max_deg = *turns * 360.0;
    const std::vector<Node> rates = reader.items(file.find("spring_rates_MN_per_mm"));
    for (std::size_t i = 0; i < rates.size() && i < std::size(p.spring_rates_1e6); ++i)
        p.spring_rates_1e6[i] = reader.number(rates[i]).value_or(p.spring_rates_1e6[i]);

    if (file.objects().empty() || !file.sound()) return p;
    if (p.D1_mm <= p.D2_mm)
        reader.report(file.objects()[0].pointer, fmt::format("D1 of {:g} mm is no larger than D2", p.D1_mm),
                      fmt::format("expected more than {:g} mm", p.D2_mm));
    const double yield_start = joint::published_yield_torque(p, p.theta_max_deg - p.yield_width_deg);
    if (yield_start <= 0.0)
        reader.report(file.objects()[0].pointer,
                      fmt::format("the torque would be {:.1f} N·m where yield begins", yield_start),
                      "expected a smaller kappa1_Nm_per_deg2 or yield_width_deg, or a larger T_max_Nm");
    else if (const double start = joint::published_boundaries(p).transition; start <= 0.0)
        reader.report(file.objects()[0].pointer,
                      fmt::format("the nut would be on its seat {:.0f} degrees before it is started", -start),
                      "expected a larger theta_max_turns or narrower stages");
    return p;
}

std::optional<PublishedTargets> read_published_targets(Reader& reader,
                                                       const joint::PublishedParameters& law) {
    const Layers file(reader, {reader.member(reader.root(), "published")});
    PublishedTargets targets;
    targets.torque = read_torque(file);
    targets.snug_torque = read_snug_torque(file, targets.torque);
    const Node target = file.find("target_torque_Nm");
    if (!target) {
        for (const char* key :
             {"snug_torque_Nm", "min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"})
            if (const Node alone = file.find(key); alone && file.known({"target_torque_Nm"}))
                reader.report(alone.pointer, fmt::format("\"{}\" without \"target_torque_Nm\"", key),
                              "expected the target too, or neither", Part::key);
        return std::nullopt;
    }
    check_limits(file);
    if (!file.known({"T_max_Nm", "min_torque_Nm", "max_torque_Nm", "torque_tolerance_percent"}))
        return targets;
    if (targets.torque.target > law.T_max_Nm)
        reader.report(target.pointer,
                      fmt::format("{:g} N·m is never reached: the published law ends at a T_max of {:g} N·m",
                                  targets.torque.target, law.T_max_Nm),
                      fmt::format("expected at most {:g} N·m", law.T_max_Nm));
    check_torques(file, targets.torque, targets.snug_torque);
    return targets;
}

}  // namespace bolt::content
