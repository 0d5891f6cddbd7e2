// Remembers what is known of each chain of points that the expansion has passed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace insym {

/// A hash map from sequences of ints, each the same as its reverse, to what is known of them. Entries are never removed; the sequences lie one
/// after another in one block, so a million short chains cost a few tens of bytes each.
class ChainMemo {
public:
    enum class Answer : std::uint8_t { unknown, no, yes };
    struct Known {
        Answer path = Answer::unknown;   ///< does the path from this chain on find a cycle?
        Answer alone = Answer::unknown;  ///< does this chain by itself become one?
    };

    ChainMemo() : slots_(kInitialSlots) {}

    /// What is known of `chain`, which is not empty; valid until the next call.
    Known& operator[](std::span<const int> chain) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        const Reading reading(chain);
        const std::uint64_t hash = reading.hash();
        std::size_t s = hash & (slots_.size() - 1);
        for (; slots_[s].length > 0; s = (s + 1) & (slots_.size() - 1))
            if (slots_[s].hash == hash && slots_[s].length == chain.size() && reading.equals(&keys_[slots_[s].offset]))
                return slots_[s].known;
        slots_[s] = {hash, keys_.size(), static_cast<std::uint32_t>(chain.size()), {}};
        for (std::size_t k = 0; k < chain.size(); ++k) keys_.push_back(reading[k]);
        ++used_;
        return slots_[s].known;
    }

private:
    /// A chain read from its smaller end.
    class Reading {
    public:
        explicit Reading(std::span<const int> chain) : chain_(chain), forward_(chain.front() <= chain.back()) {}
        int operator[](std::size_t k) const { return chain_[forward_ ? k : chain_.size() - 1 - k]; }
        std::uint64_t hash() const {
            std::uint64_t h = chain_.size();
            for (std::size_t k = 0; k < chain_.size(); ++k) {
                h = (h ^ static_cast<std::uint64_t>((*this)[k])) * 0x9E3779B97F4A7C15ULL;
                h ^= h >> 29;
            }
            return h;
        }
        bool equals(const int* key) const {
            for (std::size_t k = 0; k < chain_.size(); ++k)
                if ((*this)[k] != key[k]) return false;
            return true;
        }

    private:
        std::span<const int> chain_;
        bool forward_;
    };
    struct Slot {
        std::uint64_t hash = 0;
        std::size_t offset = 0;
        std::uint32_t length = 0;  // 0: free
        Known known;
    };
    static constexpr std::size_t kInitialSlots = 1024;  // a power of two, always

    void place(const Slot& slot) {
        std::size_t s = slot.hash & (slots_.size() - 1);
        while (slots_[s].length > 0) s = (s + 1) & (slots_.size() - 1);
        slots_[s] = slot;
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.length > 0) place(slot);
    }

    std::vector<Slot> slots_;
    std::vector<int> keys_;
    std::size_t used_ = 0;
};

}  // namespace insym
