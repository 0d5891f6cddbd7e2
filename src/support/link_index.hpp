// Which supports hold a link between two points, in either direction.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace insym {

/// A hash table with open addresses. Memory linear in what is added; a look costs what it finds.
class LinkIndex {
public:
    LinkIndex() : slots_(1024) {}

    /// Once for each support, however often it is said.
    void add(int a, int b, int support) {
        if (2 * keys_ >= slots_.size()) grow();
        Slot& slot = slots_[place(key(a, b))];
        for (int e = slot.first; e >= 0; e = entries_[static_cast<std::size_t>(e)].next)
            if (entries_[static_cast<std::size_t>(e)].support == support) return;
        if (slot.first < 0) {
            slot.key = key(a, b);
            ++keys_;
        }
        entries_.push_back({support, slot.first});
        slot.first = static_cast<int>(entries_.size()) - 1;
    }

    /// Calls visit(support), the latest first.
    template <class Visit>
    void visit(int a, int b, Visit visit) const {
        for (int e = slots_[place(key(a, b))].first; e >= 0; e = entries_[static_cast<std::size_t>(e)].next)
            visit(entries_[static_cast<std::size_t>(e)].support);
    }

private:
    struct Slot {
        std::uint64_t key = 0;
        int first = -1;  // of the entries; below 0: the slot is empty
    };
    struct Entry {
        int support;
        int next;
    };

    static std::uint64_t key(int a, int b) {
        if (a > b) std::swap(a, b);
        return static_cast<std::uint64_t>(a) << 32U | static_cast<std::uint32_t>(b);
    }
    std::size_t place(std::uint64_t key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t k = (key * 0x9E3779B97F4A7C15ULL >> 20U) & mask;
        while (slots_[k].first >= 0 && slots_[k].key != key) k = (k + 1) & mask;
        return k;
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& s : old)
            if (s.first >= 0) slots_[place(s.key)] = s;
    }

    std::vector<Slot> slots_;
    std::vector<Entry> entries_;
    std::size_t keys_ = 0;
};

}  // namespace insym
