#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "content/format/json_document.hpp"
#include "content/format/read_assembly.hpp"

namespace bolt::content {

namespace {

std::vector<std::size_t> as_listed(std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
}

std::string listed(const std::vector<std::string>& ids) {
    std::vector<std::string> names;
    names.reserve(ids.size());
    for (const std::string& id : ids) names.push_back(in_quotes(id));
    return fmt::format("{} {} missing", fmt::join(names, ", "), names.size() == 1 ? "is" : "are");
}

// The names that an order can use.
struct Ids {
    std::vector<std::string> names;  // each once, by the first joint that has it
    std::vector<std::size_t> joint;  // index of that joint
    std::vector<int> uses;           // how many joints have it
    std::size_t nameless = 0;        // joints whose id was refused or is missing
    std::string repeated;     // in words: the first joint with the id of another; empty if there is none
    std::size_t repeats = 0;  // joints with the id of another
};

Ids read_ids(Reader& reader, const std::vector<AssemblyJoint>& joints) {
    Ids ids;
    const std::vector<Node> nodes = reader.items(reader.member(reader.root(), "joints"));
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::string& id = joints[i].design.id;
        const auto known =
            static_cast<std::size_t>(std::find(ids.names.begin(), ids.names.end(), id) - ids.names.begin());
        if (id.empty()) {
            ++ids.nameless;
        } else if (known == ids.names.size()) {
            ids.names.push_back(id);
            ids.joint.push_back(i);
            ids.uses.push_back(1);
        } else {
            ++ids.uses[known];
            ++ids.repeats;
            if (ids.repeated.empty())
                ids.repeated = fmt::format("the joint in line {}, whose id is a repetition",
                                           reader.line(reader.member(nodes[i], "id").pointer));
        }
    }
    return ids;
}

std::string suggest_joint(std::string_view id, const std::vector<std::string>& missing,
                          const std::string& repeated) {
    if (repeated.empty())
        return missing.empty() ? "expected every joint once, and nothing else" : suggest(id, missing);
    return missing.empty() ? fmt::format("did you mean {}?", repeated)
                           : fmt::format("did you mean {}? If not, {}", repeated, suggest(id, missing));
}

// Every joint once. A name that is no joint most likely stands for one that is missing: then both are one
// mistake. Or for one that has no id of its own: then the order may be right.
std::vector<std::size_t> read_order(Reader& reader, const Node& node, const Ids& ids) {
    std::vector<std::size_t> order;
    std::vector<Node> unknown;
    std::vector<int> named(ids.names.size());
    std::vector<std::string> first(ids.names.size());
    for (const Node& item : reader.items(node)) {
        const auto id = reader.text(item);
        if (!id) return {};
        const auto index =
            static_cast<std::size_t>(std::find(ids.names.begin(), ids.names.end(), *id) - ids.names.begin());
        if (index == ids.names.size()) {
            unknown.push_back(item);
            continue;
        }
        if (named[index] == 0) first[index] = item.pointer;
        if (++named[index] > ids.uses[index])
            reader.report(item.pointer, fmt::format("{} comes twice in this order", in_quotes(*id)),
                          fmt::format("expected every joint once; it comes first in line {}",
                                      reader.line(first[index])));
        else
            order.push_back(ids.joint[index]);
    }
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < ids.names.size(); ++i)
        if (named[i] == 0) missing.push_back(ids.names[i]);
    if (unknown.size() > ids.nameless || ids.repeats > 0)
        for (const Node& item : unknown) {
            const std::string id = reader.text(item).value_or("");
            reader.report(item.pointer, fmt::format("{} is no joint of this file", in_quotes(id)),
                          suggest_joint(id, missing, ids.repeated));
        }
    if (!missing.empty() && missing.size() + ids.nameless + ids.repeats > unknown.size())
        reader.report(node.pointer, listed(missing) + " in this order", "expected every joint once");
    return order;
}

// A pass as far as it could be read.
struct Round {
    Node node;
    std::optional<StepKind> kind;
    std::optional<double> percent;  // tighten only
};

