// Remembers what is known of each chain of points that the expansion has passed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace insym {

/// What a chain or a ring is known by: a sum over its links, which determine it, so its reverse has the same
/// and one link more or less costs O(1). Of 96 bits: two of a hundred million chains share one with a
/// probability below 1e-12.
class Fingerprint {
public:
    Fingerprint() = default;
    /// Of all points from the first to the last, and of a ring back to the first.
    explicit Fingerprint(std::span<const int> points, bool closed = false) {
        for (std::size_t i = 1; i < points.size(); ++i) add_link(points[i - 1], points[i]);
        if (closed) add_link(points.back(), points.front());
    }

    void add_link(int a, int b) {
        const auto [first, second] = std::minmax(a, b);
        std::uint64_t mixed = static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint32_t>(second);
        mixed = (mixed + 0x243F6A8885A308D3ULL) * 0x9E3779B97F4A7C15ULL;
        mixed = (mixed ^ mixed >> 32) * 0xD6E8FEB86659FD93ULL;
        mixed ^= mixed >> 32;
        low_ += mixed;
        // Another shift, lest the sums of both depend on one another.
        high_ += static_cast<std::uint32_t>((mixed ^ mixed >> 29) * 0xBF58476D1CE4E5B9ULL >> 32);
    }

    std::uint64_t low() const { return low_; }
    std::uint32_t high() const { return high_; }

private:
    std::uint64_t low_ = 0;
    std::uint32_t high_ = 0;
};

/// A hash map from chains, or rings, to what is known of them. They are known by their fingerprints, not kept
/// themselves. So one of any length costs 16 to 32 bytes and mostly one access to memory, which may be
/// asked for ahead of its use.
class ChainMemo {
public:
    enum class Answer : std::uint8_t { unknown, no, yes };
    struct Known {
        /// Does the path from this chain on find a cycle, if ties go to the end of the higher and of the
        /// lower index?
        std::array<Answer, 2> path = {Answer::unknown, Answer::unknown};
        Answer alone = Answer::unknown;  ///< does this chain by itself become one?
    };
    using Id = std::uint32_t;

    ChainMemo() : slots_(kInitialSlots) {}

    void prefetch(const Fingerprint& chain) const {
#if defined(__GNUC__)
        __builtin_prefetch(&slots_[chain.low() & (slots_.size() - 1)], 1);
#endif
    }

    /// The number of `chain`; stays valid.
    Id id(const Fingerprint& chain) {
        if (3 * (entries_.size() + 1) > 2 * slots_.size()) grow();
        std::size_t s = chain.low() & (slots_.size() - 1);
        for (; slots_[s].entry != kFree; s = (s + 1) & (slots_.size() - 1))
            if (slots_[s].low == chain.low() && slots_[s].high == chain.high()) return slots_[s].entry;
        slots_[s] = {chain.low(), chain.high(), static_cast<Id>(entries_.size())};
        entries_.emplace_back();
        return slots_[s].entry;
    }

    Known& operator[](Id id) {
        return entries_[id];
    }

private:
    static constexpr Id kFree = ~Id{0};
    static constexpr std::size_t kInitialSlots = 1024;  // a power of two, always

    struct Slot {
        std::uint64_t low = 0;
        std::uint32_t high = 0;
        Id entry = kFree;
    };

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
