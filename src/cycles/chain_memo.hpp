// Remembers what is known of each chain of points that the expansion has passed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace insym {

/// A hash map from sequences of ints, each the same as its reverse, to what is known of them. A sequence is
/// known by a fingerprint of 96 bits, not kept itself: two of a hundred million chains share one with a
/// probability below 1e-12. So a chain of any length costs 16 to 32 bytes and mostly one access to memory.
class ChainMemo {
public:
    enum class Answer : std::uint8_t { unknown, no, yes };
    struct Known {
        Answer path : 2 = Answer::unknown;   ///< does the path from this chain on find a cycle?
        Answer alone : 2 = Answer::unknown;  ///< does this chain by itself become one?
    };
    using Id = std::uint32_t;

    ChainMemo() : slots_(kInitialSlots) {}

    /// The number of `chain`, which is not empty; stays valid.
    Id id(std::span<const int> chain) {
        if (3 * (entries_.size() + 1) > 2 * slots_.size()) grow();
        const Slot wanted = chain.front() <= chain.back() ? fingerprint(chain.begin(), chain.end())
                                                          : fingerprint(chain.rbegin(), chain.rend());
        std::size_t s = wanted.low & (slots_.size() - 1);
        for (; slots_[s].entry != kFree; s = (s + 1) & (slots_.size() - 1))
            if (slots_[s].low == wanted.low && slots_[s].high == wanted.high) return slots_[s].entry;
        slots_[s] = wanted;
        slots_[s].entry = static_cast<Id>(entries_.size());
        entries_.emplace_back();
        return slots_[s].entry;
    }

    Known& operator[](Id id) { return entries_[id]; }

private:
    static constexpr Id kFree = ~Id{0};
    static constexpr std::size_t kInitialSlots = 1024;  // a power of two, always

    struct Slot {
        std::uint64_t low = 0;
        std::uint32_t high = 0;
        Id entry = kFree;
    };

    template <class Iterator>
    static Slot fingerprint(Iterator point, Iterator end) {
        std::uint64_t low = 0x243F6A8885A308D3ULL, high = 0x13198A2E03707344ULL;
        for (; point != end; ++point) {
            const auto p = static_cast<std::uint64_t>(*point) + 1;
            low = (low ^ p) * 0x9E3779B97F4A7C15ULL;
            low ^= low >> 32;
            high = (high + p) * 0xD6E8FEB86659FD93ULL;
            high ^= high >> 29;
        }
        return {low, static_cast<std::uint32_t>(high >> 32), kFree};
    }

    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (slot.entry == kFree) continue;
            std::size_t s = slot.low & (slots_.size() - 1);
            while (slots_[s].entry != kFree) s = (s + 1) & (slots_.size() - 1);
            slots_[s] = slot;
        }
    }

    std::vector<Slot> slots_;
    std::vector<Known> entries_;
};

}  // namespace insym
