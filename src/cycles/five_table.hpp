// The chains of five points about one seed (definitions, section 4).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "cycles/fourths.hpp"
#include "cycles/side.hpp"
#include "cycles/tolerance_interval.hpp"
#include "scene.hpp"

namespace insym {

/// The chains (a, b, c, d, e) about one seed (b, c, d), in 3D: its fourth points a on the left make the rows,
/// those on the right, e, the columns; a cell is a chain of five. The best fifth points of the chain of four
/// (a, b, c, d), on each side of the plane of the last three and in it, are the best cells of its row there;
/// those of (b, c, d, e) of its column. So a chain of five that branches from both is met once, in the cell,
/// and no memory is needed to know it again. What can replace a or e stands in the same column or row, too
/// (C2). Scratch memory: one for each thread.
class FiveTable {
public:
    explicit FiveTable(const Scene& scene) : scene_(scene) {}

    /// A fourth point, and its chain of four with the seed.
    struct Line {
        Candidate fourth;
        bool followed = false;  ///< are the chains of five that branch from it wanted?
        double best = std::numeric_limits<double>::infinity();  ///< least E_min among those
    };
    /// A chain of five that branches from its row, from its column or from both.
    struct Start {
        std::size_t row = 0;
        std::size_t column = 0;
        bool of_row = false;
        bool of_column = false;
        double tolerance = 0;
    };

    /// `left`, `right`: the lists of a and of e. follows_left(a), follows_right(e): is that chain of four
    /// followed?
    template <class FollowsLeft, class FollowsRight>
    void fill(const std::array<int, 3>& seed, const Candidate* left, const Candidate* right,
              FollowsLeft follows_left, FollowsRight follows_right) {
        seed_ = seed;
        collect(left, follows_left, {seed[2], seed[1], seed[0]}, rows_);
        collect(right, follows_right, seed, columns_);
        fill_cells();
        find_starts();
    }

    std::size_t rows() const { return rows_.size(); }
    std::size_t columns() const { return columns_.size(); }
    const Line& row(std::size_t i) const { return rows_[i].line; }
    const Line& column(std::size_t j) const { return columns_[j].line; }
    const std::vector<Start>& starts() const { return starts_; }
    /// Is another chain of the same row or column valid at the E_min of this one?
    bool ambiguous(const Start& start) const;

private:
    static constexpr std::size_t kNoCell = ~std::size_t{0};
    struct Best {
        double tolerance = std::numeric_limits<double>::infinity();
        int point = -1;
        std::size_t cell = kNoCell;
    };
    struct Side {
        Line line;
        int side = 0;  // of the plane of the seed, or 1: in it
        std::array<Best, 3> best;
    };
    struct Cell {
        ToleranceInterval tolerance{std::numeric_limits<double>::infinity(), 0};
        bool of_row = false;
        bool of_column = false;
    };

    template <class Follows>
    void collect(const Candidate* list, Follows follows, const std::array<int, 3>& last,
                 std::vector<Side>& out) {
        out.clear();
        for (; list->point >= 0; ++list)
            out.push_back({{*list, follows(list->point)}, side_of(scene_, last, list->point), {}});
    }
    void fill_cells();
    void ask(std::size_t cell, Side& row, Side& column, const std::array<Span, 3>& four);
    void find_starts();

    const Scene& scene_;
    std::array<int, 3> seed_{};
    std::vector<Side> rows_;
    std::vector<Side> columns_;
    std::vector<Cell> cells_;
    std::vector<Start> starts_;
};

}  // namespace insym