// The shares of the target torque: they do not fall, and end at all of it.
void check_percent(Reader& reader, const std::vector<Round>& rounds) {
    double highest = 0.0;
    bool falls = false, known = true;
    const Round* last = nullptr;
    for (const Round& round : rounds) {
        const Node percent = reader.member(round.node, "percent");
        known = known && round.kind && reader.sound(percent.pointer);
        if (round.kind && round.kind != StepKind::tighten && percent)
            reader.report(percent.pointer, "only a pass of kind \"tighten\" has a share of the target",
                          "no \"percent\" here");
        if (round.kind != StepKind::tighten) continue;
        last = &round;
        if (!percent) {
            if (reader.sound(percent.pointer))
                reader.report(round.node.pointer, "a pass of kind \"tighten\" without \"percent\"",
                              "expected a share of the target torque, 100 in the last pass");
            known = false;
            continue;
        }
        if (round.percent < highest) {
            falls = true;
            reader.report(percent.pointer,
                          fmt::format("{:g} percent after {:g} percent", *round.percent, highest),
                          "expected shares that do not fall, and 100 in the last pass");
        }
        highest = std::max(highest, *round.percent);
    }
    if (!known) return;
    if (last == nullptr)
        reader.report(reader.member(reader.root(), "passes").pointer, "no pass tightens",
                      "expected a pass of kind \"tighten\" with 100 percent");
    else if (last->percent < 100.0 && !falls)
        reader.report(reader.member(last->node, "percent").pointer,
                      fmt::format("the last pass tightens to {:g} percent only", *last->percent),
                      "expected 100");
}

// Nuts are run down before a wrench tightens them, and rechecked when all are tight.
void check_sequence(Reader& reader, const std::vector<Round>& rounds) {
    const auto kind_at = [&](std::size_t i) { return reader.member(rounds[i].node, "kind").pointer; };
    const auto works = [](const Round& round) { return round.kind && round.kind != StepKind::run_down; };
    const auto first =
        static_cast<std::size_t>(std::find_if(rounds.begin(), rounds.end(), works) - rounds.begin());
    const bool run_down = first > 0;  // or a kind that could not be read
    if (first < rounds.size() && !run_down)
        reader.report(kind_at(first),
                      fmt::format("this pass {} before the nuts are run down",
                                  rounds[first].kind == StepKind::recheck ? "rechecks" : "tightens"),
                      "expected a pass of kind \"run_down\" first");
    std::size_t last = 0;  // pass that tightens
    for (std::size_t i = 0; i < rounds.size(); ++i)
        if (rounds[i].kind == StepKind::tighten) last = i;
    for (std::size_t i = 0; i < last; ++i)
        if (rounds[i].kind == StepKind::recheck && (run_down || i != first))
            reader.report(kind_at(i),
                          fmt::format("this pass rechecks before the last pass that tightens, in line {}",
                                      reader.line(rounds[last].node.pointer)),
                          "expected it behind that one");
}

std::vector<Round> read_rounds(Reader& reader) {
    std::vector<Round> rounds;
    for (const Node& node : reader.items(reader.member(reader.root(), "passes"))) {
        Round round;
        round.node = node;
        const auto kind = reader.text(reader.member(node, "kind"));
        if (kind)
            round.kind = kind == "run_down"  ? StepKind::run_down
                         : kind == "recheck" ? StepKind::recheck
                                             : StepKind::tighten;
        round.percent = reader.number(reader.member(node, "percent"));
        rounds.push_back(std::move(round));
    }
    return rounds;
}

}  // namespace

double least_share(Reader& reader) {
    double least = 1.0;
    for (const Round& round : read_rounds(reader))
        if (round.kind == StepKind::tighten && round.percent) least = std::min(least, *round.percent / 100.0);
    return least;
}

std::vector<Pass> read_passes(Reader& reader, const std::vector<AssemblyJoint>& joints) {
    const Ids ids = read_ids(reader, joints);
    const Node common_node = reader.member(reader.root(), "order");
    std::vector<std::size_t> common = as_listed(joints.size());
    if (common_node && !joints.empty()) common = read_order(reader, common_node, ids);

    const std::vector<Round> rounds = read_rounds(reader);
    std::vector<Pass> passes;
    for (const Round& round : rounds) {
        Pass pass;
        pass.kind = round.kind.value_or(StepKind::tighten);
        pass.fraction = round.percent.value_or(100.0) / 100.0;
        const Node order = reader.member(round.node, "order");
        pass.order = order && !joints.empty() ? read_order(reader, order, ids) : common;
        passes.push_back(std::move(pass));
    }
    if (!rounds.empty()) {
        check_percent(reader, rounds);
        check_sequence(reader, rounds);
    }
    return passes;
}

}  // namespace bolt::content
