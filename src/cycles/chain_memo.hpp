// Remembers what is known of each chain of points that the expansion has passed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace insym {

/// A hash map from sequences of ints, each the same as its reverse, to what is known of them. Entries are
/// never removed; the sequences lie one after another in one block, so a million short chains cost a few tens
/// of bytes each.
class ChainMemo {
public:
    enum class Answer : std::uint8_t { unknown, no, yes };
    struct Known {
        Answer path = Answer::unknown;   ///< does the path from this chain on find a cycle?
        Answer alone = Answer::unknown;  ///< does this chain by itself become one?
        Answer all = Answer::unknown;    ///< do all branches from this chain find one?
    };
    using Id = std::size_t;

    ChainMemo() : slots_(kInitialSlots) {}

    /// The number of `chain`, which is not empty; stays valid.
    Id id(std::span<const int> chain) {
        if (2 * (entries_.size() + 1) > slots_.size()) grow();
        const bool forward = chain.front() <= chain.back();
        const std::uint64_t hash =
            forward ? hash_of(chain.begin(), chain.end()) : hash_of(chain.rbegin(), chain.rend());
        std::size_t s = hash & (slots_.size() - 1);
        for (; slots_[s].length > 0; s = (s + 1) & (slots_.size() - 1)) {
            const Slot& slot = slots_[s];
            if (slot.hash != hash || slot.length != chain.size()) continue;
            const auto key = keys_.begin() + static_cast<std::ptrdiff_t>(slot.key);
            if (forward ? std::equal(chain.begin(), chain.end(), key)
                        : std::equal(chain.rbegin(), chain.rend(), key))
                return slot.entry;
        }
        slots_[s] = {hash, keys_.size(), entries_.size(), static_cast<std::uint32_t>(chain.size())};
        if (forward)
            keys_.insert(keys_.end(), chain.begin(), chain.end());
        else
            keys_.insert(keys_.end(), chain.rbegin(), chain.rend());
        entries_.emplace_back();
        return entries_.size() - 1;
    }

    Known& operator[](Id id) { return entries_[id]; }

private:
    struct Slot {
        std::uint64_t hash = 0;
        std::size_t key = 0;  // where the sequence, read from its smaller end, begins in keys_
        Id entry = 0;
        std::uint32_t length = 0;  // 0: free
    };
    static constexpr std::size_t kInitialSlots = 1024;  // a power of two, always

    template <class Iterator>
    static std::uint64_t hash_of(Iterator point, Iterator end) {
        std::uint64_t h = 0;
        for (; point != end; ++point) {
            h = (h + static_cast<std::uint64_t>(*point) + 1) * 0x9E3779B97F4A7C15ULL;
            h ^= h >> 29;
        }
        return h;
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (slot.length == 0) continue;
            std::size_t s = slot.hash & (slots_.size() - 1);
            while (slots_[s].length > 0) s = (s + 1) & (slots_.size() - 1);
            slots_[s] = slot;
        }
    }

    std::vector<Slot> slots_;
    std::vector<int> keys_;
    std::vector<Known> entries_;
};

}  // namespace insym
