#include "game/analysis/order.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::analysis {

namespace {

struct Taken {
    double begin = 0.0;
    int pass = 0;
    std::size_t joint = 0;
};

std::vector<Taken> visits_in_time(const SessionData& session) {
    std::vector<Taken> taken;
    for (std::size_t j = 0; j < session.curves.size(); ++j)
        for (const Visit& visit : session.curves[j].visits)
            if (visit.worked) taken.push_back({visit.begin, visit.pass, j});
    std::stable_sort(taken.begin(), taken.end(),
                     [](const Taken& a, const Taken& b) { return a.begin < b.begin; });
    return taken;
}

// Out of turn are the fewest joints that would have to move for the order to be as asked: those off the
// longest run of rising places. A swap then is two joints, and one that came late is one.
void mark_out_of_turn(PassOrder& order) {
    if (order.asked.empty()) return;
    std::vector<std::size_t> turns;  // first visits of joints that were asked
    for (std::size_t i = 0; i < order.followed.size(); ++i) {
        const Turn& turn = order.followed[i];
        if (turn.again) continue;
        order.followed[i].out_of_turn = true;
        if (order.place_asked(turn.joint) > 0) turns.push_back(i);
    }
    std::vector<std::size_t> length(turns.size(), 1), before(turns.size());
    std::size_t end = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        before[i] = i;
        for (std::size_t k = 0; k < i; ++k) {
            const bool rises = order.place_asked(order.followed[turns[k]].joint) <
                               order.place_asked(order.followed[turns[i]].joint);
            if (!rises || length[k] + 1 <= length[i]) continue;
            length[i] = length[k] + 1;
            before[i] = k;
        }
        if (length[i] > length[end]) end = i;
    }
    for (std::size_t left = turns.empty() ? 0 : length[end]; left > 0; --left) {
        order.followed[turns[end]].out_of_turn = false;
        end = before[end];
    }
}

}  // namespace

bool PassOrder::in_turn() const {
    return std::none_of(followed.begin(), followed.end(),
                        [](const Turn& t) { return t.out_of_turn || t.again; });
}

bool PassOrder::as_asked() const { return !asked.empty() && in_turn() && left_out() == 0; }

std::size_t PassOrder::left_out() const {
    return static_cast<std::size_t>(
        std::count_if(asked.begin(), asked.end(), [&](std::size_t j) { return place_followed(j) == 0; }));
}

std::size_t PassOrder::place_asked(std::size_t joint) const {
    const auto found = std::find(asked.begin(), asked.end(), joint);
    return found == asked.end() ? 0 : static_cast<std::size_t>(found - asked.begin()) + 1;
}

std::size_t PassOrder::place_followed(std::size_t joint) const {
    std::size_t place = 0;
    for (const Turn& turn : followed) {
        if (!turn.again) ++place;
        if (turn.joint == joint) return place;
    }
    return 0;
}

std::size_t PassOrder::visits(std::size_t joint) const {
    return static_cast<std::size_t>(
        std::count_if(followed.begin(), followed.end(), [&](const Turn& t) { return t.joint == joint; }));
}

std::vector<OrderDrawing> order_drawings(const std::vector<PassOrder>& orders) {
    std::vector<OrderDrawing> drawings;
    for (const PassOrder& order : orders) {
        if (order.followed.empty()) continue;
        const auto same = std::find_if(drawings.begin(), drawings.end(), [&](const OrderDrawing& d) {
            return d.order.as_asked() && order.as_asked() && d.order.asked == order.asked;
        });
        if (same == drawings.end()) {
            drawings.push_back({order, 1});
            continue;
        }
        same->order.label += ", " + order.label;
        ++same->passes;
    }
    return drawings;
}

std::string pass_label(const content::Pass& pass) {
    switch (pass.kind) {
        case content::StepKind::run_down:
            return "run-down";
        case content::StepKind::recheck:
            return "re-check";
        case content::StepKind::tighten:
            break;
    }
    return fmt::format("{:.0f} %", 100.0 * pass.fraction);
}

std::vector<PassOrder> pass_orders(const SessionData& session) {
    const std::vector<content::Pass>& passes = session.assembly.passes;
    const bool loosening = session.direction() == joint::Direction::loosen;
    const bool told = !session.pass_texts.empty() && !loosening;
    std::vector<PassOrder> orders;
    if (loosening) {
        // As the lesson plans it: the reverse of the last pass.
        orders.push_back(
            {"loosening", passes.empty() ? std::vector<std::size_t>{} : passes.back().order, {}});
        std::reverse(orders.back().asked.begin(), orders.back().asked.end());
    } else if (!told && passes.size() != 1) {
        orders.push_back({"whole session", {}, {}});
    } else {
        for (const content::Pass& pass : passes) orders.push_back({pass_label(pass), pass.order, {}});
    }
    for (PassOrder& order : orders)
        std::erase_if(order.asked, [&](std::size_t j) { return j >= session.joints.size(); });
    for (const Taken& taken : visits_in_time(session)) {
        const std::size_t at = told ? static_cast<std::size_t>(taken.pass) : 0;
        while (orders.size() <= at) orders.push_back({fmt::format("pass {}", orders.size() + 1), {}, {}});
        PassOrder& order = orders[at];
        order.followed.push_back({taken.joint, false, order.place_followed(taken.joint) > 0});
    }
    for (PassOrder& order : orders) mark_out_of_turn(order);
    return orders;
}

}  // namespace bolt::analysis
