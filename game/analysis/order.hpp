// In which order the joints were taken, against the order asked.
#pragma once

#include <string>
#include <vector>

#include "game/analysis/session_data.hpp"

namespace bolt::analysis {

struct Turn {
    std::size_t joint = 0;
    bool out_of_turn = false;  // one of the fewest that would have to move for the order to be as asked
    bool again = false;        // it had been taken in this pass already
};

struct PassOrder {
    std::string label;  // "30 %", "run down", "re-check"
    std::vector<std::size_t> asked;
    std::vector<Turn> followed;  // visits that did some work, in time

    [[nodiscard]] bool in_turn() const;          // nothing out of turn or repeated
    [[nodiscard]] bool as_asked() const;         // an order was asked, and followed from first to last
    [[nodiscard]] std::size_t left_out() const;  // asked, but not visited
    // Place in the order, counted from 1; 0 if not in it.
    [[nodiscard]] std::size_t place_asked(std::size_t joint) const;
    [[nodiscard]] std::size_t place_followed(
        std::size_t joint) const;  // its first turn, repeated ones not counted
    [[nodiscard]] std::size_t visits(std::size_t joint) const;
};

// One for each pass of the assembly. A session that tells no passes apart gives one, without an order asked
// if the assembly has several.
std::vector<PassOrder> pass_orders(const SessionData& session);

// Passes that were begun, with those together that followed the same order as asked: one drawing each. The
// label of several names them all.
struct OrderDrawing {
    PassOrder order;
    std::size_t passes = 1;
};
std::vector<OrderDrawing> order_drawings(const std::vector<PassOrder>& orders);

std::string pass_label(const content::Pass& pass);

}  // namespace bolt::analysis
