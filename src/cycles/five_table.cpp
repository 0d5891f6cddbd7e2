#include "cycles/five_table.hpp"

#include <algorithm>

namespace insym {

void FiveTable::fill_cells() {
    const auto& d = scene_.distances;
    cells_.assign(rows_.size() * columns_.size(), Cell{});
    std::size_t cell = 0;
    for (Side& row : rows_) {
        std::array<Span, 3> four;
        for (std::size_t i = 0; i < 3; ++i) {
            four[i].include(d(row.line.fourth.point, seed_[i]));
            for (std::size_t j = i + 1; j < 3; ++j) four[j - i - 1].include(d(seed_[i], seed_[j]));
        }
        for (Side& column : columns_) ask(cell++, row, column, four);
    }
}

/// Only if the chain can be the best of its row or of its column: a part of a chain is never worse than the
/// whole.
void FiveTable::ask(std::size_t cell, Side& row, Side& column, const std::array<Span, 3>& four) {
    const int a = row.line.fourth.point, e = column.line.fourth.point;
    if (a == e) return;
    const double least = std::max(row.line.fourth.tolerance, column.line.fourth.tolerance);
    const auto before = [](double tolerance, int point, const Best& best) {
        return tolerance < best.tolerance || (tolerance == best.tolerance && point < best.point);
    };
    Best& in_row = row.best[static_cast<std::size_t>(column.side)];
    Best& in_column = column.best[static_cast<std::size_t>(row.side)];
    const bool for_row = row.line.followed && before(least, e, in_row);
    const bool for_column = column.line.followed && before(least, a, in_column);
    if (!for_row && !for_column) return;
    const double limit = std::min(
        std::max(for_row ? in_row.tolerance : 0, for_column ? in_column.tolerance : 0), scene_.max_tolerance);
    const auto to_fifth = scene_.distances.row(e);
    const auto distance = [&](int i) { return to_fifth[static_cast<std::size_t>(i)]; };
    const double ends = distance(a);
    Span orbits[] = {four[0], four[1], four[2], {ends, ends}};
    for (std::size_t r = 0; r < 3; ++r) orbits[r].include(distance(seed_[2 - r]));
    const ToleranceInterval tolerance = detail::interval_of_few<4>(orbits, scene_.resolution, limit);
    if (tolerance.min > limit) return;
    cells_[cell].tolerance = tolerance;
    if (for_row && before(tolerance.min, e, in_row)) in_row = {tolerance.min, e, cell};
    if (for_column && before(tolerance.min, a, in_column)) in_column = {tolerance.min, a, cell};
}

void FiveTable::find_starts() {
    const auto mark = [&](Side& side, bool Cell::*of_line) {
        for (const Best& best : side.best) {
            if (best.cell == kNoCell) continue;
            cells_[best.cell].*of_line = true;
            side.line.best = std::min(side.line.best, best.tolerance);
        }
    };
    for (Side& row : rows_) mark(row, &Cell::of_row);
    for (Side& column : columns_) mark(column, &Cell::of_column);
    starts_.clear();
    for (std::size_t i = 0; i < rows_.size(); ++i)
        for (std::size_t j = 0; j < columns_.size(); ++j)
            if (const Cell& cell = cells_[i * columns_.size() + j]; cell.of_row || cell.of_column)
                starts_.push_back({i, j, cell.of_row, cell.of_column, cell.tolerance.min});
}

bool FiveTable::ambiguous(const Start& start) const {
    const std::size_t width = columns_.size(), at = start.row * width + start.column;
    const auto replaces = [&](std::size_t cell) {
        const ToleranceInterval& other = cells_[cell].tolerance;
        return cell != at && other.min <= start.tolerance && start.tolerance < other.max;
    };
    for (std::size_t j = 0; j < width; ++j)
        if (replaces(start.row * width + j)) return true;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (replaces(i * width + start.column)) return true;
    return false;
}

}  // namespace insym
